/* noise.c: how much noise the photo has in each brightness, and how coarse it is.
 *
 * What is measured in blocks of 8 x 8 pixels of luma is the mean square of second differences
 * along rows and columns, between neighbours and between every other pixel, which is 6 sigma^2 of
 * white noise. Noise is in all blocks and texture in some, so of the blocks of one brightness the
 * hundredth that is smoothest every other pixel counts; of white noise alone it is at 0.74 sigma.
 *
 * Texture is told from noise by how much it differs from block to block: a quarter of the blocks of
 * a brightness have at most 2.2 times the noise of the smoothest hundredth where that is noise, and
 * more than 2.8 times where it is a texture that fills all of them. They have as good as the same
 * where it is a pattern, as stripes are. And it is told by distance: noise does not differ more
 * between pixels that are farther apart, beyond its own size, and texture does, as light and shade
 * of cloth, bricks or grass are larger than a pixel. So the smoothest blocks are those of texture
 * where the variance between every fourth pixel, which reaches out of the block, is four times that
 * between every other one, as that of slopes is, and of noise up to twice, as chance alone has it.
 * The side of a block that differs most does not count, as it may be an edge.
 *
 * A brightness of texture takes the least noise of the others, and a photo of which less than two
 * fifths of the blocks have a brightness of noise has none: flowers, leaves and grass have no
 * smooth place to tell it by. What is too smooth to have noise that counts is of neither.
 *
 * A texture that is alike in all blocks of a brightness is told by the other brightnesses, from
 * which noise follows within bounds. A code of sRGB is about 269 light^(1/2.4) - 14, so that a
 * change of light is one of codes as (code + 14)^-1.4. Noise of reading the sensor does not hang on
 * light and goes by that, shot noise goes with the root of light and so by (code + 14)^-0.2. About
 * midway, the power of 0.75, is the most by which noise rises towards the dark: from code 208 to
 * 48 it is (224 / 64)^0.75 = 2.6 times. A tone curve that is a quarter steeper in one brightness
 * than in another makes that 1.25 times as much, and allows 1.25 times towards what is bright. The
 * darkest and the brightest blocks, in which curves and clipping may have smoothed noise, do not
 * limit others. Rounding to codes, 1/12 code^2, is taken out. Below one code nothing is noise: such
 * photos stay as they are, byte by byte.
 *
 * The size of the grain: noise is taken to be white noise smoothed by (a, 1, a) each way, and a
 * follows from the ratio of differences between neighbours to those of every other pixel.
 */
#include "look/look.h"

#include <assert.h>
#include <limits.h>
#include <math.h>
#include <string.h>

#include "image/format.h"
#include "support/compare.h"

enum {
    BLOCK = 8,
    MOST_BLOCKS = 8192, /* larger photos are measured in every second, third... block each way */
    FEW = 100,          /* fewer blocks say nothing of a level */
    FEWEST = 5,         /* the smoothest are so many at least */
    REACH = 4,          /* pixels around a block that are looked at, too */
    SIDE = BLOCK + 2 * REACH,
    MOST_SAMPLES = 2 * BLOCK * BLOCK,    /* second differences of a block */
    MOST_SQUARE = (2 * 251) * (2 * 251), /* second differences of codes from 2 to 253 */
    OCTAVE = 64,                         /* bins of an octave of variance */
    MOST_NEAR = 1 << 17,                 /* larger variances between neighbours count as this */
    ROUGH = 256,                         /* a block of texture counts as this */
    MOST_SIGMA = 64,                     /* codes; as are larger standard deviations */
};
static_assert(16 * MOST_SAMPLES <= INT32_MAX / MOST_SQUARE, "sums of squares");
static_assert(16 * MOST_SQUARE / 6 < 2 * OCTAVE << (RF_NOISE_BINS / OCTAVE - 2), "a bin for each");
static_assert(MOST_NEAR <= UINT32_MAX / 2 / MOST_BLOCKS, "sums of variances");
static_assert(16 * MOST_SQUARE / 6 <= INT32_MAX / ROUGH, "products of variances");

