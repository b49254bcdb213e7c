#include "planes/planes.h"

#include <math.h>
#include <string.h>

struct rf_focus rf_focus_of(float focus_disparity, float max_blur_radius)
{
    return (struct rf_focus){
        .disparity = (uint16_t)floor((double)focus_disparity * 65535 + 0.5),
        .radius = (uint16_t)floor((double)max_blur_radius * 256 * 65536 / 65535 + 0.5),
    };
}

void rf_signed_blur_rows(struct refocus_renderer *r, struct rf_focus focus, int y0, int y1)
{
    for (int y = y0; y < y1; y++)
        r->kernels.signed_blur(r->front.blur + y * r->stride,
                               r->disparity + y * r->stride, focus, r->width);
    rf_extend_rows(r, r->front.blur, y0, y1);
}

/* Whether a tile holds blurs above `least`. */
static bool is_wide(const struct refocus_renderer *r, int tx, int ty, int least)
{
    const struct rf_bins *bins = &r->bins[(size_t)ty * r->tiles_x + tx];

    return bins->most > least || -bins->least > least;
}

/* n columns of a row of one plane, from `at` on. */
static void smooth_run(const struct refocus_renderer *r, uint16_t *out, const uint16_t *in,
                       ptrdiff_t at, int step, int least, uint16_t *scratch, int n)
{
    const ptrdiff_t down = step * r->stride;
    const uint16_t *from = in + at - step;
    const int16_t *s = r->front.blur + at;
    uint16_t *const row = scratch + step;

    r->kernels.smooth3(row - step, from - down, from, from + down, s - step - down, s - step,
                       s - step + down, least, n + 2 * step);
    r->kernels.smooth3(out + at, row - step, row, row + step, s - step, s, s + step, least, n);
}

void rf_prefilter_rows(struct refocus_renderer *r, uint16_t *const out[3],
                       uint16_t *const in[3], int step, int least, uint16_t *scratch, int ty)
{
    const int y0 = ty * RF_TILE, y1 = y0 + RF_TILE < r->height ? y0 + RF_TILE : r->height;

    for (int tx = 0, end; tx < r->tiles_x; tx = end) {
        const bool wide = is_wide(r, tx, ty, least);
        const int x0 = tx * RF_TILE;
        int n;

        for (end = tx + 1; end < r->tiles_x && is_wide(r, end, ty, least) == wide;)
            end++;
        n = (end * RF_TILE < r->width ? end * RF_TILE : r->width) - x0;
        for (int y = y0; y < y1; y++) {
            const ptrdiff_t at = y * r->stride + x0;

            for (int c = 0; c < 3; c++) {
                if (wide)
                    smooth_run(r, out[c], in[c], at, step, least, scratch, n);
                else
                    memcpy(out[c] + at, in[c] + at, (size_t)n * 2);
            }
        }
    }
    for (int c = 0; c < 3; c++)
        rf_extend_rows(r, out[c], y0, y1);
}
