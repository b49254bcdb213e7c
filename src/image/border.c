/* border.c: repeats the outermost pixels of a plane beyond its sides. */
#include "image/border.h"

#include <string.h>

void rf_extend_rows(const struct rf_viewport *view, void *plane, ptrdiff_t stride, int y0, int y1)
{
    const struct rf_rect b = view->border;
    const int w = view->width, right = view->tiles_x * RF_TILE + b.x1;
    const size_t bytes = (size_t)(b.x0 + right) * 2;

    for (int y = y0; y < y1; y++) {
        uint16_t *row = (uint16_t *)plane + y * stride;

        for (int x = -b.x0; x < 0; x++)
            row[x] = row[0];
        for (int x = w; x < right; x++)
            row[x] = row[w - 1];
    }
    if (y0 == 0)
        for (int y = 1; y <= b.y0; y++)
            memcpy((uint16_t *)plane - b.x0 - y * stride, (uint16_t *)plane - b.x0, bytes);
    if (y1 == view->height)
        for (int y = view->height; y < view->height + b.y1; y++)
            memcpy((uint16_t *)plane - b.x0 + y * stride,
                   (uint16_t *)plane - b.x0 + (view->height - 1) * stride, bytes);
}
