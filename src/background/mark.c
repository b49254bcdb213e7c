/* mark.c: marks the foreground pixels, where the hidden background is to be inpainted. */
#include "background/mark.h"

#include <assert.h>
#include <string.h>

#include "kernels/kernels.h"
#include "support/compare.h"

int rf_mark_reach(bool plain, int max_blur_radius, int unit)
{
    static_assert(2 * 256 - 1 >= 2 * 2 * RF_PLAIN_RADIUS && RF_PLAIN_RADIUS >= RF_UNIT_RADIUS,
                  "the cone has fallen by the largest difference of blurs");
    return rf_smaller((plain ? 2 : 4) * max_blur_radius, 2 * rf_spread_margin(unit) - 1);
}

/* Dilated values are s + 2^15, so that 0 lies below all of them. */
static void bias_row(uint16_t *restrict out, const int16_t *restrict s, int width)
{
    for (int x = 0; x < width; x++)
        out[x] = (uint16_t)((uint16_t)s[x] ^ 0x8000);
    out[-1] = out[width] = 0;
}

void rf_background_dilate(const struct rf_executor *exec, const struct rf_viewport *view,
                          const struct rf_mark *mark, bool upwards)
{
    const int first = upwards ? view->height - 1 : 0, step = upwards ? -1 : 1;
    const ptrdiff_t next = step * mark->cone.stride;
    uint16_t *row =
        (upwards ? mark->cone.from_below : mark->cone.from_above) + first * mark->cone.stride;

    for (int i = 0; i < view->height; i++, row += next) {
        if (i % 16 == 0 && rf_cancelled(exec))
            return;
        bias_row(row, mark->blur.at + (first + i * step) * mark->blur.stride, view->width);
        if (i > 0)
            exec->kernels->dilate_from(row, row - next, mark->blur.unit, view->width);
    }
}

/* Copies a row of light to the background. */
static void copy_row(const struct rf_mark *mark, int y, int width)
{
    for (int c = 0; c < mark->planes; c++)
        memcpy(mark->background.light.channel[c] + y * mark->background.light.stride,
               mark->smooth.channel[c] + y * mark->smooth.stride, (size_t)width * 2);
}

void rf_background_mark_rows(const struct rf_executor *exec, const struct rf_viewport *view,
                             const struct rf_mark *mark, int y0, int y1, int worker)
{
    const int w = view->width;
    const int unit = mark->blur.unit, margin = rf_spread_margin(unit);
    uint16_t *row = rf_scratch(exec, worker) + margin;
    uint16_t *spare = row + w + 2 * margin;

    for (int y = y0; y < y1; y++) {
        const uint16_t *down = mark->cone.from_above + y * mark->cone.stride;
        const uint16_t *up = mark->cone.from_below + y * mark->cone.stride;
        int16_t *blur = mark->background.blur.at + y * mark->background.blur.stride;
        const uint16_t *dilated;

        for (int x = 0; x < w; x++)
            row[x] = down[x] > up[x] ? down[x] : up[x];
        dilated = exec->kernels->spread_row(row, spare, mark->reach, unit, w);
        exec->kernels->mark_foreground(blur, mark->blur.at + y * mark->blur.stride, dilated, w);
        blur[w] = RF_NO_BLUR; /* a column more if the width is odd */
        copy_row(mark, y, w);
    }
}

void rf_known_store(const struct rf_known *known, const struct rf_viewport *view,
                    struct rf_blur_q8 marked, struct rf_rect block)
{
    for (int y = block.y0; y < block.y1; y++) {
        const int16_t *blur = marked.at + (y - view->y0) * marked.stride - view->x0;
        uint8_t *row = known->bits + y * known->stride;

        for (int x = block.x0; x < block.x1; x += 8) {
            int bits = 0;

            for (int i = 0; i < 8 && x + i < block.x1; i++)
                bits |= (blur[x + i] != RF_NO_BLUR) << i;
            row[x / 8] = (uint8_t)bits;
        }
    }
}

void rf_known_mark_rows(const struct rf_known *known, const struct rf_viewport *view,
                        const struct rf_mark *mark, int y0, int y1)
{
    for (int y = y0; y < y1; y++) {
        const uint8_t *row = known->bits + (y + view->y0) * known->stride;
        const int16_t *blur = mark->blur.at + y * mark->blur.stride;
        int16_t *out = mark->background.blur.at + y * mark->background.blur.stride;

        for (int x = 0; x < view->width; x++) {
            const int q = x + view->x0;

            out[x] = row[q / 8] >> q % 8 & 1 ? blur[x] : RF_NO_BLUR;
        }
        out[view->width] = RF_NO_BLUR; /* a column more if the width is odd */
        copy_row(mark, y, view->width);
    }
}
