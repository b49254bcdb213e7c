/* curve.c: makes the curves of deep photos, with the same bits everywhere. */
#include "colour/curve.h"

#include "support/log2.h"

/* x^p of x >= 0. */
static double power(double x, double p)
{
    const double log = x > 0 ? p * 0.69314718055994531 * rf_log2(x) : -64;

    return x <= 0 ? 0 : log <= 0 ? rf_exp_minus(-log) : 1 / rf_exp_minus(log);
}

/* SMPTE ST 2084 and BT.2100. */
static const double m1 = 2610 / 16384.0, m2 = 2523 / 32.0;
static const double c1 = 3424 / 4096.0, c2 = 2413 / 128.0, c3 = 2392 / 128.0;
static const double ha = 0.17883277, hb = 0.28466892, hc = 0.55991073;

static double pq_to_light(double x)
{
    const double e = power(x < 1 ? x : 1, 1 / m2);

    return 100 * power((e > c1 ? e - c1 : 0) / (c2 - c3 * e), 1 / m1);
}

static double pq_to_value(double y)
{
    const double p = power(y / 100, m1);

    return power((c1 + c2 * p) / (1 + c3 * p), m2);
}

static double hlg_to_light(double x)
{
    const double e = x < hc ? rf_exp_minus((hc - x) / ha) : 1 / rf_exp_minus((x - hc) / ha);

    return x <= 0.5 ? x * x / 3 : (e + hb) / 12;
}

static double hlg_to_value(double y)
{
    return y <= 1 / 12.0 ? power(3 * y, 0.5) : ha * 0.69314718055994531 * rf_log2(12 * y - hb) + hc;
}

static double light_of(double x, uint32_t transfer, double gamma)
{
    switch (transfer) {
    case REFOCUS_TRANSFER_SRGB:
        return x <= 0.04045 ? x / 12.92 : power((x + 0.055) / 1.055, 2.4);
    case REFOCUS_TRANSFER_BT709:
        return x < 0.081 ? x / 4.5 : power((x + 0.099) / 1.099, 1 / 0.45);
    case REFOCUS_TRANSFER_PQ:
        return pq_to_light(x);
    case REFOCUS_TRANSFER_HLG:
        return hlg_to_light(x);
    case REFOCUS_TRANSFER_GAMMA:
        return power(x, gamma);
    }
    return x;
}

static double value_of(double y, uint32_t transfer, double gamma)
{
    switch (transfer) {
    case REFOCUS_TRANSFER_SRGB:
        return y <= 0.0031308 ? 12.92 * y : 1.055 * power(y, 1 / 2.4) - 0.055;
    case REFOCUS_TRANSFER_BT709:
        return y < 0.018 ? 4.5 * y : 1.099 * power(y, 0.45) - 0.099;
    case REFOCUS_TRANSFER_PQ:
        return pq_to_value(y);
    case REFOCUS_TRANSFER_HLG:
        return hlg_to_value(y);
    case REFOCUS_TRANSFER_GAMMA:
        return power(y, 1 / gamma);
    }
    return y;
}

void rf_curve_make(struct rf_curve *curve, uint32_t transfer, float gamma, bool to_light)
{
    double octave = 1.0 / (1 << -RF_CURVE_LEAST);

    for (int i = 0; i <= RF_CURVE_PIECES; i++) {
        const double x = octave * (1 + i % 256 / 256.0);

        curve->at[i] =
            (float)(to_light ? light_of(x, transfer, gamma) : value_of(x, transfer, gamma));
        if (i % 256 == 255)
            octave *= 2;
    }
}
