/* chroma.c: mixtures of a photo of Y, U and V: what is done to their luminance is done to the
 * samples of chroma that they share.
 *
 * A sample of chroma is one of two or four pixels. Where all of them are blurred as F is, because
 * the map has them far or they are matted, the planes get the chroma of F for it, and that of C is
 * composited with the mean of their coverage. Others have the blur of N and stay as they are.
 */
#include <string.h>

#include "thin/mixture.h"

enum { SIDE = RF_TILE / 2, AROUND = 3 };

/* The sample of chroma of a mixture, in its tile. */
static int sample_of(const struct rf_thin_pass *t, const struct rf_thin *thin)
{
    return (thin->at / RF_TILE >> t->chroma->size.down) * SIDE + thin->at % RF_TILE / 2;
}

/* The place of a sample of a tile in planes of chroma. */
static ptrdiff_t place_of(const struct rf_thin_pass *t, int tx, int ty, int sample)
{
    const int row = (ty * RF_TILE >> t->chroma->size.down) + sample / SIDE;

    return row * t->chroma->light.stride + tx * RF_TILE + sample % SIDE * 2;
}

/* Whether all pixels of a sample, and those beside it, are of a surface. None of them is a mixture
 * then, as these are beside something nearer by RF_SURFACE_JUMP: the light of the sample is never
 * exchanged. */
static bool is_clean(const struct rf_thin_pass *t, int column, int row, int disparity)
{
    const int down = t->chroma->size.down;

    for (int y = (row << down) - 1; y <= (row + 1) << down; y++)
        for (int x = 2 * column - 1; x <= 2 * column + 2; x++)
            if (x >= 0 && y >= 0 && x < t->view->width && y < t->view->height &&
                abs(t->disparity.at[y * t->disparity.stride + x] - disparity) > RF_SURFACE_JUMP / 2)
                return false;
    return true;
}

/* Adds up the chroma of the clean samples of F in a row of those around, `step` apart. */
static uint32_t add_samples(const struct rf_thin_pass *t, uint32_t sum[2], int disparity, int row,
                            int first, int last, int step)
{
    const struct rf_chroma_planes *const chroma = t->chroma;
    uint32_t count = 0;

    for (int x = first; x <= last && row >= 0 && row < chroma->size.height; x += step) {
        const uint16_t *const at = chroma->light.at + row * chroma->light.stride + 2 * x;

        if (x < 0 || x >= chroma->size.width || !is_clean(t, x, row, disparity))
            continue;
        sum[0] += at[0];
        sum[1] += at[1];
        count++;
    }
    return count;
}

/* The chroma of F: the mean of the nearest clean samples around, or the sample's own. */
static void find_far(const struct rf_thin_pass *t, struct rf_thin *thin, int tx, int ty)
{
    const int sample = sample_of(t, thin), column = tx * SIDE + sample % SIDE;
    const int row = (ty * RF_TILE >> t->chroma->size.down) + sample / SIDE;
    uint32_t sum[2] = {0, 0}, count = 0;

    memcpy(thin->whole, t->chroma->light.at + place_of(t, tx, ty, sample),
           2 * sizeof thin->whole[0]);
    for (int n = 1; n <= AROUND && !count; n++)
        for (int y = -n; y <= n; y++)
            count += add_samples(t, sum, thin->far_disparity, row + y, column - n, column + n,
                                 abs(y) == n ? 1 : 2 * n);
    for (int c = 0; c < 2 && count; c++)
        thin->whole[c] = (uint16_t)((sum[c] + count / 2) / count);
}

/* Whether a sample of chroma is blurred. */
static bool is_blurred(const struct rf_thin_pass *t, ptrdiff_t at)
{
    return abs(rf_in_pixels(t->chroma->blur.at[at], t->chroma->blur.unit)) >= 128;
}

/* Calls of this for the mixtures of a tile, in order, tell which are the first of their sample. */
static bool is_first(uint64_t seen[2], int sample)
{
    const uint64_t bit = UINT64_C(1) << sample % 64;
    const bool first = !(seen[sample / 64] & bit);

    seen[sample / 64] |= bit;
    return first;
}

void rf_swap_chroma(const struct rf_thin_pass *t, int tx, int ty, bool back)
{
    const struct rf_thin_choice *const choice = rf_thin_choice_of(t, tx, ty);
    uint64_t seen[2] = {0, 0};
    uint32_t count;
    struct rf_thin *const thin = rf_thin_of(t, tx, ty, &count);

    for (uint32_t i = 0; i < count; i++) {
        const int sample = sample_of(t, &thin[i]);
        const ptrdiff_t at = place_of(t, tx, ty, sample);
        uint16_t *const light = t->chroma->light.at + at, was[2];

        if (!rf_has_bit(choice->matte, i) || !is_first(seen, sample) || !is_blurred(t, at))
            continue;
        if (!back)
            find_far(t, &thin[i], tx, ty);
        memcpy(was, light, sizeof was);
        memcpy(light, thin[i].whole, sizeof was);
        memcpy(thin[i].whole, was, sizeof was);
    }
}

void rf_matte_over_yuv(const struct rf_thin_pass *t, int tx, int ty,
                       uint16_t luma[RF_TILE * RF_TILE], uint16_t chroma[RF_TILE * RF_TILE])
{
    const int pixels = 2 << t->chroma->size.down;
    const struct rf_thin_choice *const choice = rf_thin_choice_of(t, tx, ty);
    uint16_t alpha[RF_TILE * SIDE];
    uint64_t seen[2] = {0, 0};
    uint32_t count;
    const struct rf_thin *const thin = rf_thin_of(t, tx, ty, &count);

    if (!count || !choice->mattes)
        return;
    memset(alpha, 0, sizeof alpha);
    for (uint32_t i = 0; i < count; i++)
        if (rf_has_bit(choice->matte, i)) {
            const int x = thin[i].at % RF_TILE, y = thin[i].at / RF_TILE;
            const ptrdiff_t at = (ty * RF_TILE + y) * t->view->stride + tx * RF_TILE + x;

            luma[thin[i].at] =
                rf_mix(luma[thin[i].at], t->light.channel[0][at], thin[i].light[0], thin[i].alpha);
            alpha[sample_of(t, &thin[i])] += thin[i].alpha;
        }
    for (uint32_t i = 0; i < count; i++) {
        const int sample = sample_of(t, &thin[i]);
        const ptrdiff_t at = place_of(t, tx, ty, sample);
        uint16_t *const mean = chroma + sample / SIDE * RF_TILE + sample % SIDE * 2;

        if (!rf_has_bit(choice->matte, i) || !is_first(seen, sample) || !is_blurred(t, at))
            continue;
        for (int c = 0; c < 2; c++)
            mean[c] = rf_mix(mean[c], t->chroma->light.at[at + c], thin[i].whole[c],
                             alpha[sample] / pixels);
    }
}
