/* smooth.c: smooths a disparity map up to its edges. */
#include "depth/smooth.h"

#include "support/compare.h"

enum { ROWS = 16 }; /* a work item of a thread */

/* One pass, from a plane to another. */
struct step {
    const struct rf_smoother *s;
    struct rf_disparity_q16 in, out;
    struct rf_smooth_pass pass;
};

/* n pixels of a row from x on, n at most the distance of the neighbours, some of which lie beyond
 * the sides: there the last pixel is repeated. */
static void smooth_side(const struct step *step, uint16_t *out, const uint16_t *const row[3], int x,
                        int n)
{
    const struct rf_smoother *s = step->s;
    const int apart = step->pass.apart;
    uint16_t near_by[3][3 * RF_SMOOTH_APART];
    const uint16_t *from[3];

    for (int j = 0; j < 3; j++) {
        for (int i = 0; i < n + 2 * apart; i++) {
            const int at = rf_larger(x - apart + i, 0);

            near_by[j][i] = row[j][rf_smaller(at, s->width - 1)];
        }
        from[j] = near_by[j] + apart;
    }
    s->kernels->smooth_codes(out + x, from, apart, step->pass.alike, n);
}

static void smooth_row(const struct step *step, int y)
{
    const struct rf_smoother *s = step->s;
    const int apart = step->pass.apart;
    const int left = rf_smaller(apart, s->width);
    const int right = rf_larger(s->width - apart, left);
    uint16_t *out = step->out.at + y * step->out.stride;
    const uint16_t *row[3], *middle[3];

    for (int j = 0; j < 3; j++) {
        const int v = rf_larger(y + (j - 1) * apart, 0);

        row[j] = step->in.at + rf_smaller(v, s->height - 1) * step->in.stride;
        middle[j] = row[j] + left;
    }
    smooth_side(step, out, row, 0, left);
    s->kernels->smooth_codes(out + left, middle, apart, step->pass.alike, right - left);
    smooth_side(step, out, row, right, s->width - right);
}

static void smooth_band(void *context, int band, int worker)
{
    const struct step *step = context;
    const int end = rf_smaller((band + 1) * ROWS, step->s->height);

    (void)worker;
    for (int y = band * ROWS; y < end; y++)
        smooth_row(step, y);
}

static void clamp_band(void *context, int band, int worker)
{
    const struct step *step = context;
    const struct rf_smoother *s = step->s;
    const int end = rf_smaller((band + 1) * ROWS, s->height);

    (void)worker;
    for (int y = band * ROWS; y < end; y++)
        s->kernels->clamp_codes(s->code.at + y * s->code.stride, step->in.at + y * step->in.stride,
                                s->most_moved, s->width);
}

static void run_bands(struct rf_pool *pool, rf_work_fn *work, struct step *step)
{
    const int bands = (step->s->height + ROWS - 1) / ROWS;

    if (pool)
        rf_pool_run(pool, work, step, bands);
    for (int band = 0; !pool && band < bands; band++)
        work(step, band, 0);
}

void rf_smooth(const struct rf_smoother *s, struct rf_pool *pool)
{
    struct step step = {.s = s, .in = s->code};

    for (int i = 0; i < s->passes; i++) {
        step.out = s->spare[i % 2];
        step.pass = s->pass[i];
        run_bands(pool, smooth_band, &step);
        step.in = step.out;
    }
    run_bands(pool, clamp_band, &step);
}
