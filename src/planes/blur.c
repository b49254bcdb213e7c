#include "planes/planes.h"

#include <math.h>

struct rf_focus rf_focus_of(float focus_disparity, float max_blur_radius)
{
    return (struct rf_focus){
        .disparity = (uint16_t)floor((double)focus_disparity * 65535 + 0.5),
        .radius = (uint16_t)floor((double)max_blur_radius * 256 * 65536 / 65535 + 0.5),
    };
}

void rf_signed_blur_rows(struct refocus_renderer *r, struct rf_focus focus, int y0, int y1)
{
    const int df = focus.disparity;
    const uint32_t radius = focus.radius;

    for (int y = y0; y < y1; y++) {
        const uint16_t *restrict d = r->disparity + (size_t)y * r->width;
        int16_t *restrict s = r->front.blur + y * r->stride;

        for (int x = 0; x < r->width; x++) {
            const uint32_t distance = (uint32_t)(d[x] > df ? d[x] - df : df - d[x]);
            const int blur = (int)((distance * radius + (1 << 15)) >> 16);

            s[x] = (int16_t)(d[x] > df ? -blur : blur);
        }
    }
    rf_extend_rows(r, r->front.blur, y0, y1);
}

void rf_prefilter_rows(struct refocus_renderer *r, int least, int y0, int y1)
{
    /* 65536 / n rounded: exact for sums of n equal Q12 values */
    static const uint32_t share[10] = {0,     65536, 32768, 21845, 16384,
                                       13107, 10923, 9362,  8192,  7282};
    const ptrdiff_t stride = r->stride;

    for (int y = y0; y < y1; y++) {
        const int16_t *s = r->front.blur + y * stride;

        for (int x = 0; x < r->width; x++) {
            const ptrdiff_t at = y * stride + x;
            const int middle = s[x];
            uint32_t sum[3] = {0, 0, 0}, n = 0;

            if (middle <= least && -middle <= least) {
                for (int c = 0; c < 3; c++)
                    r->smooth[c][at] = r->front.light[c][at];
                continue;
            }
            for (int j = -1; j <= 1; j++) {
                for (int i = -1; i <= 1; i++) {
                    const ptrdiff_t near_by = at + j * stride + i;
                    const int apart = r->front.blur[near_by] - middle;

                    if (apart > 256 || apart < -256)
                        continue;
                    n++;
                    for (int c = 0; c < 3; c++)
                        sum[c] += r->front.light[c][near_by];
                }
            }
            for (int c = 0; c < 3; c++)
                r->smooth[c][at] = (uint16_t)((sum[c] * share[n] + 32768) >> 16);
        }
    }
    for (int c = 0; c < 3; c++)
        rf_extend_rows(r, r->smooth[c], y0, y1);
}
