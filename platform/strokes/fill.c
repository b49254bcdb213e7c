/* fill.c: a layer is filled with one disparity or a gradient of them. */
#include "fill.h"

static uint16_t code_of(double disparity)
{
    return (uint16_t)(disparity * 65535 + 0.5);
}

/* The gradient's parameter t runs along a row by a constant step, 32 bits after the
 * point. It is rounded at x = 0, so that it does not depend on where a span begins. Points lie at
 * least a pixel apart and within 2^20 of 0: |step| <= 2^32 and |t| < 2^56. */
static void fill_gradient(const struct refocus_fill *fill, uint16_t *row, int32_t y, int32_t from,
                          int32_t to)
{
    const double one = 4294967296.0;
    const double dx = (double)fill->x1 - (double)fill->x0;
    const double dy = (double)fill->y1 - (double)fill->y0;
    const double length = dx * dx + dy * dy;
    const double start = -(double)fill->x0 * dx + (y - (double)fill->y0) * dy;
    const int32_t first = code_of((double)fill->d0), last = code_of((double)fill->d1);
    const int64_t step = (int64_t)(dx / length * one);
    int64_t t = (int64_t)(start / length * one) + from * step;

    for (int32_t x = from; x < to; x++, t += step) {
        const int64_t part = t < 0 ? 0 : t > (INT64_C(1) << 32) ? INT64_C(1) << 32 : t;

        row[x] = (uint16_t)(first + (((last - first) * (part >> 8) + (1 << 23)) >> 24));
    }
}

void rf_fill_span(const struct refocus_fill *fill, uint16_t *row, int32_t y, int32_t from,
                  int32_t to)
{
    if (fill->kind == REFOCUS_FILL_GRADIENT) {
        fill_gradient(fill, row, y, from, to);
    } else if (fill->kind == REFOCUS_FILL_SOLID) {
        const uint16_t code = code_of((double)fill->d0);

        for (int32_t x = from; x < to; x++)
            row[x] = code;
    }
}
