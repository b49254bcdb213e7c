#include "kernels/kernels.h"

#include <stdlib.h>

static bool is_like(int16_t blur, int16_t own, int least)
{
    const int eighth = abs(own) / 8, tolerance = eighth < 256 ? 256 : eighth > 511 ? 511 : eighth;

    return abs(own) > least && abs(blur - own) <= tolerance;
}

/* Of a pixel, whose neighbours count or not. */
static uint16_t mean(const uint16_t *light, ptrdiff_t apart, bool before, bool after, uint32_t left)
{
    const unsigned count = 1u + before + after;
    const unsigned sum =
        light[0] + (before ? light[-apart] : 0u) + (after ? light[apart] : 0u);
    const unsigned own = light[0], all = (sum + count / 2) / count;

    return (uint16_t)(all > own ? all - ((all - own) * left >> 16)
                                : all + ((own - all) * left >> 16));
}

void rf_smooth1_c(uint16_t *out, const uint16_t *light, const int16_t *blur, ptrdiff_t apart,
                  int least, int over, int n)
{
    for (int x = 0; x < n; x++)
        out[x] = mean(light + x, apart, is_like(blur[x - apart], blur[x], least),
                      is_like(blur[x + apart], blur[x], least), rf_fade_left(blur[x], least, over));
}

void rf_smooth3_c(uint16_t *const out[3], const uint16_t *const light[3], const int16_t *blur,
                  ptrdiff_t apart, int least, int over, int n)
{
    for (int c = 0; c < 3; c++)
        rf_smooth1_c(out[c], light[c], blur, apart, least, over, n);
}
