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

            if (rf_cancelled(r))
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

/* Row y of T_k into the plane of T_(k-2), and its share into the sum. */
static void series_row(const struct rf_box *box, const float *weight, float *plane,
                       float *const T[2], const struct rf_series *series, int k, int y)
{
    const float a = series->coefficient[k], flow = 0.25f / series->largest_weight;
    const float *c = T[(k + 1) % 2] + y * box->stride, *w = weight + y * box->stride;
    float *restrict t = T[k % 2] + y * box->stride;
    float *restrict sum = plane + y * box->stride;

    if (k == 0) {
        for (int x = box->x0; x < box->x1; x++) {
            t[x] = sum[x];
            sum[x] *= a;
        }
    } else if (k == 1) { /* T_1 = t */
        for (int x = box->x0; x < box->x1; x++) {
            t[x] = c[x] + flow * FLOW(c, w, x, box->stride);
            sum[x] += a * t[x];
        }
    } else { /* T_k = 2 t T_(k-1) - T_(k-2) */
        for (int x = box->x0; x < box->x1; x++) {
            t[x] = 2 * (c[x] + flow * FLOW(c, w, x, box->stride)) - t[x];
            sum[x] += a * t[x];
        }
    }
}

void rf_diffuse_series(const struct refocus_renderer *r, const struct rf_box *box,
                       const float *weight, float *plane, float *even, float *odd,
                       const struct rf_series *series)
{
    enum { AT_ONCE = 16 };
    float *const T[2] = {even, odd};

    /* Some terms at once, each two rows behind the one before it, so that what they share is
     * still in the cache: T_k needs rows y - 1 .. y + 1 of T_(k-1), and takes the place of
     * row y of T_(k-2), which T_(k-1) needs for its rows up to y + 1. */
    for (int first = 0; first < series->terms && !rf_cancelled(r); first += AT_ONCE) {
        for (int front = box->y0; front < box->y1 + 2 * (AT_ONCE - 1); front++) {
            if (rf_cancelled(r))
                return;
            for (int i = 0; i < AT_ONCE && first + i < series->terms; i++) {
                const int y = front - 2 * i;

                if (y >= box->y0 && y < box->y1)
                    series_row(box, weight, plane, T, series, first + i, y);
            }
        }
    }
}
