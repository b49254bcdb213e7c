/* noise.c: how much noise the photo has in each brightness, and how coarse it is.
 *
 * noise_blocks.c measures blocks of 8 x 8 pixels. Noise is in all of them and texture in some, so
 * of the blocks of one brightness the hundredth that is smoothest every other pixel counts; of
 * white noise alone it is at 0.74 sigma.
 *
 * Texture is told from noise by the blocks themselves, and by how much it differs from block to
 * block: a quarter of the blocks of a brightness have at most 2.2 times the noise of the smoothest
 * hundredth where that is noise, and more than 2.8 times where it is a texture that fills all of
 * them. They have as good as the same where it is a pattern, as stripes are. Strong noise hides the
 * texture below it: beside noise of 10 codes a texture of 6 makes no more than 1.2 times as much.
 * So what a quarter of the blocks have on top of the noise is held against codes, too: sharpened
 * fur, leaves and gravel, whose smoothest hundredth has 10 codes, have more than 6.5 on top.
 *
 * Coarse noise is told by the bend that noise_blocks.c measures. Texture has one above 0 only where
 * its growth halves at least from one octave to the next; white noise has 0.35, since its smoothest
 * blocks were selected. From a quarter of an octave on all is noise. What counts is the mean of the
 * smoothest tenth: with a hundredth it is chance, and more than a tenth have edges in reach.
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
#include "look/noise_blocks.h"

#include <limits.h>
#include <math.h>

#include "support/compare.h"

enum {
    FEW = 100,       /* fewer blocks say nothing of a level */
    FEWEST = 5,      /* the smoothest are so many at least */
    MOST_SIGMA = 64, /* codes; as are larger standard deviations */
};

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

/* A quarter of the blocks of white noise alone have up to so many times the noise of the smoothest
 * hundredth; what they have beyond that is texture, in codes up to which a brightness is one of
 * noise, and from which on of texture. These were chosen on twelve photos. */
static const double noise_alone = 1.3, least_texture = 4.5, most_texture = 6.5;

/* The bend, in octaves, from which on a brightness is one of noise. */
static const double noise_bend = 0.25;

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
    double quarter, texture, spread;
    int bin = 0, bend = 0;

    for (int i = 0; i < RF_NOISE_BINS; i++)
        of.blocks += blocks[i];
    if (of.blocks < FEW)
        return of;
    for (; passed < FEWEST || passed < of.blocks / 100; bin++) {
        passed += blocks[bin];
        sums->near += grain->near[level][bin] / 16.0;
        sums->far += blocks[bin] * rf_noise_bin_middle(bin);
        rough += grain->rough[level][bin];
        bend += grain->bend[level][bin];
    }
    of.variance = rf_noise_bin_middle(bin - 1);
    of.noise = 1 - rough / ((double)RF_NOISE_ROUGH * passed);
    for (; passed < of.blocks / 10; bin++) {
        passed += blocks[bin];
        bend += grain->bend[level][bin];
    }
    of.noise = fmax(of.noise, ramp(bend / ((double)RF_NOISE_OCTAVE * passed), 0, noise_bend));
    while (passed < of.blocks / 4)
        passed += blocks[bin++];
    quarter = rf_noise_bin_middle(bin - 1);
    texture = sqrt(fmax(quarter - noise_alone * noise_alone * of.variance, 0));
    spread = sqrt(quarter / of.variance);
    of.noise *= 1 - ramp(texture, least_texture, most_texture);
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
    rf_count_noise_blocks(look);
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
