/* log2.h: logarithms and powers of 2 with the same bits everywhere. */
#ifndef RF_LOG2_H
#define RF_LOG2_H

#include <stdint.h>
#include <string.h>

#include "support/exp_minus.h"

/* log2(x) of normal x > 0 from IEEE operations alone, as rf_exp_minus(): x is m 2^e with m between
 * 0.75 and 1.5, and log2(m) a series in (m - 1) / (m + 1), good to 1e-9. */
static inline double rf_log2(double x)
{
    uint64_t bits;
    int exponent;
    double m, t, u;

    memcpy(&bits, &x, sizeof bits);
    exponent = (int)(bits >> 52) - 1022;
    bits = (bits & ((UINT64_C(1) << 52) - 1)) | UINT64_C(1022) << 52;
    memcpy(&m, &bits, sizeof m); /* 0.5 to 1 */
    if (m < 0.75) {
        m *= 2;
        exponent--;
    }
    t = (m - 1) / (m + 1);
    u = t * t;
    return exponent +
           2.8853900817779268 * t *
               (1 + u * (1.0 / 3 + u * (1.0 / 5 + u * (1.0 / 7 + u * (1.0 / 9 + u / 11)))));
}

/* log2(x) of normal x > 0 in single precision, good to 1e-6; loops of it become vectors. */
static inline float rf_log2f(float x)
{
    uint32_t bits;
    float exponent, m, t, u;

    memcpy(&bits, &x, sizeof bits);
    bits += 0x3f800000 - 0x3f400000; /* so that m is 0.75 to 1.5 */
    exponent = (float)((int)(bits >> 23) - 127);
    bits = (bits & 0x7fffff) + 0x3f400000;
    memcpy(&m, &bits, sizeof m);
    t = (m - 1) / (m + 1);
    u = t * t;
    return exponent +
           2.885390082f * t * (1 + u * (1.0f / 3 + u * (1.0f / 5 + u * (1.0f / 7 + u / 9))));
}

/* 2^x of 0 <= x <= 64. */
static inline double rf_exp2(double x)
{
    return 1 / rf_exp_minus(x * 0.69314718055994531);
}

#endif
