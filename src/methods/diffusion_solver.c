/* diffusion_solver.c: heat flow by steps, and by a series that takes far fewer.
 *
 * With D = diag(W), a step's A = I + L has (W(p)) (L C)(p) = 1/4 sum of W(p) W(q) (C(q) - C(p)),
 * which is symmetric: the eigenvalues of A are real and, by Gershgorin, in [1 - 2 W, 1].
 */
#include "methods/diffusion.h"

#include <math.h>

/* Sum over the neighbours of W(q) (C(q) - C(p)): nothing flows where all is the same. */
#define FLOW(c, w, x, stride)                                                               \
    ((w)[(x) - 1] * ((c)[(x) - 1] - (c)[x]) + (w)[(x) + 1] * ((c)[(x) + 1] - (c)[x]) +       \
     (w)[(x) - (stride)] * ((c)[(x) - (stride)] - (c)[x]) +                                 \
     (w)[(x) + (stride)] * ((c)[(x) + (stride)] - (c)[x]))

void rf_diffuse_steps(const struct refocus_renderer *r, const struct rf_box *box,
                      const float *weight, float *plane, float *scratch, int steps)
{
    float *from = plane, *to = scratch;

    for (int i = 0; i < steps + steps % 2 && !rf_cancelled(r); i++) {
        for (int y = box->y0; y < box->y1; y++) {
            const float *c = from + y * box->stride, *w = weight + y * box->stride;
            float *restrict out = to + y * box->stride;

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

    for (; n > 0; n /= 2, x *= x)
        if (n % 2)
            result *= x;
    return result;
}

void rf_series_make(struct rf_series *series, int steps, double largest_weight)
{
    enum { POINTS = 2048 };
    double coefficient[RF_SERIES_MOST] = {0}, tail = 0, sum = 0;
    const double reach = 64 + 8 * sqrt(steps * largest_weight); /* beyond: below rounding */
    const int most = reach < RF_SERIES_MOST ? (int)reach : RF_SERIES_MOST;

    /* the cosine transform of the function at Chebyshev's points */
    for (int j = 0; j < POINTS; j++) {
        double sine, t, before = 1, here;
        const double scale = 2.0 / POINTS;

        rf_sincos_turns((j + 0.5) / (2 * POINTS), &sine, &t);
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
    while (series->terms > 2 && (tail += fabs(coefficient[series->terms - 1])) < 2e-7)
        series->terms--;
    for (int k = 0; k < series->terms; k++)
        sum += coefficient[k];
    for (int k = 0; k < series->terms; k++) /* a flat plane stays: all T_k(1) are 1 */
        series->coefficient[k] = (float)(coefficient[k] / sum);
    series->largest_weight = (float)largest_weight;
}

void rf_diffuse_series(const struct refocus_renderer *r, const struct rf_box *box,
                       const float *weight, float *plane, float *before, float *here,
                       float *next, const struct rf_series *series)
{
    const float flow = 0.25f / series->largest_weight;

    for (int k = 0; k < series->terms && !rf_cancelled(r); k++) {
        const float a = series->coefficient[k];

        for (int y = box->y0; y < box->y1; y++) {
            const float *b = before + y * box->stride, *c = here + y * box->stride;
            const float *w = weight + y * box->stride;
            float *restrict n = next + y * box->stride;
            float *restrict sum = plane + y * box->stride;

            if (k == 0) {
                for (int x = box->x0; x < box->x1; x++) {
                    n[x] = sum[x];
                    sum[x] *= a;
                }
            } else if (k == 1) { /* T_1 = t */
                for (int x = box->x0; x < box->x1; x++) {
                    n[x] = c[x] + flow * FLOW(c, w, x, box->stride);
                    sum[x] += a * n[x];
                }
            } else { /* T_k = 2 t T_(k-1) - T_(k-2) */
                for (int x = box->x0; x < box->x1; x++) {
                    n[x] = 2 * (c[x] + flow * FLOW(c, w, x, box->stride)) - b[x];
                    sum[x] += a * n[x];
                }
            }
        }
        float *free = before;

        before = here;
        here = next;
        next = free;
    }
}
