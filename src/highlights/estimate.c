/* estimate.c: estimates how many times as bright as white clipped pixels were.
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
#include "highlights/estimate.h"

#include <math.h>

#include "support/compare.h"
#include "support/log2.h"

enum { FEATURES = 25 };
#define MOST_STOPS    4.0 /* a gain of 16 */
#define DAY_STOPS     0.75
#define NIGHT_STOPS   5.5
#define LEAST_CLIPPED 0.005f /* the least part of a cell that is clipped, for an estimate */

static const struct {
    double weight, mean, deviation;
} model[FEATURES] = {
    /* C_0 to C_6 */
    {0.0975, -0.2951, 0.5592},
    {0.1847, -0.4261, 0.6497},
    {0.0669, -0.6625, 0.8433},
    {0.0423, -1.0266, 1.1324},
    {-0.1096, -1.4976, 1.4065},
    {-0.0082, -2.1055, 1.6137},
    {-0.2105, -2.8504, 1.7129},
    /* U_0 to U_6 */
    {-0.0247, -2.3545, 2.6701},
    {0.0242, -1.9531, 2.3142},
    {-0.1842, -1.6687, 1.8699},
    {0.0053, -1.5735, 1.4688},
    {-0.0041, -1.6212, 1.1544},
    {0.1224, -1.8089, 1.0033},
    {-0.5093, -2.0958, 0.9478},
    /* X_0 to X_4 */
    {-0.1575, -4.3748, 1.0592},
    {0.0344, -4.0105, 1.2694},
    {0.283, -3.5996, 1.4463},
    {0.0782, -3.1214, 1.599},
    {0.0055, -2.6245, 1.7546},
    /* mean log2 of luminance: of the photo, of what is around */
    {-0.2155, -3.1844, 1.1148},
    {0.5419, -2.0037, 1.2966},
    /* looks of the clipped pixels: least channel to greatest; saturation of the skirt; parts of
     * them whose greatest channel, and whose least one, are at the end of the scale */
    {0.7777, 0.817, 0.2175},
    {0.9995, 0.193, 0.2286},
    {-0.0432, 0.7986, 0.2547},
    {0.3535, 0.4209, 0.398},
};
static const double constant = 0.4431;

uint64_t rf_estimate_bytes(int max_width, int max_height)
{
    struct rf_light_grid grid = {.width = rf_smaller(max_width, RF_GRID_SIDE),
                                 .height = rf_smaller(max_height, RF_GRID_SIDE)};
    struct rf_estimate estimate = {.grid = &grid};
    struct rf_arena arena = {NULL, 0};

    rf_estimate_lay_out(&estimate, &arena);
    return rf_light_grid_bytes(max_width, max_height) + arena.used;
}

void rf_estimate_lay_out(struct rf_estimate *estimate, struct rf_arena *arena)
{
    const uint64_t cells = (uint64_t)estimate->grid->width * (uint64_t)estimate->grid->height;

    estimate->lost = rf_arena_take(arena, cells, sizeof *estimate->lost);
}

static double within(double v, double least, double most)
{
    return v < least ? least : v > most ? most : v;
}

static double smoothstep(double v, double from, double to)
{
    const double t = within((v - from) / (to - from), 0, 1);

    return t * t * (3 - 2 * t);
}

/* A mean of the grid, in double. */
static double mean_at(const struct rf_light_grid *grid, enum rf_grid_measure measure,
                      const struct rf_grid_place *place)
{
    return (double)rf_grid_at(grid, measure, place);
}

/* The mean light, by one of the measures of what is not clipped, of what is not. */
static double unclipped(const struct rf_light_grid *grid, enum rf_grid_measure measure,
                        const struct rf_grid_place *place)
{
    return mean_at(grid, measure, place) / (1 - mean_at(grid, RF_GRID_CLIPPED, place) + 0.001);
}

