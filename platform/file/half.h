/* half.h: half floats of light, which is not negative. */
#ifndef RF_FILE_HALF_H
#define RF_FILE_HALF_H

#include <stdint.h>
#include <string.h>

/* The largest finite half, 65504; the bits of halves from 0 to it grow as they do. */
enum { RF_HALF_MOST = 0x7bff };

/* To nearest; 0 of what is below and of NaN, 65504 of what is beyond. */
static inline uint16_t rf_half_of(float value)
{
    uint32_t bits;

    if (!(value > 0))
        return 0;
    if (value >= 65504)
        return RF_HALF_MOST;
    if (value < 1.0f / (1 << 14))
        return (uint16_t)(value * (1 << 24) + 0.5f);
    memcpy(&bits, &value, sizeof bits);
    return (uint16_t)(((bits + 0xfff + (bits >> 13 & 1)) >> 13) - (112 << 10));
}

static inline float rf_half_value(uint16_t half)
{
    const uint32_t bits = ((uint32_t)half << 13) + (112u << 23);
    float value;

    if (half < 0x400)
        return (float)half / (1 << 24);
    memcpy(&value, &bits, sizeof value);
    return value;
}

#endif
