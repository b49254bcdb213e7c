/* curve.h: the curves between the values that deep photos store and light, as straight pieces.
 *
 * A piece is 1/256 of an octave, from 2^-18 to 2^7; below, the curve is straight down to 0. Powers
 * are within 1e-5 of their value, a sixth of a step of Q14 at white. Light is in units of the
 * transfer, that of PQ in 100 cd/m2.
 */
#ifndef RF_CURVE_H
#define RF_CURVE_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include <refocus/image.h>

enum {
    RF_CURVE_LEAST = -18, /* exponent of the first piece */
    RF_CURVE_OCTAVES = 25,
    RF_CURVE_PIECES = RF_CURVE_OCTAVES * 256,
};

struct rf_curve {
    float at[RF_CURVE_PIECES + 1]; /* where pieces begin, and the end */
};

/* Sets a curve from stored values to light, or from light to stored values. */
void rf_curve_make(struct rf_curve *curve, uint32_t transfer, float gamma, bool to_light);

/* The curve at x; 0 of NaN and what is not above 0, the end's value of anything beyond. */
static inline float rf_curve_at(const struct rf_curve *curve, float x)
{
    const float below = 1 << -RF_CURVE_LEAST;
    uint32_t bits, i;

    if (!(x * below >= 1))
        return x > 0 ? curve->at[0] * (x * below) : 0;
    memcpy(&bits, &x, sizeof bits);
    i = (bits >> 15) - ((127 + RF_CURVE_LEAST) << 8);
    if (i >= RF_CURVE_PIECES)
        return curve->at[RF_CURVE_PIECES];
    return curve->at[i] +
           (curve->at[i + 1] - curve->at[i]) * ((float)(bits & 0x7fff) * (1 / 32768.0f));
}

#endif
