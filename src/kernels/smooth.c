#include "kernels/kernels.h"

#include <stdlib.h>

static bool is_like(int16_t blur, int16_t own, int least)
{
    const int eighth = abs(own) / 8, tolerance = eighth < 256 ? 256 : eighth > 511 ? 511 : eighth;

    return abs(own) > least && abs(blur - own) <= tolerance;
}

void rf_smooth3_c(uint16_t *const out[3], const uint16_t *const light[3], const int16_t *blur,
                  ptrdiff_t apart, int least, int n)
{
    for (int x = 0; x < n; x++) {
        const bool before = is_like(blur[x - apart], blur[x], least);
        const bool after = is_like(blur[x + apart], blur[x], least);
        const unsigned count = 1u + before + after;

        for (int c = 0; c < 3; c++) {
            unsigned sum = light[c][x];

            sum += before ? light[c][x - apart] : 0;
            sum += after ? light[c][x + apart] : 0;
            out[c][x] = (uint16_t)((sum + count / 2) / count);
        }
    }
}

void rf_smooth1_c(uint16_t *out, const uint16_t *light, const int16_t *blur, ptrdiff_t apart,
                  int least, int n)
{
    for (int x = 0; x < n; x++) {
        const bool before = is_like(blur[x - apart], blur[x], least);
        const bool after = is_like(blur[x + apart], blur[x], least);
        const unsigned count = 1u + before + after;
        const unsigned sum = light[x] + (before ? light[x - apart] : 0u) +
                             (after ? light[x + apart] : 0u);

        out[x] = (uint16_t)((sum + count / 2) / count);
    }
}
