/* blur.c: the method `blur`, the image-space filter that Yang et al. 2016 compare with.
 *
 * Each pixel is the mean over its own circle of confusion, whatever lies in it: the pixels
 * p + u s(p) for all rays u, by its own blur s(p) = K (df - d(p)). It costs O(N M) and ignores
 * visibility: colours bleed over edges, and a blurred foreground ends as sharply as
 * its depth does.
 */
#include "papers/papers.h"
#include "image/viewport.h"

#include <stdlib.h>
#include <string.h>

static void gather(const struct rf_frame *f, int x, int y, struct rf_sums *sums)
{
    const ptrdiff_t p = y * f->view->stride + x;
    const int s = f->blur.at[p], i = y % RF_TILE * RF_TILE + x % RF_TILE;
    const struct rf_ray_set *set = rf_choose_ray_set(f->ray_sets, abs(s), false);
    uint64_t light[3] = {0, 0, 0}, weight = 0;

    for (int n = 0; n < set->count; n++) {
        const struct refocus_ray *ray = &set->ray[n];
        const ptrdiff_t q = p + rf_offset(ray->v, s) * f->view->stride + rf_offset(ray->u, s);
        const uint64_t w = (uint64_t)rf_weight_of(f, q) * ray->weight;

        weight += w;
        for (int c = 0; c < 3; c++)
            light[c] += w * f->light.channel[c][q];
    }
    sums->weight[i] = weight;
    for (int c = 0; c < 3; c++)
        sums->light[c][i] = light[c];
}

static void blur_tile(const struct rf_frame *f, int tx, int ty, struct rf_rect rect, int worker)
{
    struct rf_sums sums;

    (void)tx;
    (void)ty;
    (void)worker;
    for (int y = rect.y0; y < rect.y1; y++) {
        for (int x = rect.x0; x < rect.x1; x++) {
            if (rf_cancelled(f->exec))
                return;
            gather(f, x, y, &sums);
        }
    }
    rf_encode_tile(f, rect, &sums);
}

const struct rf_method rf_blur_method = {.tile = blur_tile};
