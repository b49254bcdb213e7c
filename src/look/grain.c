/* grain.c: the noise of the photo, put back where blur has averaged it away.
 *
 * Its strength is measured: in each block of 8 x 8 pixels that this lens leaves sharp, the mean
 * square of the second difference of luma along rows is 6 sigma^2 of its noise, and more where
 * there is texture. Of the blocks of one brightness the smoothest quarter holds noise alone; its
 * median, the eighth of all, is 0.71 of the mean where all blocks are noise alone.
 *
 * Blur takes a known part of it: a mean over a disc of radius r leaves 1 / (pi r^2) of the
 * variance.
 *
 * The grain is a hash of place and seed: the sum of four bytes, nearly Gaussian.
 */
#include "look/look.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "depth/dequantise.h"
#include "image/format.h"
#include "support/compare.h"

#define SMOOTHEST 0.71

enum { BLOCK = 8, LEVEL_WIDTH = 256 / RF_NOISE_LEVELS, FEW = 24, SHARP = 128 };
static_assert(16 * BLOCK * (BLOCK - 2) * (2 * 251) * (2 * 251) <= INT32_MAX,
              "squares of second differences of codes from 2 to 253, in 1/16");
enum { PLACES = sizeof((struct rf_grain *)0)->lost / sizeof((struct rf_grain *)0)->lost[0] };

static int luma(int r, int g, int b)
{
    return (54 * r + 183 * g + 19 * b + 128) >> 8;
}

static int luma_at(const struct rf_photo_source *photo, int x, int y)
{
    uint16_t *const *const light = photo->light.channel;
    const uint8_t *to_code = photo->transfer->to_code;
    const ptrdiff_t at = y * photo->light.stride + x;

    if (!rf_has_planes(photo)) {
        const struct refocus_image *image = photo->image;
        const struct rf_order o = rf_order_of(image->format);
        const uint8_t *code = image->plane[0] + y * image->stride[0] + (ptrdiff_t)x * o.bytes;

        return luma(code[o.r], code[o.g], code[o.b]);
    }
    return luma(to_code[4 * light[0][at]], to_code[4 * light[1][at]], to_code[4 * light[2][at]]);
}

static bool is_blurred(const struct rf_look *look, int x0, int y0)
{
    int16_t blur[BLOCK * BLOCK];

    _Static_assert((int)BLOCK <= (int)RF_DEQUANTISE_PATCH, "blocks are patches");
    rf_blurs_at(look, x0, y0, BLOCK, BLOCK, blur);
    for (int i = 0; i < BLOCK * BLOCK; i++)
        if (rf_in_pixels(abs(blur[i]), look->plan->focus.unit) >= SHARP)
            return true;
    return false;
}

/* Variance of a block's noise in 1/16, and its mean; -1 when it does not count: it is
 * not sharp, or touches black or white, where noise is cut off. */
static int block_variance(const struct rf_look *look, int x0, int y0, bool any_blur, int *mean)
{
    int sum = 0, square = 0;

    if (!any_blur && is_blurred(look, x0, y0))
        return -1;
    for (int y = y0; y < y0 + BLOCK; y++) {
        int v[BLOCK];

        for (int x = 0; x < BLOCK; x++) {
            v[x] = luma_at(&look->photo, x0 + x, y);
            sum += v[x];
            if (v[x] < 2 || v[x] > 253)
                return -1;
        }
        for (int x = 1; x < BLOCK - 1; x++) {
            const int second = v[x - 1] - 2 * v[x] + v[x + 1];

            square += second * second;
        }
    }
    *mean = sum / (BLOCK * BLOCK);
    return 16 * square / (6 * BLOCK * (BLOCK - 2));
}

static uint32_t count_blocks(const struct rf_look *look, bool any_blur)
{
    const struct rf_photo_source *photo = &look->photo;
    struct rf_grain *grain = look->grain;
    uint32_t count = 0;

    memset(grain->blocks, 0, sizeof grain->blocks);
    for (int y = 0; y + BLOCK <= photo->height && !rf_cancelled(look->exec); y += BLOCK) {
        for (int x = 0; x + BLOCK <= photo->width; x += BLOCK) {
            int mean;
            const int variance = block_variance(look, x, y, any_blur, &mean);

            if (variance < 0)
                continue;
            grain->blocks[mean / LEVEL_WIDTH]
                         [variance < RF_NOISE_BINS ? variance : RF_NOISE_BINS - 1]++;
            count++;
        }
    }
    return count;
}

