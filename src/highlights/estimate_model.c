/* estimate_model.c: estimates how many times as bright as white clipped pixels were.
 *
 * A lens scatters a little of a highlight's light around it: a core of blur, and glare that reaches
 * far. What is left of a highlight after clipping is this skirt. So the estimate for a cell is a
 * linear model of logarithms,
 *
 *     log2(gain) = softplus(4 z) / 4,  z = sum of w_i (f_i - m_i) / d_i,
 *
 * of how much around the cell is clipped (C_k, at scale k), how bright the rest is (U_k), how much
 * light the skirt has to each clipped area (X_k), how bright the photo is as a whole and around,
 * and what the clipped pixels look like. Its constants were fitted to captures of high dynamic
 * range seen through a model of a lens, noise and tone curve, by the squared error of blurred
 * pictures.
 *
 * By day most of what is clipped is paper, sky and skin, which have lost little. What the model
 * adds is limited by how dark the surroundings are: with t = (0.30 - U_4) / 0.24 from 0 to 1,
 *
 *     log2(gain) <= 3/4 + (5.5 - 3/4) t^2,
 *
 * and a speck on something bright, on a petal or on a cheek, gets nothing.
 * What is large, or hardly brighter than white by the model, is left as it is. A fixed gain goes to
 * what is left.
 *
 * By night the darkest of what is around a highlight shows little light but its glare, which a mean
 * does not tell from lit surroundings. Of what is clipped, had it lost nothing, a lens would make a
 * glare that falls off with the cube of the distance, a share of
 *
 *     g = sum of C_k / 2^(k - 1), k = 1 to 6.
 *
 * So by how much light grows with g, h = cov(Y, g) / var(g), is the gain times that share. The dark
 * counts most, by the weight 1 / (Y + 0.002)^2, and what is as bright everywhere, as a wall behind
 * white letters, not at all. The share is taken as 2^-4, so that too little is added rather than
 * too much:
 *
 *     log2(gain) >= min(log2(h) + 4, 2.5),
 *
 * by night alone: where the surroundings are dark, t^2 of it; in photos whose mean log2 of
 * luminance is above -3 nothing, and all from -4 down. This bound holds in full where the model has
 * half a stop, or where g explains 0.4 of the variance of light, and not at all where the model has
 * none and g explains less than 0.2 of it, as for snow on dark rock. It is faded out where what is
 * clipped is wide or crowded, as sky between leaves is, as C_5 goes from 0.35 to 0.55 of C_2.
 */
#include <math.h>

#include "highlights/estimate.h"
#include "support/compare.h"
#include "support/log2.h"

enum { BLOCK = 32 /* cells at once, side by side for vectors */ };
#define MOST_STOPS       4.0 /* a gain of 16 */
#define DAY_STOPS        0.75
#define NIGHT_STOPS      5.5
#define GLARE_STOPS      4.0
#define MOST_GLARE_STOPS 2.5
#define LEAST_CLIPPED    0.005f /* the least part of a cell that is clipped, for an estimate */
#define ALL_LARGE        0.9f   /* where this part of what is around is clipped, nothing is added */

/* A feature is log2 of a mean of the grid at a scale: C_k, U_k, X_k. The others are means
 * themselves: log2 of luminance, of the photo and of what is around, and the looks of the clipped
 * pixels, which are least channel to greatest, saturation of the skirt, and the parts of them whose
 * greatest channel, and whose least one, are at the end of the scale. */
enum kind { CLIPPED, UNCLIPPED, SKIRT, PHOTO, AROUND, GREY, SATURATION, PLATEAU, WHITE };

