/* smooth1.c: computes a step of the pre-filter on one plane. */
#include "kernels/kernels.h"

#include <stdlib.h>

static bool is_like(int16_t blur, int16_t own)
{
    const int eighth = abs(own) / 8, tolerance = eighth < 256 ? 256 : eighth > 511 ? 511 : eighth;

    return abs(blur - own) <= tolerance;
}

void rf_smooth1_c(uint16_t *out, const uint16_t *light, const int16_t *blur, ptrdiff_t apart,
                  int least, int over, int n)
{
    for (int x = 0; x < n; x++) {
        const int share = rf_smooth_share(blur[x], least, over);
        int more = 0; /* than like neighbours have */

        if (is_like(blur[x - apart], blur[x]))
            more += light[x] - light[x - apart];
        if (is_like(blur[x + apart], blur[x]))
            more += light[x] - light[x + apart];
        out[x] = (uint16_t)(light[x] - ((more * share + (1 << 14)) >> 15));
    }
}
