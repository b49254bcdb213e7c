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
                               r->disparity + (size_t)y * r->width, focus, r->width);
    rf_extend_rows(r, r->front.blur, y0, y1);
}

void rf_prefilter_rows(struct refocus_renderer *r, uint16_t *const out[3],
                       uint16_t *const in[3], int step, int least, uint16_t *scratch, int y0,
                       int y1)
{
    const ptrdiff_t down = step * r->stride;
    uint16_t *const row = scratch + step;

    for (int y = y0; y < y1; y++) {
        const ptrdiff_t at = y * r->stride;
        const int16_t *s = r->front.blur + at;

        for (int c = 0; c < 3; c++) {
            const uint16_t *from = in[c] + at - step;

            if (least == INT16_MAX) {
                memcpy(out[c] + at, in[c] + at, (size_t)r->width * 2);
                continue;
            }
            r->kernels.smooth3(row - step, from - down, from, from + down, s - step - down,
                               s - step, s - step + down, least, r->width + 2 * step);
            r->kernels.smooth3(out[c] + at, row - step, row, row + step, s - step, s, s + step,
                               least, r->width);
        }
    }
    for (int c = 0; c < 3; c++)
        rf_extend_rows(r, out[c], y0, y1);
}
