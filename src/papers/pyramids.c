/* pyramids.c: what lies outside of the centre of attention is read from two Gaussian pyramids. */
#include "papers/pyramids.h"
#include "support/compare.h"

#include <math.h>

enum { CHANNELS = RF_PYRAMID_CHANNELS, LEVELS = RF_PYRAMID_LEVELS };

/* Sample x of level i is at x 2^i of the picture, and the last one of each level where the picture
 * ends, or beyond: 97 and 96 pixels have 49 samples in level 1, 25 in level 2. */
static int half_of(int length)
{
    return length / 2 + 1;
}

static void size_levels(struct rf_pyramids *work, int width, int height)
{
    for (work->levels = 0; work->levels < LEVELS; work->levels++) {
        for (int side = 0; side < 2; side++) {
            work->pyramid[side][work->levels].width = width;
            work->pyramid[side][work->levels].height = height;
        }
        width = half_of(width);
        height = half_of(height);
    }
}

void rf_pyramids_lay_out(struct rf_pyramids *work, const struct rf_limits *limits,
                         struct rf_arena *arena)
{
    size_levels(work, limits->width, limits->height);
    for (int side = 0; side < 2; side++)
        for (int i = 0; i < LEVELS; i++)
            for (int c = 0; c < CHANNELS; c++) {
                struct rf_pyramid_level *level = &work->pyramid[side][i];

                level->plane[c] = rf_arena_take(
                    arena, (uint64_t)level->width * (uint64_t)level->height, sizeof(float));
            }
    for (int c = 0; c < CHANNELS; c++)
        work->half[c] = rf_arena_take(
            arena, (uint64_t)half_of(limits->width) * (uint64_t)limits->height, sizeof(float));
}

/* Writes a row of level 0: pixels before the focus in one pyramid, pixels behind it in the other.
 */
static void first_level_row(void *context, int y, int worker)
{
    const struct rf_pyramids *work = context;

    (void)worker;
    for (int x = 0; x < work->f->view->width; x++) {
        const ptrdiff_t p = y * work->f->view->stride + x;
        const size_t at = (size_t)y * (size_t)work->f->view->width + (size_t)x;
        const double w = rf_weight_of(work->f, p);

        for (int side = 0; side < 2; side++) {
            const struct rf_pyramid_level *level = &work->pyramid[side][0];
            const int s = side ? work->f->blur.at[p] : -work->f->blur.at[p];
            const float present = s >= 128;

            for (int c = 0; c < 3; c++)
                level->plane[c][at] = present * (float)(w * work->f->light.channel[c][p]);
            level->plane[3][at] = present * (float)w;
            level->plane[4][at] = present;
            level->plane[5][at] = present * (float)s;
        }
    }
}

/* Filters by (1 4 6 4 1) / 16 about in[2 x], ends extended; neighbours are `step` apart. */
static float reduce(const float *in, int x, int n, size_t step)
{
    const float *at[5];

    for (int i = 0; i < 5; i++)
        at[i] = in + (size_t)rf_clamp(2 * x + i - 2, 0, n - 1) * step;
    return (*at[0] + *at[4] + 4 * (*at[1] + *at[3]) + 6 * *at[2]) / 16;
}

static void halve_x_row(void *context, int y, int worker)
{
    const struct rf_pyramids *work = context;
    const struct rf_pyramid_level *from = work->from, *to = work->to;

    (void)worker;
    for (int c = 0; c < CHANNELS; c++)
        for (int x = 0; x < to->width; x++)
            work->half[c][(size_t)y * (size_t)to->width + (size_t)x] =
                reduce(from->plane[c] + (size_t)y * (size_t)from->width, x, from->width, 1);
}

static void halve_y_row(void *context, int y, int worker)
{
    const struct rf_pyramids *work = context;
    const struct rf_pyramid_level *from = work->from, *to = work->to;
    const size_t width = (size_t)to->width;

    (void)worker;
    for (int c = 0; c < CHANNELS; c++)
        for (size_t x = 0; x < width; x++)
            to->plane[c][(size_t)y * width + x] = reduce(work->half[c] + x, y, from->height, width);
}

/* The variance along one axis of a pixel as level i shows it: (4^i - 1) / 3 by the filters, and a
 * sixth of the square of the level's own pixel by the interpolation. A disc of radius r has
 * r^2 / 4. */
static double level_variance(int i)
{
    const double four = (double)(1 << 2 * i);

    return i ? (four - 1) / 3 + four / 6 : 0;
}

