/* tile_rays.h: the rays of one tile: those of its set, cut off towards the corners, different
 * before and behind the focus, and for green a little shorter on one side. */
#ifndef RF_TILE_RAYS_H
#define RF_TILE_RAYS_H

#include "aperture/cat_eye.h"
#include "aperture/cat_shape.h"
#include "gather/frame.h"

struct rf_tile_rays {
    const struct rf_ray_set *set;
    bool has_eye;
    struct rf_cat_eye_here eye;       /* of a circle or a mask, */
    const struct rf_cat_shape *shape; /* or, unless it is NULL, of another outline */
    struct rf_cat_shape_here rim;
    int shorter_before, shorter_behind; /* Q8 part that blurs lose; 0: nothing */
};

/* Some rays of either side. */
struct rf_ray_sides {
    const struct refocus_ray *behind, *before;
    struct refocus_ray memory[2][RF_RAY_CHUNK];
};

/* For red and blue, and all of it where nothing is fringed. */
void rf_tile_rays_make(struct rf_tile_rays *rays, const struct rf_frame *f,
                       const struct rf_ray_set *set, int tx, int ty);

/* From those of red and blue to those of green. */
void rf_use_green_rays(struct rf_tile_rays *rays, float fringe);

/* Rays n to n + count - 1, count at most RF_RAY_CHUNK. */
void rf_tile_rays_get(const struct rf_tile_rays *rays, int n, int count,
                      struct rf_ray_sides *sides);

/* Blurs below 0 are before the focus. */
static inline const struct refocus_ray *rf_side_of(const struct rf_ray_sides *sides, int blur)
{
    return blur < 0 ? sides->before : sides->behind;
}

static inline int rf_scaled_blur(const struct rf_tile_rays *rays, int blur)
{
    const int less = blur < 0 ? rays->shorter_before : rays->shorter_behind;

    return blur - blur * less / 256;
}

#endif
