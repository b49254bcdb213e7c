/* grain.c: the noise of the photo, put back where blur has averaged it away.
 *
 * What is measured in blocks of 8 x 8 pixels of luma is the mean square of second differences
 * along rows and columns, between neighbours and between every other pixel, which is 6 sigma^2 of
 * white noise. Noise is in all blocks and texture in some, so of the blocks of one brightness the
 * hundredth that is smoothest every other pixel counts; of white noise alone it is at 0.74 sigma.
 *
 * Texture is told from noise by how much it differs from block to block: a quarter of the blocks of
 * a brightness have at most 2.2 times the noise of the smoothest hundredth where that is noise, and
 * more than 2.8 times where it is a texture that fills all of them. A brightness of texture takes
 * the least noise of the others, and a photo of which less than two fifths of the blocks have a
 * brightness of noise has none: flowers, leaves and grass have no smooth place to tell it by.
 *
 * A texture that is alike in all blocks of a brightness is told by the other brightnesses: from the
 * least noise of a photo to the most is a factor of 1.6 at most. The darkest and the brightest
 * blocks, in which curves and clipping may have smoothed noise, do not limit others. Below one code
 * nothing is noise: such photos stay as they are, byte by byte.
 *
 * The size of the grain: noise is taken to be white noise smoothed by (a, 1, a) each way, and a
 * follows from the ratio of differences between neighbours to those of every other pixel.
 *
 * Blur takes a known part of it: a mean over a disc of radius r leaves the area of a grain /
 * (pi r^2) of the variance.
 *
 * The grain is made of hashes of place and seed: sums of four bytes, nearly Gaussian.
 */
#include "look/look.h"

#include <assert.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "image/format.h"
#include "support/compare.h"

enum {
    BLOCK = 8,
    MOST_BLOCKS = 8192, /* larger photos are measured in every second, third... block each way */
    LEVEL_WIDTH = 256 / RF_NOISE_LEVELS,
    FEW = 100,    /* fewer blocks say nothing of a level */
    FEWEST = 5,   /* the smoothest are so many at least */
    UNIT_A = 128, /* unit of the smoothing's weights */
    /* second differences of a block, between neighbours and between every other pixel */
    SAMPLES1 = 2 * BLOCK * (BLOCK - 2),
    SAMPLES2 = 2 * BLOCK * (BLOCK - 4),
};
static_assert(SAMPLES1 * (2 * 251) * (2 * 251) <= INT32_MAX,
              "squares of second differences of codes from 2 to 253");
enum { PLACES = sizeof((struct rf_grain *)0)->lost / sizeof((struct rf_grain *)0)->lost[0] };

/* Most noise of a brightness / least; the standard deviations, in codes, up to which nothing is
 * noise and from which all is; that of a quarter of the blocks, as times that of the smoothest
 * hundredth, up to which a brightness is one of noise, and from which on of texture; the part of
 * the blocks up to which those of noise tell nothing, and from which on they tell all. They were
 * chosen on five path-traced and six noisy scenes. */
static const double most_ratio = 1.6, silent = 1.0, heard = 1.5;
static const double noise_spread = 2.2, texture_spread = 2.8, few_blocks = 0.4, enough_blocks = 0.6;

static int luma(int r, int g, int b)
{
    return (54 * r + 183 * g + 19 * b + 128) >> 8;
}

/* Luma, or -1 of a pixel that touches black or white in a channel, where noise is cut off. */
static int luma_at(const struct rf_photo_source *photo, int x, int y)
{
    const uint8_t *to_code = photo->transfer->to_code;
    int code[3];

    if (rf_has_planes(photo)) {
        for (int c = 0; c < 3; c++)
            code[c] = to_code[4 * photo->light.channel[c][y * photo->light.stride + x]];
    } else {
        const struct refocus_image *image = photo->image;
        const struct rf_order o = rf_order_of(image->format);
        const uint8_t *at = image->plane[0] + y * image->stride[0] + (ptrdiff_t)x * o.bytes;

        code[0] = at[o.r], code[1] = at[o.g], code[2] = at[o.b];
    }
    for (int c = 0; c < 3; c++)
        if (code[c] < 2 || code[c] > 253)
            return -1;
    return luma(code[0], code[1], code[2]);
}

/* Squares of the second differences of a block along rows and columns, between pixels step apart.
 */
static int sum_squares(int v[BLOCK][BLOCK], int step)
{
    int sum = 0;

    for (int i = 0; i < BLOCK; i++) {
        for (int k = step; k < BLOCK - step; k++) {
            const int across = v[i][k - step] - 2 * v[i][k] + v[i][k + step];
            const int down = v[k - step][i] - 2 * v[k][i] + v[k + step][i];

            sum += across * across + down * down;
        }
    }
    return sum;
}