static const struct feature {
    enum kind kind;
    int scale;
    float weight, mean, deviation;
} model[] = {
    {CLIPPED, 0, 0.0975f, -0.2951f, 0.5592f},   {CLIPPED, 1, 0.1847f, -0.4261f, 0.6497f},
    {CLIPPED, 2, 0.0669f, -0.6625f, 0.8433f},   {CLIPPED, 3, 0.0423f, -1.0266f, 1.1324f},
    {CLIPPED, 4, -0.1096f, -1.4976f, 1.4065f},  {CLIPPED, 5, -0.0082f, -2.1055f, 1.6137f},
    {CLIPPED, 6, -0.2105f, -2.8504f, 1.7129f},  {UNCLIPPED, 0, -0.0247f, -2.3545f, 2.6701f},
    {UNCLIPPED, 1, 0.0242f, -1.9531f, 2.3142f}, {UNCLIPPED, 2, -0.1842f, -1.6687f, 1.8699f},
    {UNCLIPPED, 3, 0.0053f, -1.5735f, 1.4688f}, {UNCLIPPED, 4, -0.0041f, -1.6212f, 1.1544f},
    {UNCLIPPED, 5, 0.1224f, -1.8089f, 1.0033f}, {UNCLIPPED, 6, -0.5093f, -2.0958f, 0.9478f},
    {SKIRT, 0, -0.1575f, -4.3748f, 1.0592f},    {SKIRT, 1, 0.0344f, -4.0105f, 1.2694f},
    {SKIRT, 2, 0.283f, -3.5996f, 1.4463f},      {SKIRT, 3, 0.0782f, -3.1214f, 1.599f},
    {SKIRT, 4, 0.0055f, -2.6245f, 1.7546f},     {PHOTO, 0, -0.2155f, -3.1844f, 1.1148f},
    {AROUND, 0, 0.5419f, -2.0037f, 1.2966f},    {GREY, 1, 0.7777f, 0.817f, 0.2175f},
    {SATURATION, 1, 0.9995f, 0.193f, 0.2286f},  {PLATEAU, 1, -0.0432f, 0.7986f, 0.2547f},
    {WHITE, 1, 0.3535f, 0.4209f, 0.398f},
};
static const float constant = 0.4431f;

/* Means of the grid at the middles of the cells. */
struct means {
    float clipped[RF_GRID_SCALES][BLOCK], unclipped[RF_GRID_SCALES][BLOCK];
    float photo[BLOCK], around[BLOCK]; /* log2 of luminance */
    float grey[BLOCK], saturation[BLOCK], plateau[BLOCK], white[BLOCK];
    float glare[BLOCK];     /* log2 of how much light grows with g */
    float explained[BLOCK]; /* the part of light's variance that g explains; below 0: light falls */
};

static double within(double v, double least, double most)
{
    return v < least ? least : v > most ? most : v;
}

static double smoothstep(float v, double from, double to)
{
    const double t = within(((double)v - from) / (to - from), 0, 1);

    return t * t * (3 - 2 * t);
}

static float saturation(const struct rf_light_grid *grid, const struct rf_grid_place *place)
{
    const float r = rf_grid_at(grid, RF_GRID_RED, place),
                g = rf_grid_at(grid, RF_GRID_GREEN, place);
    const float b = rf_grid_at(grid, RF_GRID_BLUE, place);
    const float most = fmaxf(r, fmaxf(g, b));

    return (most - fminf(r, fminf(g, b))) / (most + 0.01f);
}

static void read_looks(const struct rf_light_grid *grid, const struct rf_grid_place *place,
                       struct means *means, int i)
{
    const float clipped = rf_grid_at(grid, RF_GRID_CLIPPED, place) + 0.02f;

    means->grey[i] = rf_grid_at(grid, RF_GRID_GREY, place) / clipped;
    means->saturation[i] = saturation(grid, place);
    means->plateau[i] = rf_grid_at(grid, RF_GRID_PLATEAU, place) / clipped;
    means->white[i] = rf_grid_at(grid, RF_GRID_WHITE, place) / clipped;
}