/* Standard deviation, 1/256 code; -1: there are too few blocks. */
static int sigma_of(const uint32_t blocks[RF_NOISE_BINS])
{
    uint32_t sum = 0, passed = 0;
    int bin = 0;

    for (int i = 0; i < RF_NOISE_BINS; i++)
        sum += blocks[i];
    if (sum < FEW)
        return -1;
    while ((passed += blocks[bin]) * 8 < sum)
        bin++;
    return (int)floor(sqrt((bin + 0.5) / 16 / SMOOTHEST) * 256 + 0.5);
}

/* Levels without blocks of their own take the nearest that has some. */
static void fill_levels(const int sigma[RF_NOISE_LEVELS], uint16_t out[RF_NOISE_LEVELS])
{
    for (int i = 0; i < RF_NOISE_LEVELS; i++) {
        out[i] = 0;
        for (int away = 0; away < RF_NOISE_LEVELS; away++) {
            const int below = i - away, above = i + away;
            const int found = below >= 0 && sigma[below] >= 0                ? sigma[below]
                              : above < RF_NOISE_LEVELS && sigma[above] >= 0 ? sigma[above]
                                                                             : -1;

            if (found >= 0) {
                out[i] = (uint16_t)found;
                break;
            }
        }
    }
}

void rf_measure_grain(const struct rf_look *look)
{
    struct rf_grain *grain = look->grain;
    int sigma[RF_NOISE_LEVELS];

    if (count_blocks(look, false) < FEW)
        count_blocks(look, true);
    for (int i = 0; i < RF_NOISE_LEVELS; i++)
        sigma[i] = sigma_of(grain->blocks[i]);
    fill_levels(sigma, grain->sigma);
    for (int i = 0; i < PLACES; i++) {
        const double radius = (i * 32 + 16) / 256.0, area = 3.14159265358979 * radius * radius;
        const double left = area > 1 ? 1 / area : 1;

        grain->lost[i] = (uint8_t)floor(sqrt(1 - left) * 255 + 0.5);
    }
}

/* Standard deviation at a luma: between the middles of the levels in proportion. */
static int sigma_at(const struct rf_grain *grain, int code)
{
    const int from = code - LEVEL_WIDTH / 2, last = RF_NOISE_LEVELS - 1;
    const int level = from < 0 ? 0 : from / LEVEL_WIDTH;
    const int part = from < 0 ? 0 : from % LEVEL_WIDTH;

    if (level >= last)
        return grain->sigma[last];
    return (grain->sigma[level] * (LEVEL_WIDTH - part) + grain->sigma[level + 1] * part) /
           LEVEL_WIDTH;
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

static uint8_t clamp(int code)
{
    return (uint8_t)(code < 0 ? 0 : code > 255 ? 255 : code);
}

void rf_add_grain(const struct rf_look *look, const struct rf_canvas *canvas, struct rf_rect rect)
{
    const struct rf_viewport *view = canvas->view;
    const int64_t amount = (int64_t)floorf(look->params->grain * 256 + 0.5f);
    /* one code of what is multiplied below */
    const int64_t unit = (int64_t)(147.80 * 256 * 256 * 255);

    for (int y = rect.y0; y < rect.y1; y++) {
        for (int x = rect.x0; x < rect.x1; x++) {
            const int16_t s = canvas->blur.at[y * canvas->blur.stride + x];
            const int place = rf_in_pixels(abs(s), canvas->blur.unit) >> 5;
            const int lost = look->grain->lost[rf_smaller(place, PLACES - 1)];
            uint8_t *code[3];
            int64_t add;
            int change;

            if (lost == 0)
                continue;
            rf_codes_at(canvas, x, y, code);
            add = amount * lost * noise_at(view->x0 + x, view->y0 + y, look->params->grain_seed) *
                  sigma_at(look->grain, luma(*code[0], *code[1], *code[2]));
            change = (int)((llabs(add) + unit / 2) / unit);
            for (int c = 0; c < 3; c++)
                *code[c] = clamp(*code[c] + (add < 0 ? -change : change));
        }
    }
}