static double saturation(const struct rf_light_grid *grid, const struct rf_grid_place *place)
{
    const double r = mean_at(grid, RF_GRID_RED, place), g = mean_at(grid, RF_GRID_GREEN, place);
    const double b = mean_at(grid, RF_GRID_BLUE, place);
    const double most = fmax(r, fmax(g, b));

    return (most - fmin(r, fmin(g, b))) / (most + 0.01);
}

static void set_looks(const struct rf_light_grid *grid, const struct rf_grid_place *place,
                      double *feature)
{
    const double clipped = mean_at(grid, RF_GRID_CLIPPED, place) + 0.02;

    feature[0] = mean_at(grid, RF_GRID_GREY, place) / clipped;
    feature[1] = saturation(grid, place);
    feature[2] = mean_at(grid, RF_GRID_PLATEAU, place) / clipped;
    feature[3] = mean_at(grid, RF_GRID_WHITE, place) / clipped;
}

/* U_0 is taken for U_1: light that is not clipped is not measured at scale 0. */
static void set_features(const struct rf_light_grid *grid,
                         const struct rf_grid_place place[RF_GRID_SCALES], double feature[FEATURES])
{
    double c[RF_GRID_SCALES], u[RF_GRID_SCALES];

    for (int k = 0; k < RF_GRID_SCALES; k++) {
        c[k] = mean_at(grid, RF_GRID_CLIPPED, &place[k]);
        u[k] = unclipped(grid, RF_GRID_UNCLIPPED, &place[rf_larger(k, 1)]);
        feature[k] = rf_log2(c[k] + 0.004);
        feature[7 + k] = rf_log2(u[k] + 0.01);
    }
    for (int k = 0; k < 5; k++)
        feature[14 + k] = rf_log2(fmax(u[k] - u[k + 2], 0) * (1 - c[k]) / (c[k] + 0.004) + 0.03);
    feature[19] = grid->mean_log;
    feature[20] =
        0.5 * (mean_at(grid, RF_GRID_LOG, &place[5]) + mean_at(grid, RF_GRID_LOG, &place[6])) - 9;
    set_looks(grid, &place[1], feature + 21);
}

static double softplus(double z)
{
    return fmax(z, 0) + rf_log2(1 + rf_exp_minus(fabs(z))) * 0.69314718055994531;
}

/* How far what is clipped is a speck on something bright: 0 to 1. */
static double speck(const struct rf_light_grid *grid, const struct rf_grid_place *near)
{
    return smoothstep(unclipped(grid, RF_GRID_UNCLIPPED, near), 0.2, 0.45) *
           (1 - smoothstep(mean_at(grid, RF_GRID_CLIPPED, near), 0.1, 0.4));
}

/* How much of an estimate of so many stops is taken, 0 to 1: by day it begins at 1 stop and is all
 * from 1.8 on, by night at 0.5 and from 1 on. */
static double part_of(double stops, double night)
{
    return smoothstep(stops, 1 - 0.5 * night, 1.8 - 0.8 * night);
}

/* Returns how much light a cell has lost, as times its own. For a fixed gain that is RF_MOST_GAIN -
 * 1 wherever the model has 1.5 stops and more, day or night, and a part of it from 0.5 on. */
static double lost_of(const struct rf_light_grid *grid, int x, int y, bool fixed)
{
    struct rf_grid_place place[RF_GRID_SCALES];
    double feature[FEATURES], z = constant, dark, night, large, part, stops;

    for (int k = 0; k < RF_GRID_SCALES; k++)
        place[k] = rf_grid_place(grid, k, x, y);
    large = smoothstep(mean_at(grid, RF_GRID_CLIPPED, &place[3]), 0.6, 0.9);
    if (large >= 1)
        return 0;
    set_features(grid, place, feature);
    for (int i = 0; i < FEATURES; i++)
        z += model[i].weight * within((feature[i] - model[i].mean) / model[i].deviation, -3, 3);
    stops = softplus(4 * z) / 4;
    if (fixed)
        return (RF_MOST_GAIN - 1) * smoothstep(stops, 0.5, 1.5) * (1 - large);
    dark = within((0.30 - unclipped(grid, RF_GRID_UNCLIPPED, &place[4])) / 0.24, 0, 1);
    night = dark * dark;
    part = part_of(stops, night) * (1 - large) * (1 - (1 - night) * speck(grid, &place[2]));
    stops = fmin(fmin(stops, DAY_STOPS + (NIGHT_STOPS - DAY_STOPS) * night), MOST_STOPS);
    return (rf_exp2(stops) - 1) * part;
}

