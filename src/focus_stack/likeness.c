/* likeness.c: how alike two frames of a focus stack are, and at which shift they are most alike.
 */
#include "focus_stack/focus_stack.h"

#include <math.h>
#include <stdlib.h>

enum { FARTHEST = 3 }; /* shifts that are looked at reach over this part of a side */

double rf_stack_correlation(const uint16_t *reference, const int16_t *frame, ptrdiff_t pitch, int w,
                            int h)
{
    int64_t n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;

    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            const int32_t p = reference[y * pitch + x], q = frame[y * pitch + x];

            if (q < 0)
                continue;
            n++;
            a += p;
            b += q;
            aa += p * p;
            bb += q * q;
            ab += p * q;
        }
    if (!n)
        return 0;

    /* Sums of 2^18 squares below 2^24 fit 42 bits; products of two are taken in double precision.
     */
    const double mean_a = (double)a / (double)n, mean_b = (double)b / (double)n;
    const double va = (double)aa / (double)n - mean_a * mean_a;
    const double vb = (double)bb / (double)n - mean_b * mean_b;
    const double both = (double)ab / (double)n - mean_a * mean_b;

    return va > 0 && vb > 0 ? both / sqrt(va * vb) : 0;
}

void rf_stack_best_shift(const uint16_t *reference, const uint16_t *frame, int width, int height,
                         double t[2])
{
    const int far_x = width / FARTHEST, far_y = height / FARTHEST;
    double best = -1;

    for (int y = -far_y; y <= far_y; y++)
        for (int x = -far_x; x <= far_x; x++) {
            const ptrdiff_t to = (y < 0 ? 0 : y) * (ptrdiff_t)width + (x < 0 ? 0 : x);
            const ptrdiff_t from = (y < 0 ? -y : 0) * (ptrdiff_t)width + (x < 0 ? -x : 0);
            const double now = rf_stack_correlation(reference + from, (const int16_t *)frame + to,
                                                    width, width - abs(x), height - abs(y));

            if (now > best) {
                best = now;
                t[0] = x;
                t[1] = y;
            }
        }
}
