/* lanes.h: arithmetic of 16-bit lanes in forms that the compiler's vectoriser understands. */
#ifndef RF_KERNELS_LANES_H
#define RF_KERNELS_LANES_H

#include <stdint.h>

static inline uint16_t rf_most16(uint16_t a, uint16_t b)
{
    return a > b ? a : b;
}

static inline uint16_t rf_least16(uint16_t a, uint16_t b)
{
    return a < b ? a : b;
}

/* Subtraction that stops at 0. */
static inline uint16_t rf_subs16(uint16_t a, uint16_t b)
{
    return (uint16_t)(a > b ? a - b : 0);
}

static inline uint16_t rf_apart16(uint16_t a, uint16_t b)
{
    return (uint16_t)(rf_most16(a, b) - rf_least16(a, b));
}

#endif
