/* light.c: loops over light and weights, plain C for the vectoriser. */
#include "kernels/kernels.h"
#include "simd/vec.h"

enum { LANES = RF_TILE * RF_TILE };

union number {
    uint64_t bits;
    double real;
};

/* Whole numbers below 2^52 as doubles: the mantissa of 2^52 + v is v. */
static void RF_VEC(to_real)(double *restrict real, const uint64_t *restrict v, int n)
{
    const union number bias = {.real = 4503599627370496.0};

    for (int i = 0; i < n; i++) {
        const union number biased = {.bits = v[i] | bias.bits};

        real[i] = biased.real - bias.real;
    }
}

static void RF_VEC(rf_weighted_means)(uint16_t *restrict mean, const uint64_t *restrict sum,
                                      const uint64_t *restrict weight, int n)
{
    double s[LANES], w[LANES];

    RF_VEC(to_real)(s, sum, n);
    RF_VEC(to_real)(w, weight, n);
    for (int i = 0; i < n; i++)
        mean[i] = (uint16_t)(int32_t)(4 * s[i] / w[i] + 0.5);
}

static void RF_VEC(rf_luminance)(uint16_t *restrict out, const uint16_t *restrict red,
                                 const uint16_t *restrict green,
                                 const uint16_t *restrict blue, int n)
{
    for (int x = 0; x < n; x++)
        out[x] = (uint16_t)((218u * red[x] + 732u * green[x] + 74u * blue[x] + 1024) >> 11);
}

static inline uint16_t max16(uint16_t a, uint16_t b)
{
    return a > b ? a : b;
}

static uint16_t RF_VEC(rf_brightest)(const uint16_t *restrict red,
                                     const uint16_t *restrict green,
                                     const uint16_t *restrict blue, int n)
{
    uint16_t most = 0;

    for (int x = 0; x < n; x++)
        most = max16(most, max16(red[x], max16(green[x], blue[x])));
    return most;
}

void RF_VEC(rf_light_use)(struct rf_kernels *kernels)
{
    kernels->luminance = RF_VEC(rf_luminance);
    kernels->brightest = RF_VEC(rf_brightest);
    kernels->weighted_means = RF_VEC(rf_weighted_means);
}
