/* tile_rays.h: the rays of one tile. They are those of its set, but cut off towards the corners of
 * the photo, different before and behind the focus, and for green a little shorter on one side. */
#ifndef RF_TILE_RAYS_H
#define RF_TILE_RAYS_H

#include "aperture/cat_eye.h"
#include "aperture/cat_shape.h"
#include "gather/frame.h"

struct rf_tile_rays {
    const struct rf_ray_set *set;
    bool has_eye;
    struct rf_cat_eye_here eye;         /* cuts circles and masks */
    const struct rf_cat_shape *shape;   /* cuts any other outline; else NULL */
    struct rf_cat_shape_here cut;       /* the result of `shape` */
    int shorter_before, shorter_behind; /* part that blurs lose, Q8; 0: nothing */
};

/* Rays for surfaces on either side of the focus. */
struct rf_ray_sides {
    const struct refocus_ray *behind, *before;
    struct refocus_ray memory[2][RF_RAY_CHUNK];
};

/* Makes the rays of tile (tx, ty) for red and blue, or for all channels where nothing is fringed.
 */
void rf_tile_rays_make(struct rf_tile_rays *rays, const struct rf_frame *f,
                       const struct rf_ray_set *set, int tx, int ty);

/* Changes from the rays of red and blue to those of green. */
void rf_use_green_rays(struct rf_tile_rays *rays, float fringe);

/* Gets rays n to n + count - 1; count is at most RF_RAY_CHUNK. */
void rf_tile_rays_get(const struct rf_tile_rays *rays, int n, int count,
                      struct rf_ray_sides *sides);

/* The signed blur by which rays of the channel look. */
static inline int rf_scaled_blur(const struct rf_tile_rays *rays, int blur)
{
    const int less = blur < 0 ? rays->shorter_before : rays->shorter_behind;

    return blur - blur * less / 256;
}

#endif