static void count_block(struct rf_grain *grain, const struct rf_photo_source *photo, int x0, int y0)
{
    int v[BLOCK][BLOCK], sum = 0;

    for (int y = 0; y < BLOCK; y++) {
        for (int x = 0; x < BLOCK; x++) {
            if ((v[y][x] = luma_at(photo, x0 + x, y0 + y)) < 0)
                return;
            sum += v[y][x];
        }
    }
    {
        const int level = sum / (BLOCK * BLOCK) / LEVEL_WIDTH;
        const int last = RF_NOISE_BINS - 1;
        const int far = 16 * sum_squares(v, 2) / (6 * SAMPLES2);
        const int near = 16 * sum_squares(v, 1) / (6 * SAMPLES1);

        grain->blocks[level][rf_smaller(far, last)]++;
        grain->near[level][rf_smaller(far, last)] += (uint32_t)rf_smaller(near, 4 * last);
    }
}

static void count_blocks(const struct rf_look *look)
{
    const struct rf_photo_source *photo = &look->photo;
    const int64_t blocks = (int64_t)(photo->width / BLOCK) * (photo->height / BLOCK);
    int step = BLOCK;

    memset(look->grain->blocks, 0, sizeof look->grain->blocks);
    memset(look->grain->near, 0, sizeof look->grain->near);
    while (blocks > (int64_t)MOST_BLOCKS * (step / BLOCK) * (step / BLOCK))
        step += BLOCK;
    for (int y = 0; y + BLOCK <= photo->height && !rf_cancelled(look->exec); y += step)
        for (int x = 0; x + BLOCK <= photo->width; x += step)
            count_block(look->grain, photo, x, y);
}

/* Sums over the smoothest blocks. */
struct smoothest {
    double near, far;
};

/* The noise of a level. */
struct level {
    uint32_t blocks;
    double variance; /* The smoothest hundredth has it, in code^2; -1: there are too few blocks. */
    double noise;    /* 0: it is texture, to 1: it is noise */
};

/* 0 to 1 as v goes from a to b. */
static double ramp(double v, double a, double b)
{
    return fmin(fmax((v - a) / (b - a), 0), 1);
}

static struct level level_of(const struct rf_grain *grain, int level, struct smoothest *sums)
{
    const uint32_t *blocks = grain->blocks[level];
    struct level of = {0, -1, 0};
    uint32_t passed = 0;
    int bin = 0;

    for (int i = 0; i < RF_NOISE_BINS; i++)
        of.blocks += blocks[i];
    if (of.blocks < FEW)
        return of;
    for (; passed < FEWEST || passed < of.blocks / 100; bin++) {
        passed += blocks[bin];
        sums->near += grain->near[level][bin];
        sums->far += blocks[bin] * (bin + 0.5);
    }
    of.variance = (bin - 0.5) / 16;
    while (passed < of.blocks / 4)
        passed += blocks[bin++];
    if (bin < RF_NOISE_BINS) /* the last bin is of all that is rougher */
        of.noise = 1 - ramp(sqrt((bin - 0.5) / 16 / of.variance), noise_spread, texture_spread);
    return of;
}

/* The least of the levels between the first and the last with a value, or, where they are two at
 * most, of these. */
static double least_of(const struct level level[RF_NOISE_LEVELS])
{
    int first = RF_NOISE_LEVELS, last = -1;
    double least = INFINITY;

    for (int i = 0; i < RF_NOISE_LEVELS; i++) {
        if (level[i].variance < 0)
            continue;
        first = rf_smaller(first, i);
        last = i;
    }
    for (int i = 0; i < RF_NOISE_LEVELS; i++)
        if (level[i].variance >= 0 && (last - first < 2 || (i > first && i < last)))
            least = fmin(least, level[i].variance);
    return least < INFINITY ? least : fmax(fmin(level[first].variance, level[last].variance), 0);
}

/* Levels without blocks of their own take the least of the others. */
static void fill_levels(const int sigma[RF_NOISE_LEVELS], uint16_t out[RF_NOISE_LEVELS])
{
    int least = INT_MAX;

    for (int i = 0; i < RF_NOISE_LEVELS; i++)
        if (sigma[i] >= 0)
            least = rf_smaller(least, sigma[i]);
    for (int i = 0; i < RF_NOISE_LEVELS; i++)
        out[i] = (uint16_t)(sigma[i] >= 0 ? sigma[i] : least < INT_MAX ? least : 0);
}

