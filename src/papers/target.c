/* target.c: makes the blurred pictures of the NVIDIA white paper, by means of blocks and a filter.
 */
#include "papers/target.h"
#include "support/compare.h"

#include <assert.h>
#include <string.h>

/* Makes the taps of a filter with this variance: three boxes of 2 h + 1 values and the share a of
 * one more at each side have three times the variance of one box. */
static void make_taps(struct rf_target_work *work, double variance)
{
    double kernel[2 * RF_TARGET_TAPS + 1] = {0}, a;
    int h = 0, reach = 0;

    variance = variance > 0 ? variance / 3 : 0;
    while ((h + 1) * (h + 2) / 3.0 <= variance)
        h++;
    a = (2 * h + 1) * (variance - h * (h + 1) / 3.0) / (2 * ((h + 1.0) * (h + 1.0) - variance));
    kernel[RF_TARGET_TAPS] = 1;
    for (int box = 0; box < 3; box++) {
        double next[2 * RF_TARGET_TAPS + 1] = {0};

        for (int i = RF_TARGET_TAPS - reach; i <= RF_TARGET_TAPS + reach; i++)
            for (int j = -h - 1; j <= h + 1; j++)
                next[i + j] += kernel[i] * (j < -h || j > h ? a : 1) / (2 * h + 1 + 2 * a);
        memcpy(kernel, next, sizeof kernel);
        reach += h + 1;
    }
    work->taps = reach;
    for (int i = 0; i <= reach; i++)
        work->tap[i] = (float)kernel[RF_TARGET_TAPS + i];
}

/* Sets size and filter for a blur radius. A disc of radius r has the variance r^2 / 4 along an
 * axis, of which means of blocks make (side^2 - 1) / 12 and enlarging them by straight lines side^2
 * / 6. */
static void shape(struct rf_target_work *work, struct rf_target *target, double radius)
{
    double variance = radius * radius / 4;
    int side = 1;

    target->shift = 0;
    while (target->shift < RF_TARGET_SHIFTS && radius >= (side > 1 ? 4 * side : 2.5)) {
        target->shift++;
        side *= 2;
    }
    target->width = (work->f->view->width + side - 1) / side;
    target->height = (work->f->view->height + side - 1) / side;
    if (side > 1)
        variance -= (side * side - 1) / 12.0 + side * side / 6.0;
    make_taps(work, variance / (side * side));
}

static void add_row(uint32_t *restrict sum, const uint16_t *restrict row, int n)
{
    for (int x = 0; x < n; x++)
        sum[x] += row[x];
}

/* Computes means of blocks of side x side pixels of the picture, whose border is extended. */
static_assert((1 << 2 * RF_TARGET_SHIFTS) * RF_LIGHT_MAX < 1 << 24, "a float holds the sum");
static void reduce(const struct rf_target_work *work, int c, int y, uint32_t *sum, float *out)
{
    const struct rf_target *t = work->target;
    const int side = 1 << t->shift, whole = t->width * side;
    const float share = 1.0f / (float)(side * side);

    memset(sum, 0, (size_t)whole * sizeof *sum);
    for (int j = 0; j < side; j++)
        add_row(sum,
                work->f->light.channel[c] +
                    rf_clamp(y * side + j, 0, work->f->view->height - 1) * work->f->view->stride,
                work->f->view->width);
    for (int x = work->f->view->width; x < whole; x++)
        sum[x] = sum[work->f->view->width - 1];
    for (int x = 0; x < t->width; x++) {
        uint32_t block = 0;

        for (int i = 0; i < side; i++)
            block += sum[x * side + i];
        out[x] = (float)block * share;
    }
}