struct job {
    const struct rf_estimate *estimate;
    double scale;
    bool fixed; /* gain */
};

static void estimate_row(void *context, int item, int worker)
{
    const struct job *job = context;
    const struct rf_light_grid *grid = job->estimate->grid;

    (void)worker;
    for (int x = 0; x < grid->width && !rf_cancelled(grid->exec); x++) {
        const ptrdiff_t at = (ptrdiff_t)item * grid->width + x;
        const bool clipped = grid->plane[RF_GRID_CLIPPED].scale[0][at] >= LEAST_CLIPPED;

        job->estimate->lost[at] =
            clipped ? (float)(lost_of(grid, x, item, job->fixed) * job->scale) : -1;
    }
}

void rf_estimate_make(const struct rf_estimate *estimate)
{
    const bool fixed = !(estimate->scale > 0);
    struct job job = {estimate, fixed ? 1 : (double)estimate->scale, fixed};

    rf_pool_run(estimate->grid->exec->pool, estimate_row, &job, estimate->grid->height);
}

float rf_estimate_at(const struct rf_estimate *estimate, int x, int y)
{
    const struct rf_light_grid *grid = estimate->grid;
    const float u = ((float)x + 0.5f) * (float)grid->width / (float)grid->photo->width - 0.5f;
    const float v = ((float)y + 0.5f) * (float)grid->height / (float)grid->photo->height - 0.5f;
    const int x0 = u < 0 ? -1 : (int)u, y0 = v < 0 ? -1 : (int)v;
    const float right = u - (float)x0, low = v - (float)y0;
    float sum = 0, weight = 0;

    for (int j = 0; j < 2; j++)
        for (int i = 0; i < 2; i++) {
            const int cx = rf_larger(rf_smaller(x0 + i, grid->width - 1), 0);
            const int cy = rf_larger(rf_smaller(y0 + j, grid->height - 1), 0);
            const float value = estimate->lost[(ptrdiff_t)cy * grid->width + cx];
            const float own = (i ? right : 1 - right) * (j ? low : 1 - low);

            if (value >= 0) {
                sum += own * value;
                weight += own;
            }
        }
    return weight > 0 ? sum / weight : 0;
}

bool rf_skirt_hue(const struct rf_light_grid *grid, int x, int y, float hue[3])
{
    const struct rf_grid_place near = rf_grid_place(grid, 2, x, y);
    const struct rf_grid_place far = rf_grid_place(grid, 4, x, y);
    double skirt[3], luminance;

    for (int c = 0; c < 3; c++)
        skirt[c] = fmax(unclipped(grid, RF_GRID_RED + (unsigned)c, &near) -
                            unclipped(grid, RF_GRID_RED + (unsigned)c, &far),
                        0);
    luminance = (218 * skirt[0] + 732 * skirt[1] + 74 * skirt[2]) / 1024;
    if (luminance < 0.002)
        return false;
    for (int c = 0; c < 3; c++)
        hue[c] = (float)fmin(skirt[c] / luminance, 3);
    return true;
}

int rf_clipped_size(const struct rf_light_grid *grid, int x, int y)
{
    const float cell = (float)rf_larger(grid->photo->width, grid->photo->height) /
                       (float)rf_larger(grid->width, grid->height);
    int scale = 0;

    for (; scale < RF_GRID_SCALES - 1; scale++) {
        const struct rf_grid_place place = rf_grid_place(grid, scale, x, y);

        if (rf_grid_at(grid, RF_GRID_CLIPPED, &place) <= 0.5f)
            break;
    }
    return rf_smaller((int)(cell * (float)(1 << scale) + 0.5f), UINT8_MAX);
}
