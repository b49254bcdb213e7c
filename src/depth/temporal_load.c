/* temporal_load.c: reads a depth map, and what the photo shows at each of its samples. */
#include <stdbool.h>

#include "depth/temporal.h"
#include "image/format.h"
#include "image/disparity_map.h"
#include "support/compare.h"

static int within(int v, int size)
{
    return rf_larger(rf_smaller(v, size - 1), 0);
}

/* Where brightness lies in plane 0: that of Y, or of a pixel of R, G and B, by the upper bytes of
 * samples of 16 bits. */
struct brightness {
    bool luma;
    ptrdiff_t first, sample, step; /* bytes to the first one, to the next channel and pixel */
};

static struct brightness brightness_of(uint32_t format)
{
    const bool luma = refocus_format_is_yuv(format);
    const ptrdiff_t sample = rf_is_deep(format) ? 2 : 1;
    const ptrdiff_t first = __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? sample - 1 : 0;

    if (!luma)
        return (struct brightness){luma, first, sample, refocus_format_bytes(format)};
    return (struct brightness){luma, first, sample, format == REFOCUS_FORMAT_YUYV ? 2 : sample};
}

/* Brightness of the photo around a sample, Y or (c0 + 2 c1 + c2) / 4: of 3 x 3 pixels a third of
 * a sample apart, which calms noise and does not alias. */
static uint8_t guide_at(const struct refocus_image *photo, const struct brightness *at, int x,
                        int y, int dx, int dy)
{
    int sum = 0;

    for (int j = -1; j <= 1; j++) {
        const uint8_t *row =
            photo->plane[0] + within(y + j * dy, photo->height) * photo->stride[0] + at->first;

        for (int i = -1; i <= 1; i++) {
            const uint8_t *p = row + within(x + i * dx, photo->width) * at->step;

            sum += at->luma ? 4 * p[0] : p[0] + 2 * p[at->sample] + p[2 * at->sample];
        }
    }
    return (uint8_t)(sum / 36);
}

void rf_load_frame(const struct rf_frame *frame, int width, int height,
                   const struct refocus_image *photo, const struct refocus_disparity *map,
                   struct rf_run *run)
{
    const int dx = photo ? photo->width / (3 * width) : 0;
    const int dy = photo ? photo->height / (3 * height) : 0;
    const struct brightness at = brightness_of(photo ? photo->format : REFOCUS_FORMAT_NONE);

    for (int y = 0; y < height && !rf_run_cancelled(run); y++) {
        const void *const in = rf_map_row(map, y);
        const size_t row = (size_t)y * (size_t)width;

        for (int x = 0; x < width; x++) {
            const uint16_t d = rf_map_sample(map, in, x);

            frame->disparity[row + (size_t)x] = d;
            frame->guide[row + (size_t)x] =
                photo ? guide_at(photo, &at, rf_middle_of(x, width, photo->width),
                                 rf_middle_of(y, height, photo->height), dx ? dx : 1, dy ? dy : 1)
                      : (uint8_t)(d >> 8);
        }
    }
}
