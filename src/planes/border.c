#include "planes/planes.h"

#include <string.h>

void rf_extend_rows(const struct refocus_renderer *r, void *plane, int y0, int y1)
{
    const struct rf_rect b = r->border;
    const int w = r->width, right = r->tiles_x * RF_TILE + b.x1;
    const size_t bytes = (size_t)(b.x0 + right) * 2;

    for (int y = y0; y < y1; y++) {
        uint16_t *row = (uint16_t *)plane + y * r->stride;

        for (int x = -b.x0; x < 0; x++)
            row[x] = row[0];
        for (int x = w; x < right; x++)
            row[x] = row[w - 1];
    }
    if (y0 == 0)
        for (int y = 1; y <= b.y0; y++)
            memcpy((uint16_t *)plane - b.x0 - y * r->stride, (uint16_t *)plane - b.x0, bytes);
    if (y1 == r->height)
        for (int y = r->height; y < r->height + b.y1; y++)
            memcpy((uint16_t *)plane - b.x0 + y * r->stride,
                   (uint16_t *)plane - b.x0 + (r->height - 1) * r->stride, bytes);
}
