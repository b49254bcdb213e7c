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

/* Writes a sample's two values n times. */
static void repeat(uint16_t *to, const uint16_t *sample, int n)
{
    const uint16_t a = sample[0], b = sample[1];

    for (int i = 0; i < n; i++) {
        to[2 * i] = a;
        to[2 * i + 1] = b;
    }
}

void rf_extend_chroma(const struct rf_viewport *view, const struct rf_chroma_size *size,
                      void *plane, ptrdiff_t stride, int c0, int c1)
{
    const int w = 2 * size->width, left = view->pad & ~1;
    const int right = view->tiles_x * RF_TILE + view->pad;
    /* Offsets of half a row round up. */
    const int beyond = size->down ? view->pad / 2 + 1 : view->pad;
    const int below = (RF_TILE >> size->down) + beyond;
    const size_t bytes = (size_t)(left + right) * 2;
    uint16_t *const first = (uint16_t *)plane - left;

    for (int y = c0; y < c1; y++) {
        uint16_t *row = (uint16_t *)plane + y * stride;

        repeat(row - left, row, left / 2);
        repeat(row + w, row + w - 2, (right - w) / 2);
    }
    if (c0 == 0)
        for (int y = 1; y <= beyond; y++)
            memcpy(first - y * stride, first, bytes);
    if (c1 == size->height)
        for (int y = 0; y < below; y++)
            memcpy(first + (size->height + y) * stride, first + (size->height - 1) * stride, bytes);
}
