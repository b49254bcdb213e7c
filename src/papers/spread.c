/* spread.c: the lookup tables of Potmesil & Chakravarty 1981, section 3.2: the intensity
 * distribution of a circle of confusion, integrated over each pixel. */
#include <math.h>
#include <string.h>

#include <refocus/render.h>

#include "papers/lommel.h"
#include "papers/scatter.h"

enum { PROFILE = 1024 };

int rf_spread_tables(double max_radius)
{
    const int n = 4 * (int)ceil(max_radius) + 1;

    return n > RF_SPREAD_LEAST_TABLES ? n : RF_SPREAD_LEAST_TABLES;
}

int rf_spread_reach(double max_radius, int i)
{
    const int n = rf_spread_tables(max_radius);
    const int next = i + 1 < n ? i + 1 : i;

    return (int)ceil(max_radius * next / (n - 1));
}

/* Computes the intensity from the middle, [0], to the edge of the circle, [count]. */
static int make_profile(double radius, uint32_t spread, double airy_radius,
                        double profile[PROFILE + 1], struct rf_run *run)
{
    const int count = spread == REFOCUS_SPREAD_UNIFORM ? 1
                      : radius * 16 < PROFILE          ? (int)ceil(radius * 16)
                                                       : PROFILE;
    const double scale = 3.8317059702075125 / airy_radius; /* first zero of J1 */

    for (int i = 0; i <= count && !rf_run_cancelled(run); i++)
        profile[i] = spread == REFOCUS_SPREAD_UNIFORM
                         ? 1
                         : rf_lommel(scale * radius, scale * radius * i / count);
    return count;
}

/* Integrates over the pixel (x, y) by n x n points. */
static double over_pixel(double radius, const double *profile, int count, int x, int y)
{
    const int n = radius < 16 ? 16 : radius < 48 ? 8 : 4;
    double sum = 0;

    for (int j = 0; j < n; j++) {
        for (int i = 0; i < n; i++) {
            const double dx = x + (i + 0.5) / n - 0.5, dy = y + (j + 0.5) / n - 0.5;
            const double t = sqrt(dx * dx + dy * dy) / radius * count;
            const int k = (int)t;

            if (k < count)
                sum += profile[k] + (t - k) * (profile[k + 1] - profile[k]);
        }
    }
    return sum;
}

void rf_spread_fill(struct rf_spread_table *table, uint32_t spread, double airy_radius,
                    struct rf_run *run)
{
    const int reach = table->reach, width = 2 * reach + 1;
    const int most =
        (int)ceil(table->radius - 0.5) < reach ? (int)ceil(table->radius - 0.5) : reach;
    double profile[PROFILE + 1], sum = 0;
    int64_t left = RF_SPREAD_ONE;
    int count;

    memset(table->share, 0, sizeof *table->share * (size_t)width * ((size_t)reach + 1));
    if (table->radius < 0.5) { /* within its own pixel */
        table->share[reach] = RF_SPREAD_ONE;
        return;
    }
    count = make_profile(table->radius, spread, airy_radius, profile, run);
    for (int pass = 0; pass < 2; pass++) { /* first the sum, then the shares */
        for (int y = 0; y <= most; y++) {
            if (rf_run_cancelled(run))
                return;
            for (int x = 0; x <= most; x++) {
                const double value = over_pixel(table->radius, profile, count, x, y);
                const int copies = (x ? 2 : 1) * (y ? 2 : 1);

                if (pass == 0) {
                    sum += copies * value;
                } else {
                    const uint32_t share = (uint32_t)(value / sum * RF_SPREAD_ONE + 0.5);

                    table->share[y * width + reach + x] = share;
                    table->share[y * width + reach - x] = share;
                    left -= (int64_t)copies * share;
                }
            }
        }
    }
    /* The remainder of rounding goes to the middle, which keeps at least a little, so that a
     * pixel's denominator is never 0. */
    left += table->share[reach];
    table->share[reach] = left > 1 ? (uint32_t)left : 1;
}
