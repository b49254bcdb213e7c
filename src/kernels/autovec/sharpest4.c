/* sharpest4.c: finds the sharpest of the blurs of the pixels that share a sample of chroma. */
#include "kernels/kernels.h"

static inline uint16_t size(int16_t s)
{
    return (uint16_t)(s < 0 ? -s : s);
}

static inline int16_t sharper(int16_t a, int16_t b)
{
    return size(a) <= size(b) ? a : b;
}

void RF_VEC(rf_sharpest4)(int16_t *restrict out, const int16_t *restrict upper,
                          const int16_t *restrict lower, int n)
{
    for (int x = 0; upper == lower && x < n; x++)
        out[2 * x] = out[2 * x + 1] = sharper(upper[2 * x], upper[2 * x + 1]);
    for (int x = 0; upper != lower && x < n; x++) {
        const int16_t s = sharper(sharper(upper[2 * x], upper[2 * x + 1]),
                                  sharper(lower[2 * x], lower[2 * x + 1]));

        out[2 * x] = s;
        out[2 * x + 1] = s;
    }
}