/* Fits light to the glare around clipped pixels by least squares. */
static void read_glare(const struct rf_light_grid *grid, const struct rf_grid_place *place,
                       struct means *means, int i)
{
    const double weight = (double)rf_grid_at(grid, RF_GRID_DARK, place) + 1e-9;
    const double light = (double)rf_grid_at(grid, RF_GRID_LIGHT, place) / weight;
    const double glare = (double)rf_grid_at(grid, RF_GRID_GLARE, place) / weight;
    const double of_light =
        (double)rf_grid_at(grid, RF_GRID_LIGHT_SQUARED, place) / weight - light * light;
    const double of_glare =
        (double)rf_grid_at(grid, RF_GRID_GLARE_SQUARED, place) / weight - glare * glare;
    const double both =
        (double)rf_grid_at(grid, RF_GRID_GLARE_LIGHT, place) / weight - light * glare;

    means->glare[i] = rf_log2f((float)fmax(both / (fmax(of_glare, 0) + 1e-5), 1e-4));
    means->explained[i] =
        (float)(both * fabs(both) / ((fmax(of_glare, 0) + 1e-9) * (fmax(of_light, 0) + 1e-9)));
}

static void read_means(const struct rf_light_grid *grid, const struct rf_grid_row *row,
                       const int *x, int count, struct means *means)
{
    for (int i = 0; i < count; i++) {
        means->photo[i] = (float)grid->mean_log;
        means->around[i] = -9;
        for (int k = 0; k < RF_GRID_SCALES; k++) {
            const struct rf_grid_place place = rf_grid_place_in(&row[k], x[i]);

            means->clipped[k][i] = rf_grid_at(grid, RF_GRID_CLIPPED, &place);
            if (k >= 1)
                means->unclipped[k][i] = rf_unclipped_at(grid, RF_GRID_UNCLIPPED, &place);
            if (k == 1)
                read_looks(grid, &place, means, i);
            if (k == 3)
                read_glare(grid, &place, means, i);
            if (k >= 5)
                means->around[i] += 0.5f * rf_grid_at(grid, RF_GRID_LOG, &place);
        }
        means->unclipped[0][i] = means->unclipped[1][i]; /* Scale 0 has no such mean. */
    }
}

/* How bright the skirt around the cells is at a scale, by how much of it is clipped. */
static void skirts(const struct means *means, int scale, int count, float *value)
{
    const float *const c = means->clipped[scale];

    for (int i = 0; i < count; i++) {
        const float skirt = means->unclipped[scale][i] - means->unclipped[scale + 2][i];

        value[i] = (skirt > 0 ? skirt : 0) * (1 - c[i]) / (c[i] + 0.004f);
    }
}

static void logs(const float *value, float offset, int count, float *log)
{
    for (int i = 0; i < count; i++)
        log[i] = rf_log2f(value[i] + offset);
}

/* Returns the values of a feature of the cells; `room` may hold them. */
static const float *values_of(const struct feature *feature, const struct means *means, int count,
                              float room[BLOCK])
{
    switch (feature->kind) {
    case CLIPPED:
        logs(means->clipped[feature->scale], 0.004f, count, room);
        return room;
    case UNCLIPPED:
        logs(means->unclipped[feature->scale], 0.01f, count, room);
        return room;
    case SKIRT:
        skirts(means, feature->scale, count, room);
        logs(room, 0.03f, count, room);
        return room;
    case PHOTO:
        return means->photo;
    case AROUND:
        return means->around;
    case GREY:
        return means->grey;
    case SATURATION:
        return means->saturation;
    case PLATEAU:
        return means->plateau;
    case WHITE:
        break;
    }
    return means->white;
}

static void add_features(const struct means *means, int count, float sum[BLOCK])
{
    float room[BLOCK];

    for (int i = 0; i < count; i++)
        sum[i] = constant;
    for (size_t f = 0; f < sizeof model / sizeof *model; f++) {
        const float *const value = values_of(&model[f], means, count, room);
        const float weight = model[f].weight, mean = model[f].mean;
        const float each = 1 / model[f].deviation;

        for (int i = 0; i < count; i++) {
            const float v = (value[i] - mean) * each;

            sum[i] += weight * (v < -3 ? -3 : v > 3 ? 3 : v);
        }
    }
}

