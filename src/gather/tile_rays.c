/* tile_rays.c: shapes the rays of one tile for the cat eye of a lens and for its colour fringes. */
#include "gather/tile_rays.h"

#include <math.h>

static void set_fringe(struct rf_tile_rays *rays, float fringe)
{
    const int part = (int)floorf(fabsf(fringe) * 256 + 0.5f);

    rays->shorter_behind = fringe > 0 ? part : 0;
    rays->shorter_before = fringe < 0 ? part : 0;
}

void rf_tile_rays_make(struct rf_tile_rays *rays, const struct rf_frame *f,
                       const struct rf_ray_set *set, int tx, int ty)
{
    rays->set = set;
    rays->has_eye = f->params->cat_eye > 0;
    rays->shorter_before = rays->shorter_behind = 0;
    if (f->params->fringe != 0)
        set_fringe(rays, f->params->fringe);
    if (rays->has_eye) {
        const int64_t w = f->view->photo_width, h = f->view->photo_height;
        /* Twice the distances of the tile from the middle of the photo. */
        const int64_t x = 2 * f->view->x0 + (2 * tx + 1) * RF_TILE - w;
        const int64_t y = 2 * f->view->y0 + (2 * ty + 1) * RF_TILE - h;
        const int64_t square = x * x + y * y, last = w * w + h * h;
        /* The middle of a tile that ends beyond the photo may lie beyond its corner. */
        const int64_t corner = square > last ? square : last;
        const int amount = (int)floorf(f->params->cat_eye * 65536 + 0.5f);

        rf_cat_eye_at(f->cat_eye, x, y, corner, amount, &rays->eye);
        rays->has_eye = !rays->eye.is_round;
        rays->shape = f->cat_shape->is_there ? f->cat_shape : NULL;
        if (rays->has_eye && rays->shape)
            rf_cat_shape_at(rays->shape, x, y, corner, amount, &rays->cut);
    }
}

void rf_use_green_rays(struct rf_tile_rays *rays, float fringe)
{
    set_fringe(rays, -fringe);
}

static const struct refocus_ray *get(const struct rf_tile_rays *rays, const struct refocus_ray *ray,
                                     int count, struct refocus_ray memory[RF_RAY_CHUNK])
{
    if (!rays->has_eye)
        return ray;
    for (int n = 0; n < count; n++)
        memory[n] = rays->shape ? rf_cat_shape_ray(rays->shape, &rays->cut, &ray[n])
                                : rf_cat_eye_ray(&rays->eye, &ray[n]);
    return memory;
}

void rf_tile_rays_get(const struct rf_tile_rays *rays, int n, int count, struct rf_ray_sides *sides)
{
    const struct rf_ray_set *set = rays->set;

    sides->behind = get(rays, set->ray + n, count, sides->memory[0]);
    sides->before = set->before == set->ray ? sides->behind
                                            : get(rays, set->before + n, count, sides->memory[1]);
}