/* The level, and the part of the next one, that show a pixel as wide as a disc of blur s. */
static int level_of(const struct rf_pyramids *work, double s, double *part)
{
    const double variance = s / 256.0 * (s / 256.0) / 4;
    int i = 0;

    while (i + 2 < work->levels && level_variance(i + 1) <= variance)
        i++;
    *part = (variance - level_variance(i)) / (level_variance(i + 1) - level_variance(i));
    *part = *part > 1 ? 1 : *part;
    return i;
}

/* The level that is at least as wide as the largest blur of a side. */
static int widest_level(const struct rf_pyramids *work, int s)
{
    double part;

    return level_of(work, s, &part) + 1;
}

void rf_pyramids_make(struct rf_pyramids *work, struct rf_frame *f)
{
    struct rf_pool *pool = f->exec->pool;

    work->f = f;
    size_levels(work, f->view->width, f->view->height);
    work->widest[0] = widest_level(work, rf_nearest_blur(f));
    work->widest[1] = widest_level(work, rf_farthest_blur(f));
    rf_pool_run(pool, first_level_row, work, work->f->view->height);
    for (int side = 0; side < 2; side++) {
        for (int i = 0; i + 1 < work->levels; i++) {
            work->from = &work->pyramid[side][i];
            work->to = &work->pyramid[side][i + 1];
            rf_pool_run(pool, halve_x_row, work, work->from->height);
            rf_pool_run(pool, halve_y_row, work, work->to->height);
        }
    }
}

static void sample(const struct rf_pyramid_level *level, int i, int x, int y, double share,
                   double out[CHANNELS])
{
    const int side = 1 << i, ix = x >> i, iy = y >> i;
    const double ax = (double)(x & (side - 1)) / side, ay = (double)(y & (side - 1)) / side;

    for (int dy = 0; dy < 2; dy++) {
        for (int dx = 0; dx < 2; dx++) {
            const size_t at =
                (size_t)rf_clamp(iy + dy, 0, level->height - 1) * (size_t)level->width +
                (size_t)rf_clamp(ix + dx, 0, level->width - 1);
            const double w = share * (dx ? ax : 1 - ax) * (dy ? ay : 1 - ay);

            for (int c = 0; c < CHANNELS; c++)
                out[c] += w * level->plane[c][at];
        }
    }
}

/* The blur of the pixels of a side that reach (x, y), 1/256 pixel: that of p itself if it is one of
 * them, else the mean of those that a level sees which is as wide as that mean; 0 where there are
 * none. The search begins at the level as wide as the side's largest blur and narrows, lest the
 * large blur of what is far away be taken for that of what is near. */
static double blur_of_side(const struct rf_pyramids *work, int side, int x, int y, int s)
{
    int level = work->widest[side], last;
    double mean, part;

    if ((s >= 128 || s <= -128) && (s > 0) == side)
        return s < 0 ? -s : s;
    do {
        double sum[CHANNELS] = {0};

        sample(&work->pyramid[side][level], level, x, y, 1, sum);
        mean = sum[4] > 0 ? fabs(sum[5] / sum[4]) : 0;
        last = level;
        level = level_of(work, mean, &part) + 1;
    } while (mean >= 128 && level < last);
    return mean;
}

/* Sums a side's pyramid at (x, y), as wide as the side's blur there. */
static void sample_side(const struct rf_pyramids *work, int side, int x, int y, int s,
                        double sum[CHANNELS])
{
    const double blur = blur_of_side(work, side, x, y, s);
    double part;
    int i;

    if (blur < 128)
        return;
    i = level_of(work, blur, &part);
    sample(&work->pyramid[side][i], i, x, y, 1 - part, sum);
    sample(&work->pyramid[side][i + 1], i + 1, x, y, part, sum);
}

void rf_pyramids_show(const struct rf_pyramids *work, int x, int y, double light[3])
{
    const struct rf_frame *f = work->f;
    const ptrdiff_t p = y * f->view->stride + x;
    const int s = f->blur.at[p];
    const double w = rf_weight_of(f, p);
    double front[CHANNELS] = {0}, back[CHANNELS] = {0}, rest, part;

    sample_side(work, 0, x, y, s, front);
    if (s >= 128 || s <= -128)
        sample_side(work, 1, x, y, s, back);
    rest = front[4] < 1 ? 1 - front[4] : 0;
    if (back[4] > 0) {
        part = rest / back[4];
        for (int c = 0; c < 3; c++)
            light[c] = (front[c] + part * back[c]) / (front[3] + part * back[3]);
        return;
    }
    if (s <= -128)
        rest = 0;
    for (int c = 0; c < 3; c++)
        light[c] = (front[c] + rest * w * f->light.channel[c][p]) / (front[3] + rest * w);
}
