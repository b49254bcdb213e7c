/* hole_colours.c: colours of the photo at the samples of a depth map that has holes. */
#include "depth/hole_colours.h"

#include <stdlib.h>
#include <string.h>

#include "image/disparity_map.h"

void rf_hole_colours_load(const struct rf_hole_colours *colours, const struct refocus_image *photo)
{
    const int bytes = refocus_format_bytes(photo->format);
    const int width = colours->width, height = colours->height;
    uint8_t *out = colours->own;

    for (int y = 0; y < height; y++) {
        const uint8_t *row =
            photo->plane[0] + rf_middle_of(y, height, photo->height) * photo->stride[0];

        for (int x = 0; x < width; x++, out += 3)
            memcpy(out, row + (ptrdiff_t)rf_middle_of(x, width, photo->width) * bytes, 3);
    }
    memcpy(colours->surface, colours->own, (size_t)width * (size_t)height * 3);
}

void rf_hole_colours_settle(const struct rf_hole_colours *colours, const uint16_t *disparity,
                            ptrdiff_t stride, const uint8_t *state, int x, int y, int continuous)
{
    const int width = colours->width, height = colours->height;
    const uint16_t *row = (const uint16_t *)((const char *)disparity + y * stride);
    uint8_t *surface = colours->surface + 3 * ((size_t)y * (size_t)width + (size_t)x);
    int sum[3] = {0}, count = 0;

    for (int j = y > 0 ? y - 1 : 0; j <= y + 1 && j < height; j++) {
        const uint16_t *near = (const uint16_t *)((const char *)disparity + j * stride);

        for (int i = x > 0 ? x - 1 : 0; i <= x + 1 && i < width; i++) {
            const size_t at = (size_t)j * (size_t)width + (size_t)i;

            if (state[at] != RF_SAMPLE_KNOWN || abs(near[i] - row[x]) > continuous)
                continue;
            for (int c = 0; c < 3; c++)
                sum[c] += colours->own[3 * at + (size_t)c];
            count++;
        }
    }
    for (int c = 0; c < 3; c++)
        surface[c] = (uint8_t)((sum[c] + count / 2) / count);
}