/* How much steeper a tone curve is in one brightness than in another; the standard deviations, in
 * codes, up to which nothing is noise and from which all is; that of a quarter of the blocks, as
 * times that of the smoothest hundredth, up to which a brightness is one of noise, and from which
 * on of texture; the part of the blocks up to which those of noise tell nothing, and from which on
 * they tell all. All but the first were chosen on five path-traced and six noisy scenes. Up to the
 * first of the next two that standard deviation is that of a pattern, and from the second one on
 * chance alone: so much have a hundred blocks of white noise at least. */
static const double steeper = 1.25, silent = 1.0, heard = 1.5;
static const double noise_spread = 2.2, texture_spread = 2.8, few_blocks = 0.4, enough_blocks = 0.6;
static const double pattern_spread = 1.04, chance_spread = 1.08;

/* The variance between every fourth pixel, as times that between every other one, up to which a
 * block is one of noise, and from which on of texture. */
static const int noise_growth = 2, texture_growth = 4;

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
    return rf_luma(code[0], code[1], code[2]);
}

/* Second differences between three pixels a step apart: their squares, and how many. */
struct differences {
    int squares, count;
};

/* Adds one; lumas below 0 are not known. */
static void add_difference(struct differences *to, int before, int middle, int after)
{
    const int difference = before - 2 * middle + after;

    if (before >= 0 && after >= 0) {
        to->squares += difference * difference;
        to->count++;
    }
}

/* The variance that makes them, in 1/16 code^2. */
static int variance_of_differences(struct differences d)
{
    return 16 * d.squares / (6 * d.count);
}

/* Variance of a block between pixels step apart along rows and columns. */
static int variance_within(int v[SIDE][SIDE], int step)
{
    struct differences all = {0, 0};

    for (int i = REACH; i < REACH + BLOCK; i++) {
        for (int k = REACH + step; k < REACH + BLOCK - step; k++) {
            add_difference(&all, v[i][k - step], v[i][k], v[i][k + step]);
            add_difference(&all, v[k - step][i], v[k][i], v[k + step][i]);
        }
    }
    return variance_of_differences(all);
}

/* Variance between the pixels of a block and those around it, which are REACH away, -1 if these are
 * not known. Of the four sides that have some the one with most is left out: there may be an edge.
 */
static int variance_beyond(int v[SIDE][SIDE])
{
    struct differences side[4] = {{0, 0}};
    int sum = 0, most = 0, sides = 0;

    for (int i = REACH; i < REACH + BLOCK; i++) {
        for (int k = REACH; k < REACH + BLOCK; k++) {
            const int after = k >= REACH + BLOCK / 2;

            add_difference(&side[after], v[i][k - REACH], v[i][k], v[i][k + REACH]);
            add_difference(&side[2 + after], v[k - REACH][i], v[k][i], v[k + REACH][i]);
        }
    }
    for (int i = 0; i < 4; i++) {
        if (side[i].count > 0) {
            const int variance = variance_of_differences(side[i]);

            sum += variance;
            most = rf_larger(most, variance);
            sides++;
        }
    }
    return sides > 1 ? (sum - most) / (sides - 1) : -1;
}

/* The bin of a variance in 1/16 code^2: below 128 each has its own, then OCTAVE share an octave. */
static int bin_of(int variance)
{
    int octave = 0;

    while (variance >> octave >= 2 * OCTAVE)
        octave++;
    return OCTAVE * octave + (variance >> octave);
}

/* The middle of a bin, in code^2. */
static double middle_of(int bin)
{
    const int octave = rf_larger(bin / OCTAVE - 1, 0);

    return (bin - OCTAVE * octave + 0.5) * (1 << octave) / 16;
}

/* Reads a block; of no use are those that touch black or white. */
static bool read_block(int v[SIDE][SIDE], const struct rf_photo_source *photo, int x0, int y0)
{
    for (int y = 0; y < BLOCK; y++)
        for (int x = 0; x < BLOCK; x++)
            if ((v[REACH + y][REACH + x] = luma_at(photo, x0 + x, y0 + y)) < 0)
                return false;
    return true;
}

