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
 */
#include <math.h>

#include "highlights/estimate.h"
#include "support/compare.h"
#include "support/log2.h"

enum { FEATURES = 25, BLOCK = 32 /* cells at once, side by side for vectors */ };
#define MOST_STOPS    4.0 /* a gain of 16 */
#define DAY_STOPS     0.75
#define NIGHT_STOPS   5.5
#define LEAST_CLIPPED 0.005f /* the least part of a cell that is clipped, for an estimate */
#define ALL_LARGE     0.9f   /* where this part of what is around is clipped, nothing is added */

static const struct {
    float weight, mean, deviation;
} model[FEATURES] = {
    /* C_0 to C_6 */
    {0.0975f, -0.2951f, 0.5592f},
    {0.1847f, -0.4261f, 0.6497f},
    {0.0669f, -0.6625f, 0.8433f},
    {0.0423f, -1.0266f, 1.1324f},
    {-0.1096f, -1.4976f, 1.4065f},
    {-0.0082f, -2.1055f, 1.6137f},
    {-0.2105f, -2.8504f, 1.7129f},
    /* U_0 to U_6 */
    {-0.0247f, -2.3545f, 2.6701f},
    {0.0242f, -1.9531f, 2.3142f},
    {-0.1842f, -1.6687f, 1.8699f},
    {0.0053f, -1.5735f, 1.4688f},
    {-0.0041f, -1.6212f, 1.1544f},
    {0.1224f, -1.8089f, 1.0033f},
    {-0.5093f, -2.0958f, 0.9478f},
    /* X_0 to X_4 */
    {-0.1575f, -4.3748f, 1.0592f},
    {0.0344f, -4.0105f, 1.2694f},
    {0.283f, -3.5996f, 1.4463f},
    {0.0782f, -3.1214f, 1.599f},
    {0.0055f, -2.6245f, 1.7546f},
    /* mean log2 of luminance: of the photo, of what is around */
    {-0.2155f, -3.1844f, 1.1148f},
    {0.5419f, -2.0037f, 1.2966f},
    /* looks of the clipped pixels: least channel to greatest; saturation of the skirt; parts of
     * them whose greatest channel, and whose least one, are at the end of the scale */
    {0.7777f, 0.817f, 0.2175f},
    {0.9995f, 0.193f, 0.2286f},
    {-0.0432f, 0.7986f, 0.2547f},
    {0.3535f, 0.4209f, 0.398f},
};
static const float constant = 0.4431f;

/* Means of the grid at the middles of the cells. */
struct means {
    float clipped[RF_GRID_SCALES][BLOCK], unclipped[RF_GRID_SCALES][BLOCK];
    float log[BLOCK];
    float grey[BLOCK], saturation[BLOCK], plateau[BLOCK], white[BLOCK];
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

static void read_means(const struct rf_light_grid *grid, const struct rf_grid_row *row,
                       const int *x, int count, struct means *means)
{
    for (int i = 0; i < count; i++) {
        means->log[i] = -9;
        for (int k = 0; k < RF_GRID_SCALES; k++) {
            const struct rf_grid_place place = rf_grid_place_in(&row[k], x[i]);

            means->clipped[k][i] = rf_grid_at(grid, RF_GRID_CLIPPED, &place);
            if (k >= 1)
                means->unclipped[k][i] = rf_unclipped_at(grid, RF_GRID_UNCLIPPED, &place);
            if (k == 1)
                read_looks(grid, &place, means, i);
            if (k >= 5)
                means->log[i] += 0.5f * rf_grid_at(grid, RF_GRID_LOG, &place);
        }
        means->unclipped[0][i] = means->unclipped[1][i]; /* Scale 0 has no such mean. */
    }
}

/* Adds a feature of the cells to their sums. */
static void add_feature(int feature, const float *value, int count, float sum[BLOCK])
{
    const float weight = model[feature].weight, mean = model[feature].mean;
    const float each = 1 / model[feature].deviation;

    for (int i = 0; i < count; i++) {
        const float v = (value[i] - mean) * each;

        sum[i] += weight * (v < -3 ? -3 : v > 3 ? 3 : v);
    }
}

static void add_log(int feature, const float *value, float offset, int count, float sum[BLOCK])
{
    float log[BLOCK];

    for (int i = 0; i < count; i++)
        log[i] = rf_log2f(value[i] + offset);
    add_feature(feature, log, count, sum);
}

static void add_features(const struct means *means, double mean_log, int count, float sum[BLOCK])
{
    float v[BLOCK];

    for (int i = 0; i < count; i++) {
        sum[i] = constant;
        v[i] = (float)mean_log;
    }
    for (int k = 0; k < RF_GRID_SCALES; k++) {
        add_log(k, means->clipped[k], 0.004f, count, sum);
        add_log(7 + k, means->unclipped[k], 0.01f, count, sum);
    }
    add_feature(19, v, count, sum);
    for (int k = 0; k < 5; k++) {
        const float *const c = means->clipped[k];

        for (int i = 0; i < count; i++) {
            const float skirt = means->unclipped[k][i] - means->unclipped[k + 2][i];

            v[i] = (skirt > 0 ? skirt : 0) * (1 - c[i]) / (c[i] + 0.004f);
        }
        add_log(14 + k, v, 0.03f, count, sum);
    }
    add_feature(20, means->log, count, sum);
    add_feature(21, means->grey, count, sum);
    add_feature(22, means->saturation, count, sum);
    add_feature(23, means->plateau, count, sum);
    add_feature(24, means->white, count, sum);
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
    return (rf_exp2(stops) - 1) * part;
}

static void estimate_block(const struct rf_light_grid *grid, const struct rf_grid_row *row,
                           const int *x, int count, bool fixed, float *lost)
{
    struct means means;
    float sum[BLOCK];

    read_means(grid, row, x, count, &means);
    add_features(&means, grid->mean_log, count, sum);
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
