/* splat_yuv.c: draws highlights into the means of a tile of luminance and chroma.
 *
 * They are drawn in red, green and blue first, and added to those of the means (colour/yuv.h) pixel
 * by pixel: a disc that is brighter than white is clipped by channels, as one of R, G and B is.
 */
#include "highlights/highlights.h"

#include <string.h>

#include "support/compare.h"

enum { LANES = RF_TILE * RF_TILE, WHITE = RF_MEAN_MAX };

/* The means of the rows that share samples of chroma, and the light that is added there. */
struct rows {
    uint16_t *luma, *chroma;
    const uint16_t *light[3];
    int count; /* rows, 1 or 2 */
};

/* Whether pixels, and so those that share their samples, get any light. Returns whether one does.
 */
static bool find_lit(const struct rows *rows, uint16_t lit[RF_TILE])
{
    uint16_t any[RF_TILE] = {0}, all = 0;

    for (int y = 0; y < rows->count; y++)
        for (int x = 0; x < RF_TILE; x++)
            any[x] |= rows->light[0][y * RF_TILE + x] | rows->light[1][y * RF_TILE + x] |
                      rows->light[2][y * RF_TILE + x];
    for (int x = 0; x < RF_TILE; x++) {
        lit[x] = any[x & ~1] | any[x | 1];
        all |= lit[x];
    }
    return all != 0;
}

/* Means alone may be below 0: luminance was subtracted from the light of the rays, and chroma not.
 */
static int32_t lighter(int32_t mean, int32_t light)
{
    return rf_smaller(rf_larger(mean + light, 0), WHITE);
}

static void add_light(const struct rows *rows, const struct rf_yuv_curve *curve)
{
    int32_t more[3][RF_TILE], sum[2][RF_TILE] = {{0}};
    uint16_t lit[RF_TILE];

    if (!find_lit(rows, lit))
        return;
    for (int x = 0; x < RF_TILE; x++) {
        more[2][x] = rows->chroma[x & ~1] - 4 * RF_CHROMA_ZERO;
        more[0][x] = rows->chroma[x | 1] - 4 * RF_CHROMA_ZERO;
        more[1][x] = -(curve->red * more[0][x] + curve->blue * more[2][x]) / RF_SHARE;
    }
    for (int i = 0; i < rows->count * RF_TILE; i += RF_TILE)
        for (int x = 0; x < RF_TILE; x++) {
            const int32_t own = rows->luma[i + x];
            const int32_t r = lighter(own + more[0][x], rows->light[0][i + x]);
            const int32_t g = lighter(own + more[1][x], rows->light[1][i + x]);
            const int32_t b = lighter(own + more[2][x], rows->light[2][i + x]);
            const int32_t all =
                (curve->kr * r + curve->kg * g + curve->kb * b + RF_SHARE / 2) >> 14;

            rows->luma[i + x] = (uint16_t)(lit[x] ? all : own);
            sum[0][x] += b - all;
            sum[1][x] += r - all;
        }
    for (int x = 0; x < RF_TILE; x++)
        if (lit[x]) {
            const int n = 2 * rows->count, both = sum[x & 1][x & ~1] + sum[x & 1][x | 1];

            rows->chroma[x] = (uint16_t)((n * 4 * RF_CHROMA_ZERO + both + n / 2) / n);
        }
}

void rf_splat_yuv_highlights(const struct rf_splat *splat, const struct rf_tile_plan *plan, int tx,
                             int ty, void *share, uint16_t *luma, uint16_t *chroma)
{
    const struct rf_yuv *yuv = splat->window.yuv;
    const int count = 1 << yuv->down;
    uint16_t light[3][LANES];

    if (!plan->highlight)
        return;
    memset(light, 0, sizeof light);
    rf_splat_highlights(splat, plan, tx, ty, share,
                        (uint16_t *const[3]){light[0], light[1], light[2]});
    for (int i = 0; i < LANES; i += count * RF_TILE) {
        const struct rows rows = {
            luma + i, chroma + (i >> yuv->down), {light[0] + i, light[1] + i, light[2] + i}, count};

        add_light(&rows, &yuv->curve);
    }
}