/* Reads what is beside a block and above and below it, -1 beyond the photo. */
static void read_around(int v[SIDE][SIDE], const struct rf_photo_source *photo, int x0, int y0)
{
    for (int i = 0; i < BLOCK; i++) {
        for (int k = 0; k < 2 * REACH; k++) {
            const int at = k < REACH ? k : BLOCK + k; /* before and after the block */
            const int x = x0 - REACH + at, y = y0 - REACH + at;

            v[REACH + i][at] = x >= 0 && x < photo->width ? luma_at(photo, x, y0 + i) : -1;
            v[at][REACH + i] = y >= 0 && y < photo->height ? luma_at(photo, x0 + i, y) : -1;
        }
    }
}

/* How much a block is one of texture, by its variances between every other and every fourth pixel:
 * 0 to ROUGH. */
static int roughness_of(int variance, int farther)
{
    const int from = noise_growth * rf_larger(variance, 1);
    const int range = (texture_growth - noise_growth) * rf_larger(variance, 1);

    if (farther < 0)
        return ROUGH;
    return ROUGH * rf_smaller(rf_larger(farther - from, 0), range) / range;
}

static void count_block(struct rf_grain *grain, const struct rf_photo_source *photo, int x0, int y0)
{
    int v[SIDE][SIDE], sum = 0;

    if (!read_block(v, photo, x0, y0))
        return;
    read_around(v, photo, x0, y0);
    for (int y = 0; y < BLOCK; y++)
        for (int x = 0; x < BLOCK; x++)
            sum += v[REACH + y][REACH + x];
    {
        const int level = sum / (BLOCK * BLOCK) / RF_NOISE_WIDTH;
        const int variance = variance_within(v, 2), bin = bin_of(variance);
        const int near = variance_within(v, 1);

        grain->blocks[level][bin]++;
        grain->near[level][bin] += (uint32_t)rf_smaller(near, MOST_NEAR);
        grain->rough[level][bin] += (uint32_t)roughness_of(variance, variance_beyond(v));
    }
}

static void count_blocks(const struct rf_look *look)
{
    const struct rf_photo_source *photo = &look->photo;
    const int64_t blocks = (int64_t)(photo->width / BLOCK) * (photo->height / BLOCK);
    int step = BLOCK;

    memset(look->grain->blocks, 0, sizeof look->grain->blocks);
    memset(look->grain->near, 0, sizeof look->grain->near);
    memset(look->grain->rough, 0, sizeof look->grain->rough);
    while (blocks > (int64_t)MOST_BLOCKS * (step / BLOCK) * (step / BLOCK))
        step += BLOCK;
    for (int y = 0; y + BLOCK <= photo->height && !rf_cancelled(look->exec); y += step)
        for (int x = 0; x + BLOCK <= photo->width; x += step)
            count_block(look->grain, photo, x, y);
}

/* Sums over the smoothest blocks, in code^2. */
struct smoothest {
    double near, far;
};

/* The noise of a level. */
struct level {
    uint32_t blocks;
    double variance; /* The smoothest hundredth has it, in code^2; -1: there are too few blocks. */
    double noise;    /* 0: it is texture, to 1: it is noise */
    bool limits;     /* Others have no more noise than follows from it. */
};

/* 0 to 1 as v goes from a to b. */
static double ramp(double v, double a, double b)
{
    return fmin(fmax((v - a) / (b - a), 0), 1);
}

static struct level level_of(const struct rf_grain *grain, int level, struct smoothest *sums)
{
    const uint32_t *blocks = grain->blocks[level];
    struct level of = {0, -1, 0, false};
    uint32_t passed = 0, rough = 0;
    double spread;
    int bin = 0;

    for (int i = 0; i < RF_NOISE_BINS; i++)
        of.blocks += blocks[i];
    if (of.blocks < FEW)
        return of;
    for (; passed < FEWEST || passed < of.blocks / 100; bin++) {
        passed += blocks[bin];
        sums->near += grain->near[level][bin] / 16.0;
        sums->far += blocks[bin] * middle_of(bin);
        rough += grain->rough[level][bin];
    }
    of.variance = middle_of(bin - 1);
    of.noise = 1 - rough / ((double)ROUGH * passed);
    while (passed < of.blocks / 4)
        passed += blocks[bin++];
    spread = sqrt(middle_of(bin - 1) / of.variance);
    of.noise *= 1 - ramp(spread, noise_spread, texture_spread);
    of.noise *= ramp(spread, pattern_spread, chance_spread);
    return of;
}