/* Sets the share of the grain that each blur takes. */
static void set_lost(struct rf_grain *grain, double a)
{
    const double along = (1 + 2 * a) * (1 + 2 * a) / (1 + 2 * a * a);

    for (int i = 0; i < PLACES; i++) {
        const double radius = (i * 32 + 16) / 256.0, area = 3.14159265358979 * radius * radius;
        const double left = area > along * along ? along * along / area : 1;

        grain->lost[i] = (uint8_t)floor(sqrt(1 - left) * 255 + 0.5);
    }
}

/* The part of the blocks that are of a brightness of noise. */
static double part_of_noise(const struct level level[RF_NOISE_LEVELS])
{
    double noise = 0, all = 0;

    for (int i = 0; i < RF_NOISE_LEVELS; i++) {
        noise += level[i].blocks * level[i].noise;
        all += level[i].blocks;
    }
    return all > 0 ? noise / all : 0;
}

/* Variance of the noise of a level that has some, in code^2. */
static double variance_of(const struct level *level, double least)
{
    const double own = fmin(level->variance, most_ratio * most_ratio * least);

    return level->noise * own + (1 - level->noise) * fmin(own, least);
}

void rf_measure_grain(const struct rf_look *look)
{
    struct rf_grain *grain = look->grain;
    struct smoothest sums = {0, 0};
    struct level level[RF_NOISE_LEVELS];
    double least, a, enough;
    int sigma[RF_NOISE_LEVELS];

    grain->any = false;
    count_blocks(look);
    for (int i = 0; i < RF_NOISE_LEVELS; i++)
        level[i] = level_of(grain, i, &sums);
    least = sums.far > 0 ? least_of(level) : 0;
    enough = ramp(part_of_noise(level), few_blocks, enough_blocks);
    /* Selected as they are, white noise has a ratio of 1.4, a = 0.3 one of 0.65, 0.5 one of 0.4. */
    a = sums.far > 0 ? fmin(fmax((1.4 - sums.near / sums.far) / 2.2, 0), 0.5) : 0;
    for (int i = 0; i < RF_NOISE_LEVELS; i++) {
        const double codes = sqrt(fmax(variance_of(&level[i], least), 0)) / (0.74 - 0.28 * a);
        const double heard_codes = codes * enough * ramp(codes * enough, silent, heard);

        sigma[i] = level[i].variance < 0 ? -1 : (int)floor(heard_codes * 256 + 0.5);
        grain->any |= sigma[i] > 0;
    }
    fill_levels(sigma, grain->sigma);
    grain->side = (int)floor(a * UNIT_A + 0.5);
    set_lost(grain, a);
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

/* Smoothed noise of a row of pixels, times UNIT_A^2 (1 + 2 a^2). */
static void noise_of_row(int32_t *noise, int count, int x0, int y, int a, uint32_t seed)
{
    int32_t down[RF_TILE + 2];

    assert(count <= RF_TILE);
    for (int i = 0; i < count + 2; i++)
        down[i] =
            UNIT_A * noise_at(x0 + i - 1, y, seed) +
            (a ? a * (noise_at(x0 + i - 1, y - 1, seed) + noise_at(x0 + i - 1, y + 1, seed)) : 0);
    for (int i = 0; i < count; i++)
        noise[i] = UNIT_A * down[i + 1] + a * (down[i] + down[i + 2]);
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
    const int64_t unit =
        (int64_t)(147.80 * 256 * 256 * 255) * (UNIT_A * UNIT_A + 2 * grain->side * grain->side);
    int32_t noise[RF_TILE];

    if (!grain->any)
        return;
    for (int y = rect.y0; y < rect.y1; y++) {
        noise_of_row(noise, rect.x1 - rect.x0, view->x0 + rect.x0, view->y0 + y, grain->side,
                     look->params->grain_seed);
        for (int x = rect.x0; x < rect.x1; x++) {
            const int16_t s = canvas->blur.at[y * canvas->blur.stride + x];
            const int place = rf_in_pixels(abs(s), canvas->blur.unit) >> 5;
            const int lost = grain->lost[rf_smaller(place, PLACES - 1)];
            uint8_t *code[3];
            int64_t add;
            int change;

            if (lost == 0)
                continue;
            rf_codes_at(canvas, x, y, code);
            add = amount * lost * noise[x - rect.x0] *
                  sigma_at(grain, luma(*code[0], *code[1], *code[2]));
            change = (int)((llabs(add) + unit / 2) / unit);
            for (int c = 0; c < 3; c++)
                *code[c] = clamp(*code[c] + (add < 0 ? -change : change));
        }
    }
}
