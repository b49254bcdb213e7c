/* weighted_means.c: divides 64-bit sums of light times weight by the sums of the weights, in double
 * precision. */
#include "kernels/kernels.h"

enum { LANES = RF_TILE * RF_TILE };

union number {
    uint64_t bits;
    double real;
};

/* Whole numbers below 2^52 as doubles: the mantissa of 2^52 + v is v. */
static void to_real(double *restrict real, const uint64_t *restrict v, int n)
{
    const union number bias = {.real = 4503599627370496.0};

    for (int i = 0; i < n; i++) {
        const union number biased = {.bits = v[i] | bias.bits};

        real[i] = biased.real - bias.real;
    }
}

void RF_VEC(rf_weighted_means)(uint16_t *restrict mean, const uint64_t *restrict sum,
                               const uint64_t *restrict weight, int n)
{
    double s[LANES], w[LANES];

    to_real(s, sum, n);
    to_real(w, weight, n);
    for (int i = 0; i < n; i++)
        mean[i] = (uint16_t)(int32_t)(4 * s[i] / w[i] + 0.5);
}