/* The levels between the first and the last that have a value limit others; of two, both do. */
static void set_limits(struct level level[RF_NOISE_LEVELS])
{
    int known[RF_NOISE_LEVELS], count = 0;

    for (int i = 0; i < RF_NOISE_LEVELS; i++)
        if (level[i].variance >= 0)
            known[count++] = i;
    for (int i = 0; i < count; i++)
        level[known[i]].limits = count < 3 || (i > 0 && i < count - 1);
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

    for (int i = 0; i < RF_GRAIN_PLACES; i++) {
        const double radius = (i * 32 + 16) / 256.0, area = 3.14159265358979 * radius * radius;
        const double left = area > along * along ? along * along / area : 1;

        grain->lost[i] = (uint8_t)floor(sqrt(1 - left) * 255 + 0.5);
    }
}

/* The part of the blocks that are of a brightness of noise, out of all that are not too smooth. */
static double part_of_noise(const struct level level[RF_NOISE_LEVELS])
{
    double noise = 0, all = 0;

    for (int i = 0; i < RF_NOISE_LEVELS; i++) {
        const double codes = level[i].variance < 0 ? heard : sqrt(level[i].variance);
        const double blocks = level[i].blocks * ramp(codes, silent, heard);

        noise += blocks * level[i].noise;
        all += blocks;
    }
    return all > 0 ? noise / all : 0;
}

/* Most variance of the noise of a level / that of another one: of the middles of both, which are
 * 32 level + 16, code + 14 is about 32 (level + 1). */
static double most_ratio(int level, int other)
{
    const double brighter = fmax((other + 1.0) / (level + 1.0), 1);

    return steeper * steeper * brighter * sqrt(brighter);
}

/* Variance of the noise of a level that has some, in code^2. */
static double variance_of(const struct level level[RF_NOISE_LEVELS], int of)
{
    double own = level[of].variance, least = own;

    for (int i = 0; i < RF_NOISE_LEVELS; i++) {
        if (level[i].limits && i != of) {
            own = fmin(own, level[i].variance * most_ratio(of, i));
            least = fmin(least, level[i].variance);
        }
    }
    return level[of].noise * own + (1 - level[of].noise) * fmin(own, least);
}

/* Standard deviations of the levels in 1/256 code, -1 of those without a value. */
static void set_sigma(const struct level level[RF_NOISE_LEVELS], int sigma[RF_NOISE_LEVELS])
{
    const double enough = ramp(part_of_noise(level), few_blocks, enough_blocks);

    for (int i = 0; i < RF_NOISE_LEVELS; i++) {
        const double all = sqrt(fmax(variance_of(level, i), 0));
        const double codes = fmin(all, MOST_SIGMA) * enough;

        sigma[i] =
            level[i].variance < 0 ? -1 : (int)floor(codes * ramp(codes, silent, heard) * 256 + 0.5);
    }
}

void rf_measure_grain(const struct rf_look *look)
{
    struct rf_grain *grain = look->grain;
    struct smoothest sums = {0, 0};
    struct level level[RF_NOISE_LEVELS];
    int sigma[RF_NOISE_LEVELS];
    double a, selected;

    grain->any = false;
    count_blocks(look);
    for (int i = 0; i < RF_NOISE_LEVELS; i++)
        level[i] = level_of(grain, i, &sums);
    /* Selected as they are, white noise has a ratio of 1.4, a = 0.3 one of 0.65, 0.5 one of 0.4. */
    a = sums.far > 0 ? fmin(fmax((1.4 - sums.near / sums.far) / 2.2, 0), 0.5) : 0;
    selected = 0.74 - 0.28 * a;
    for (int i = 0; i < RF_NOISE_LEVELS; i++)
        if (level[i].variance >= 0)
            level[i].variance = fmax(level[i].variance / (selected * selected) - 1 / 12.0, 0);
    set_limits(level);
    set_sigma(level, sigma);
    fill_levels(sigma, grain->sigma);
    for (int i = 0; i < RF_NOISE_LEVELS; i++)
        grain->any |= grain->sigma[i] > 0;
    grain->side = (int)floor(a * RF_GRAIN_UNIT + 0.5);
    set_lost(grain, a);
}