static double softplus(double z)
{
    return fmax(z, 0) + rf_log2(1 + rf_exp_minus(fabs(z))) * 0.69314718055994531;
}

/* How much of an estimate of so many stops is taken, 0 to 1: by day it begins at 1 stop and is all
 * from 1.8 on, by night at 0.5 and from 1 on. */
static double part_of(double stops, double night)
{
    return smoothstep((float)stops, 1 - 0.5 * night, 1.8 - 0.8 * night);
}

/* Returns what a cell has lost, which is `lost` by the model. `dark`: how dark its surroundings
 * are, 0 to 1. */
static double with_glare(const struct means *means, int i, double lost, double dark)
{
    const double by_night = 1 - smoothstep(means->photo[i], -4, -3);
    const double alone =
        1 - smoothstep(means->clipped[5][i] / (means->clipped[2][i] + 0.004f), 0.35, 0.55);
    const double own = rf_log2(1 + lost);
    const double glare = fmin((double)means->glare[i] + GLARE_STOPS, MOST_GLARE_STOPS);
    const double agrees =
        fmax(smoothstep((float)own, 0, 0.5), smoothstep(means->explained[i], 0.2, 0.4));

    return rf_exp2(own + agrees * dark * by_night * alone * fmax(glare - own, 0)) - 1;
}

/* Returns how much light a cell has lost, as times its own, whose features add up to z. For a fixed
 * gain that is RF_MOST_GAIN - 1 wherever the model has 1.5 stops and more, day or night, and a part
 * of it from 0.5 on. */
static double lost_of(const struct means *means, int i, float z, bool fixed)
{
    const double large = smoothstep(means->clipped[3][i], 0.6, (double)ALL_LARGE);
    const double dark = within((0.30 - (double)means->unclipped[4][i]) / 0.24, 0, 1);
    const double night = dark * dark;
    /* This is 1 where what is clipped is a speck on something bright. */
    const double speck = smoothstep(means->unclipped[2][i], 0.2, 0.45) *
                         (1 - smoothstep(means->clipped[2][i], 0.1, 0.4));
    double stops = softplus(4 * (double)z) / 4, part;

    if (fixed)
        return (RF_MOST_GAIN - 1) * smoothstep((float)stops, 0.5, 1.5) * (1 - large);
    part = part_of(stops, night) * (1 - large) * (1 - (1 - night) * speck);
    stops = fmin(fmin(stops, DAY_STOPS + (NIGHT_STOPS - DAY_STOPS) * night), MOST_STOPS);
    return with_glare(means, i, (rf_exp2(stops) - 1) * part, night * (1 - large));
}

static void estimate_block(const struct rf_light_grid *grid, const struct rf_grid_row *row,
                           const int *x, int count, bool fixed, float *lost)
{
    struct means means;
    float sum[BLOCK];

    read_means(grid, row, x, count, &means);
    add_features(&means, count, sum);
    for (int i = 0; i < count; i++)
        lost[x[i]] = (float)lost_of(&means, i, sum[i], fixed);
}

void rf_estimate_cells(const struct rf_light_grid *grid, int y, bool fixed, float *lost)
{
    const float *const clipped = grid->plane[RF_GRID_CLIPPED].scale[0] + (ptrdiff_t)y * grid->width;
    struct rf_grid_row row[RF_GRID_SCALES];
    int x[BLOCK], count = 0;

    for (int k = 0; k < RF_GRID_SCALES; k++)
        row[k] = rf_grid_row(grid, k, y);
    for (int cx = 0; cx < grid->width; cx++) {
        const struct rf_grid_place around = rf_grid_place_in(&row[3], cx);

        lost[cx] = clipped[cx] >= LEAST_CLIPPED ? 0 : -1;
        if (lost[cx] == 0 && rf_grid_at(grid, RF_GRID_CLIPPED, &around) < ALL_LARGE)
            x[count++] = cx;
        if (count == BLOCK || cx == grid->width - 1) {
            estimate_block(grid, row, x, count, fixed, lost);
            count = 0;
        }
    }
}
