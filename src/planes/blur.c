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

enum { RUN = 256, MARGIN = 1 << (RF_PREFILTER_STEPS - 1) }; /* columns at a time */

/* n columns of a row, from `at` on, n at most RUN: three rows to one, then columns. */
static void smooth_run(const struct refocus_renderer *r, uint16_t *const out[3],
                       uint16_t *const in[3], ptrdiff_t at, int step, int least, int n)
{
    const ptrdiff_t from = at - step;
    const int16_t *s = r->front.blur;
    uint16_t row[3][RUN + 2 * MARGIN];

    r->kernels.smooth3((uint16_t *const[3]){row[0], row[1], row[2]},
                       (const uint16_t *const[3]){in[0] + from, in[1] + from, in[2] + from},
                       s + from, step * r->stride, least, n + 2 * step);
    r->kernels.smooth3((uint16_t *const[3]){out[0] + at, out[1] + at, out[2] + at},
                       (const uint16_t *const[3]){row[0] + step, row[1] + step, row[2] + step},
                       s + at, step, least, n);
}

void rf_prefilter_rows(struct refocus_renderer *r, uint16_t *const out[3],
                       uint16_t *const in[3], int step, int least, int ty)
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

            for (int x = 0; wide && x < n; x += RUN)
                smooth_run(r, out, in, at + x, step, least, n - x < RUN ? n - x : RUN);
            for (int c = 0; !wide && c < 3; c++)
                memcpy(out[c] + at, in[c] + at, (size_t)n * 2);
        }
    }
    for (int c = 0; c < 3; c++)
        rf_extend_rows(r, out[c], y0, y1);
}
