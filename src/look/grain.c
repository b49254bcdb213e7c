/* grain.c: the noise of the photo, which noise.c measures, put back where blur has averaged it
 * away.
 *
 * Blur takes a known part of it: a mean over a disc of radius r leaves the area of a grain /
 * (pi r^2) of the variance.
 *
 * The grain is made of hashes of place and seed: sums of four bytes, nearly Gaussian.
 */
#include "look/look.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

#include "support/compare.h"

/* Standard deviation measured at a luma: between the middles of the levels in proportion. */
static int measured_at(const struct rf_grain *grain, int code)
{
    const int from = code - RF_NOISE_WIDTH / 2, last = RF_NOISE_LEVELS - 1;
    const int level = from < 0 ? 0 : from / RF_NOISE_WIDTH;
    const int part = from < 0 ? 0 : from % RF_NOISE_WIDTH;

    if (level >= last)
        return grain->sigma[last];
    return (grain->sigma[level] * (RF_NOISE_WIDTH - part) + grain->sigma[level + 1] * part) /
           RF_NOISE_WIDTH;
}

/* Standard deviation that a luma takes. Three of them fit between it and black and white: a photo's
 * noise is cut off there, and what is cut off on one side would make black grey. */
static int sigma_at(const struct rf_grain *grain, int code)
{
    return rf_smaller(measured_at(grain, code), 256 * rf_smaller(code, 255 - code) / 3);
}

/* Sum of four random bytes about 0: standard deviation sqrt(4 (256^2 - 1) / 12) =
 * 147.8. */
static int noise_at(int x, int y, uint32_t seed)
{
    uint32_t h = seed * 0x9e3779b9u + (uint32_t)x * 0x85ebca6bu + (uint32_t)y * 0xc2b2ae35u;

    h = (h ^ (h >> 16)) * 0x7feb352du;
    h = (h ^ (h >> 15)) * 0x846ca68bu;
    h ^= h >> 16;
    return (int)((h & 255) + (h >> 8 & 255) + (h >> 16 & 255) + (h >> 24)) - 510;
}

/* Smoothed noise of a row of pixels, times RF_GRAIN_UNIT^2 (1 + 2 a^2). */
static void noise_of_row(int32_t *noise, int count, int x0, int y, int a, uint32_t seed)
{
    int32_t down[RF_TILE + 2];

    assert(count <= RF_TILE);
    for (int i = 0; i < count + 2; i++)
        down[i] =
            RF_GRAIN_UNIT * noise_at(x0 + i - 1, y, seed) +
            (a ? a * (noise_at(x0 + i - 1, y - 1, seed) + noise_at(x0 + i - 1, y + 1, seed)) : 0);
    for (int i = 0; i < count; i++)
        noise[i] = RF_GRAIN_UNIT * down[i + 1] + a * (down[i] + down[i + 2]);
}

static uint8_t clamp(int code)
{
    return (uint8_t)(code < 0 ? 0 : code > 255 ? 255 : code);
}

void rf_add_grain(const struct rf_look *look, const struct rf_canvas *canvas, struct rf_rect rect)
{
    const struct rf_viewport *view = canvas->view;
    const struct rf_grain *grain = look->grain;
    const int64_t amount = (int64_t)floorf(look->params->grain * 256 + 0.5f);
    /* one code of what is multiplied below */
    const int64_t unit = (int64_t)(147.80 * 256 * 256 * 255) *
                         (RF_GRAIN_UNIT * RF_GRAIN_UNIT + 2 * grain->side * grain->side);
    int32_t noise[RF_TILE];

    if (!grain->any)
        return;
    for (int y = rect.y0; y < rect.y1; y++) {
        noise_of_row(noise, rect.x1 - rect.x0, view->x0 + rect.x0, view->y0 + y, grain->side,
                     look->params->grain_seed);
        for (int x = rect.x0; x < rect.x1; x++) {
            const int16_t s = canvas->blur.at[y * canvas->blur.stride + x];
            const int place = rf_in_pixels(abs(s), canvas->blur.unit) >> 5;
            const int lost = grain->lost[rf_smaller(place, RF_GRAIN_PLACES - 1)];
            uint8_t *code[3];
            int64_t add;
            int change;

            if (lost == 0)
                continue;
            rf_codes_at(canvas, x, y, code);
            add = amount * lost * noise[x - rect.x0] *
                  sigma_at(grain, rf_luma(*code[0], *code[1], *code[2]));
            change = (int)((llabs(add) + unit / 2) / unit);
            for (int c = 0; c < 3; c++)
                *code[c] = clamp(*code[c] + (add < 0 ? -change : change));
        }
    }
}
