/* held.c: what is thin and in focus, laid over what is not (thin.h). */
#include <stdlib.h>

#include "gather/frame.h"
#include "thin/thin.h"
#include "thin/veil.h"

/* Whether nothing that is blurred before the focus reaches a tile, but for half a pixel of it. */
static bool is_in_sight(const struct refocus_renderer *r, int tx, int ty)
{
    const int reach = r->view.pad / RF_TILE + 1;

    for (int y = ty - reach; y <= ty + reach; y++)
        for (int x = tx - reach; x <= tx + reach; x++) {
            int across, down, blur;

            if (x < 0 || y < 0 || x >= r->view.tiles_x || y >= r->view.tiles_y)
                continue;
            blur = -r->bins[(size_t)y * r->view.tiles_x + x].least;
            across = abs(x - tx) > 1 ? (abs(x - tx) - 1) * RF_TILE : 0;
            down = abs(y - ty) > 1 ? (abs(y - ty) - 1) * RF_TILE : 0;
            if (blur > 256 * 3 / 2 && blur > 256 * (across > down ? across : down))
                return false;
        }
    return true;
}

/* Whether none of a tile is, as far as its run can say. */
static bool is_none(const struct rf_frame *f, const struct rf_thin_run *run)
{
    const struct rf_thin_bounds *all = &f->thin_bounds[RF_THIN_LEVELS - 1]; /* the widest */

    return !run->count ||
           (f->plan.plain && (run->least > all->held_to || run->most < all->held_from));
}

void rf_choose_held(const struct rf_frame *f, int tx, int ty, struct rf_apart *apart)
{
    uint32_t count;
    const struct rf_thin *thin = rf_thin_of(f->r, tx, ty, &count);

    if (is_none(f, rf_thin_run_of(f->r, tx, ty)) || !is_in_sight(f->r, tx, ty))
        return;
    for (uint32_t i = 0; i < count; i++)
        if (rf_is_held(f, &thin[i], tx, ty)) {
            apart->hold[i / 64] |= UINT64_C(1) << i % 64;
            apart->held = true;
        }
}

/* The light in the list is F, that in the planes the photo's: alpha N = C - (1 - alpha) F. */
void rf_lay_held(const struct rf_frame *f, int tx, int ty, uint16_t mean[3][RF_TILE * RF_TILE])
{
    const struct refocus_renderer *r = f->r;
    const ptrdiff_t tile = ty * RF_TILE * r->view.stride + tx * RF_TILE;
    uint32_t count;
    const struct rf_thin *thin = rf_thin_of(r, tx, ty, &count);
    const struct rf_apart *apart = rf_apart_of(r, tx, ty);

    if (!apart->held)
        return;
    for (uint32_t i = 0; i < count; i++, thin++) {
        const ptrdiff_t at = tile + thin->at / RF_TILE * r->view.stride + thin->at % RF_TILE;

        if (!rf_has_bit(apart->hold, i))
            continue;
        for (int c = 0; c < 3; c++) {
            const int left = 255 - thin->alpha;
            const int light = 4 * r->light.channel[c][at] +
                              (left * (mean[c][thin->at] - 4 * thin->light[c]) + 127) / 255;

            mean[c][thin->at] = (uint16_t)(light < 0 ? 0 : light < UINT16_MAX ? light : UINT16_MAX);
        }
    }
}
