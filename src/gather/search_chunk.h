/* search_chunk.h: a chunk of the rays that the search follows. */
#ifndef RF_SEARCH_CHUNK_H
#define RF_SEARCH_CHUNK_H

#include "gather/frame.h"

/* At most RF_RAY_CHUNK rays of equal weight, and the cells of their first guesses. */
struct rf_search_chunk {
    struct rf_search_rays rays;
    int32_t cell[RF_RAY_CHUNK];
};

/* Sets n rays, whose first guesses lie in a plane with that stride. */
static inline void rf_set_search_chunk(struct rf_search_chunk *chunk, const struct rf_frame *f,
                                       const struct refocus_ray *ray, int n, ptrdiff_t stride)
{
    struct rf_search_rays *rays = &chunk->rays;

    rays->rays = n;
    for (int i = 0; i < n; i++) {
        rays->u[i] = ray[i].u;
        rays->v[i] = ray[i].v;
    }
    f->exec->kernels->aim(rays->start, chunk->cell, rays->u, rays->v, rf_nearest_blur(f), 0,
                          (int32_t)stride, (int32_t)f->range.stride, n);
    f->exec->kernels->tolerances(rays->within, rays->u, rays->v, n);
}

/* Finds which rays are settled for a strip of a tile, row y of the window: where they look is x +
 * RF_SETTLED_ROW y. */
enum { RF_SETTLED_ROW = 256 };
static inline void rf_settle_chunk(uint8_t *is_settled, int32_t *place, const struct rf_frame *f,
                                   const struct rf_search_chunk *chunk, int tx, int y)
{
    f->exec->kernels->settle(
        is_settled, place, f->range.at + y / RF_CELL * f->range.stride + tx * (RF_TILE / RF_CELL),
        chunk->cell, &chunk->rays, f->params->iterations, RF_SETTLED_ROW, (int32_t)f->range.stride);
}

/* The row and the column of a place. */
static inline int rf_settled_y(int32_t place)
{
    return (place + RF_SETTLED_ROW / 2) >> 8;
}

static inline int rf_settled_x(int32_t place)
{
    return place - rf_settled_y(place) * RF_SETTLED_ROW;
}

#endif