/* Computes such means of light times the weights of eq. 5, and of the weights. */
static void reduce_weighted(const struct rf_target_work *work, int y,
                            float *const out[RF_TARGET_CHANNELS])
{
    const struct rf_target *t = work->target;
    const int side = 1 << t->shift;
    const float share = 1.0f / (float)(side * side);

    for (int x = 0; x < t->width; x++) {
        double sum[RF_TARGET_CHANNELS] = {0, 0, 0, 0};

        for (int i = 0; i < side * side; i++) {
            const ptrdiff_t at = rf_clamp(y * side + i / side, 0, work->f->view->height - 1) *
                                     work->f->view->stride +
                                 rf_clamp(x * side + i % side, 0, work->f->view->width - 1);
            const double w = rf_weight_of(work->f, at);

            sum[3] += w;
            for (int c = 0; c < 3; c++)
                sum[c] += w * work->f->light.channel[c][at];
        }
        for (int c = 0; c < RF_TARGET_CHANNELS; c++)
            out[c][x] = (float)sum[c] * share;
    }
}

/* One pair of taps: nothing changes where all is the same. */
static void add_tap(float *restrict out, const float *restrict middle, const float *restrict before,
                    const float *restrict after, float tap, int n)
{
    for (int x = 0; x < n; x++)
        out[x] += tap * ((before[x] + after[x]) - 2 * middle[x]);
}

static void across_row(void *context, int y, int worker)
{
    const struct rf_target_work *work = context;
    const int n = work->target->width, channels = work->f->weighted ? RF_TARGET_CHANNELS : 3;
    const size_t length = (size_t)work->row_length;
    float *scratch = rf_target_scratch(work, worker);
    float *row[RF_TARGET_CHANNELS];

    for (int c = 0; c < RF_TARGET_CHANNELS; c++)
        row[c] = scratch + (size_t)(c + 1) * length + RF_TARGET_TAPS;
    if (work->f->weighted)
        reduce_weighted(work, y, row);
    for (int c = 0; c < channels; c++) {
        float *out = work->across[c] + (size_t)y * (size_t)n;

        if (!work->f->weighted)
            reduce(work, c, y, (uint32_t *)(void *)scratch, row[c]);
        for (int i = 1; i <= RF_TARGET_TAPS; i++) {
            row[c][-i] = row[c][0];
            row[c][n - 1 + i] = row[c][n - 1];
        }
        memcpy(out, row[c], (size_t)n * sizeof *out);
        for (int k = 1; k <= work->taps; k++)
            add_tap(out, row[c], row[c] - k, row[c] + k, work->tap[k], n);
    }
}

static void down_row(void *context, int y, int worker)
{
    const struct rf_target_work *work = context;
    const struct rf_target *t = work->target;
    const int n = t->width, channels = work->f->weighted ? RF_TARGET_CHANNELS : 3;
    const size_t length = (size_t)work->row_length, width = (size_t)n;
    float *scratch = rf_target_scratch(work, worker), *weight = scratch + 3 * length;

    for (int c = channels - 1; c >= 0; c--) {
        const float *plane = work->across[c], *middle = plane + (size_t)y * width;
        float *sum = scratch + (size_t)c * length;

        memcpy(sum, middle, width * sizeof *sum);
        for (int k = 1; k <= work->taps; k++)
            add_tap(sum, middle, plane + (size_t)rf_clamp(y - k, 0, t->height - 1) * width,
                    plane + (size_t)rf_clamp(y + k, 0, t->height - 1) * width, work->tap[k], n);
        for (int x = 0; x < n && c < 3; x++)
            t->light[c][(size_t)y * width + (size_t)x] =
                (int16_t)(4 * (work->f->weighted ? sum[x] / weight[x] : sum[x]) + 0.5f);
    }
}

void rf_target_make(struct rf_target_work *work, struct rf_target *target, double radius)
{
    struct rf_pool *pool = work->f->exec->pool;

    shape(work, target, radius < REFOCUS_PLAIN_BLUR_RADIUS ? radius : REFOCUS_PLAIN_BLUR_RADIUS);
    work->target = target;
    rf_pool_run(pool, across_row, work, target->height);
    rf_pool_run(pool, down_row, work, target->height);
}
