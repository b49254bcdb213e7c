/* diffusion_solver.c: heat flow by steps, and by a series that takes far fewer.
 *
 * With D = diag(W), a step's A = I + L has (W(p)) (L C)(p) = 1/4 sum of W(p) W(q) (C(q) - C(p)),
 * which is symmetric: the eigenvalues of A are real and, by Gershgorin, in [1 - 2 W, 1].
 *
 * The series is summed by Clenshaw's recursion B_k = c_k C + 2 t B_(k+1) - B_(k+2), with
 * t = 1 + L / W. It works on V = C W(p) / 2 W: then
 *
 *     2 t V(p) = across(p) sum of V(q) + own(p) V(p),
 *     across = W(p) / 2 W, own = 2 - sum of across(q),
 *
 * which takes two products where C takes five. Where nothing flows `across` is not 0 but
 * RF_ACROSS_LEAST, so that V can be turned back into C.
 */
#include "papers/diffusion.h"

#include <math.h>

/* LIFT is added to C while it flows, and subtracted again: so no sum comes near the denormal
 * numbers, with which processors are slow. */
static const float LIFT = 1 / 1024.0f;

/* The sum over the neighbours of W(q) (C(q) - C(p)): nothing flows where all values are alike. */
#define FLOW(c, w, x, stride)                                                                      \
    ((w)[(x)-1] * ((c)[(x)-1] - (c)[x]) + (w)[(x) + 1] * ((c)[(x) + 1] - (c)[x]) +                 \
     (w)[(x) - (stride)] * ((c)[(x) - (stride)] - (c)[x]) +                                        \
     (w)[(x) + (stride)] * ((c)[(x) + (stride)] - (c)[x]))

void rf_diffuse_steps(const struct rf_frame *f, const struct rf_box *box, const float *weight,
                      float *plane, float *scratch, int steps)
{
    float *from = plane, *to = scratch;

    for (int i = 0; i < steps + steps % 2 && !rf_cancelled(f->exec); i++) {
        for (int y = box->y0; y < box->y1; y++) {
            const float *c = from + y * box->stride, *w = weight + y * box->stride;
            float *restrict out = to + y * box->stride;

            if (rf_cancelled(f->exec))
                return;
            if (i == steps) { /* an odd number: one more to copy back */
                for (int x = box->x0; x < box->x1; x++)
                    out[x] = c[x];
                continue;
            }
            for (int x = box->x0; x < box->x1; x++)
                out[x] = c[x] + 0.25f * FLOW(c, w, x, box->stride);
        }
        from = to;
        to = from == plane ? scratch : plane;
    }
}

static double power(double x, int n)
{
    double result = 1;

    for (; n > 0; n /= 2) {
        if (n % 2)
            result *= x;
        x *= x;
    }
    return result;
}

void rf_series_make(struct rf_series *series, int steps, double largest_weight)
{
    double coefficient[RF_SERIES_MOST] = {0}, tail = 0, sum = 0;
    const double reach = 64 + 8 * sqrt(steps * largest_weight); /* beyond: below rounding */
    const int most = reach < RF_SERIES_MOST ? (int)reach : RF_SERIES_MOST, points = 2 * most;

    /* This is the cosine transform of the function at Chebyshev's points. */
    for (int j = 0; j < points; j++) {
        double sine, t, before = 1, here;
        const double scale = 2.0 / points;

        rf_sincos_turns((j + 0.5) / (2 * points), &sine, &t);
        const double value = scale * power(1 - largest_weight + largest_weight * t, steps);
        here = t;
        coefficient[0] += value / 2;
        for (int k = 1; k < most; k++) {
            const double next = 2 * t * here - before;

            coefficient[k] += value * here;
            before = here;
            here = next;
        }
    }
    series->terms = most;
    /* The omitted terms reach a pixel that passes nothing on as divided differences of T_k, which
     * are k^2 at the most. */
    while (series->terms > 2 && tail < 1e-3) {
        series->terms--;
        tail += fabs(coefficient[series->terms - 1]) * series->terms * series->terms;
    }
    for (int k = 0; k < series->terms; k++)
        sum += coefficient[k];
    for (int k = 0; k < series->terms; k++) /* a flat plane stays: all T_k(1) are 1 */
        series->coefficient[k] = (float)(coefficient[k] / sum);
}

/* Row y of B_k into the plane of B_(k+2); of the result, k = 0, into the layer's plane. */
static void series_row(const struct rf_heat *heat, const struct rf_series *series, float *plane,
                       float *const B[2], int k, int y)
{
    const ptrdiff_t at = y * heat->box.stride + heat->span[y].x0;
    const int n = heat->span[y].x1 - heat->span[y].x0;
    const struct rf_series_job job = {
        .here = B[(k + 1) % 2] + at,
        .start = plane + at,
        .across = heat->across + at,
        .own = heat->own + at,
        .stride = heat->box.stride,
        .share = series->coefficient[k],
    };
    float *restrict row = B[k % 2] + at, *restrict result = plane + at;

    if (k > 0) {
        heat->series_row(row, &job, n);
        return;
    }
    for (int x = 0; x < n; x++) {
        const float *here = job.here + x;
        const float around = (here[-job.stride] + here[job.stride]) + (here[-1] + here[1]);
        const float sum = 0.5f * (job.across[x] * around + job.own[x] * *here) - row[x];

        result[x] = (job.share * result[x] + sum) / job.across[x] - LIFT;
    }
}

void rf_diffuse_series(const struct rf_heat *heat, const struct rf_series *series, float *plane,
                       float *even, float *odd)
{
    enum { AT_ONCE = 16 };
    const struct rf_box *box = &heat->box;
    float *const B[2] = {even, odd};

    for (int y = box->y0; y < box->y1; y++)
        for (ptrdiff_t at = y * box->stride + heat->span[y].x0,
                       end = y * box->stride + heat->span[y].x1;
             at < end; at++)
            plane[at] = heat->across[at] * (plane[at] + LIFT);
    /* Some terms at once, each two rows behind the one before it, so that what they share is
     * still in the cache: B_k needs rows y - 1 .. y + 1 of B_(k+1), and takes the place of
     * row y of B_(k+2), which B_(k+1) needs for its rows up to y + 1. */
    for (int last = series->terms - 1; last >= 0 && !rf_cancelled(heat->f->exec); last -= AT_ONCE) {
        for (int front = box->y0; front < box->y1 + 2 * (AT_ONCE - 1); front++) {
            if (rf_cancelled(heat->f->exec))
                return;
            for (int i = 0; i < AT_ONCE && last - i >= 0; i++) {
                const int y = front - 2 * i;

                if (y >= box->y0 && y < box->y1)
                    series_row(heat, series, plane, B, last - i, y);
            }
        }
    }
}
