#include "planes/planes.h"

#include <string.h>

void rf_extend_rows(const struct refocus_renderer *r, void *plane, int y0, int y1)
{
    const int w = r->width, right = r->tiles_x * RF_TILE + r->pad;
    const size_t bytes = (size_t)(r->pad + right) * 2;

    for (int y = y0; y < y1; y++) {
        uint16_t *row = (uint16_t *)plane + y * r->stride;

        for (int x = -r->pad; x < 0; x++)
            row[x] = row[0];
        for (int x = w; x < right; x++)
            row[x] = row[w - 1];
    }
    if (y0 == 0)
        for (int y = 1; y <= r->pad; y++)
            memcpy((uint16_t *)plane - r->pad - y * r->stride,
                   (uint16_t *)plane - r->pad, bytes);
    if (y1 == r->height)
        for (int y = r->height; y < r->height + r->pad + RF_TILE; y++)
            memcpy((uint16_t *)plane - r->pad + y * r->stride,
                   (uint16_t *)plane - r->pad + (r->height - 1) * r->stride,
                   bytes);
}
