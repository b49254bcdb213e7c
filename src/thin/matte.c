/* matte.c: thin structures in focus are composited over their blurred background. */
#include <stdlib.h>

#include "thin/mixture.h"

/* Whether nothing that is blurred before the focus reaches a tile by more than half a pixel. */
static bool is_visible(const struct rf_thin_pass *t, int tx, int ty)
{
    const int reach = t->view->pad / RF_TILE + 1;

    for (int y = ty - reach; y <= ty + reach; y++)
        for (int x = tx - reach; x <= tx + reach; x++) {
            int across, down, blur;

            if (x < 0 || y < 0 || x >= t->view->tiles_x || y >= t->view->tiles_y)
                continue;
            blur = rf_in_pixels(-t->bins[(size_t)y * t->view->tiles_x + x].least, t->blur.unit);
            across = abs(x - tx) > 1 ? (abs(x - tx) - 1) * RF_TILE : 0;
            down = abs(y - ty) > 1 ? (abs(y - ty) - 1) * RF_TILE : 0;
            if (blur > 256 * 3 / 2 && blur > 256 * (across > down ? across : down))
                return false;
        }
    return true;
}

void rf_choose_matted(const struct rf_thin_pass *t, int tx, int ty, struct rf_thin_choice *choice)
{
    uint32_t count;
    const struct rf_thin *thin = rf_thin_of(t, tx, ty, &count);

    for (uint32_t i = 0; i < count; i++) {
        /* Under the noise of video thin structures would flicker: now matted, now not. */
        if ((t->chroma && !thin[i].thick) || !rf_is_matted(t, &thin[i], tx, ty))
            continue;
        if (!choice->mattes && !is_visible(t, tx, ty))
            return;
        choice->matte[i / 64] |= UINT64_C(1) << i % 64;
        choice->mattes = true;
    }
}

/* The light in the list is F, that in the planes the photo's. */
void rf_matte_over(const struct rf_thin_pass *t, int tx, int ty,
                   uint16_t mean[3][RF_TILE * RF_TILE])
{
    const ptrdiff_t tile = ty * RF_TILE * t->view->stride + tx * RF_TILE;
    uint32_t count;
    const struct rf_thin *thin = rf_thin_of(t, tx, ty, &count);
    const struct rf_thin_choice *choice = rf_thin_choice_of(t, tx, ty);

    if (!count || !choice->mattes) /* counts lie close together */
        return;
    for (uint32_t i = 0; i < count; i++, thin++) {
        const ptrdiff_t at = tile + thin->at / RF_TILE * t->view->stride + thin->at % RF_TILE;

        if (!rf_has_bit(choice->matte, i))
            continue;
        for (int c = 0; c < 3; c++)
            mean[c][thin->at] =
                rf_mix(mean[c][thin->at], t->light.channel[c][at], thin->light[c], thin->alpha);
    }
}
