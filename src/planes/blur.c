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

void rf_prefilter_rows(struct refocus_renderer *r, int least, uint16_t *scratch, int y0,
                       int y1)
{
    const ptrdiff_t stride = r->stride;
    uint16_t *const row = scratch + 1;

    for (int y = y0; y < y1; y++) {
        const int16_t *s = r->front.blur + y * stride;

        for (int c = 0; c < 3; c++) {
            const uint16_t *light = r->front.light[c] + y * stride;
            uint16_t *out = r->smooth[c] + y * stride;

            if (least == INT16_MAX) {
                memcpy(out, light, (size_t)r->width * 2);
                continue;
            }
            r->kernels.smooth3(row - 1, light - 1 - stride, light - 1, light - 1 + stride,
                               s - 1 - stride, s - 1, s - 1 + stride, least, r->width + 2);
            r->kernels.smooth3(out, row - 1, row, row + 1, s - 1, s, s + 1, least, r->width);
        }
    }
    for (int c = 0; c < 3; c++)
        rf_extend_rows(r, r->smooth[c], y0, y1);
}
