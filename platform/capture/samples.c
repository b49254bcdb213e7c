/* Y, U and V from one order in memory to another. */
#include <string.h>
#include "sink.h"

void rf_samples_of(struct rf_samples samples[3], uint32_t format,
                   const uint8_t *const plane[3], const ptrdiff_t stride[3])
{
    const bool packed = format == REFOCUS_FRAME_YUYV || format == REFOCUS_FRAME_UYVY;
    const bool planar = format == REFOCUS_FRAME_YUV420;
    const int swapped = format == REFOCUS_FRAME_UYVY || format == REFOCUS_FRAME_NV21;

    for (int i = 0; i < 3; i++) {
        const int p = packed ? 0 : planar ? i : i > 0;
        int at = 0;

        if (packed)
            at = i ? 2 * i - 1 - swapped : swapped;
        else if (!planar && i)
            at = (i == 2) ^ swapped;
        samples[i] = (struct rf_samples){
            .first = (uint8_t *)(uintptr_t)plane[p] + at,
            .step = packed         ? (i ? 4 : 2)
                    : planar || !i ? 1
                                   : 2,
            .stride = stride[p],
        };
    }
}

static void copy_row(uint8_t *to, int to_step, const uint8_t *from, int from_step,
                     int n)
{
    if (to_step == 1 && from_step == 1) {
        memcpy(to, from, (size_t)n);
        return;
    }
    for (int x = 0; x < n; x++)
        to[x * to_step] = from[x * from_step];
}

void rf_copy_samples(const struct rf_samples to[3], const struct rf_samples from[3],
                     int width, int height, int chroma_rows)
{
    for (int i = 0; i < 3; i++) {
        const int n = i ? (width + 1) / 2 : width, rows = i ? chroma_rows : height;

        for (int y = 0; y < rows; y++) {
            uint8_t *row = to[i].first + y * to[i].stride;
            const uint8_t *in = from[i].first + y * from[i].stride;

            copy_row(row, to[i].step, in, from[i].step, n);
            /* the pixel that completes a pair */
            if (i == 0 && to[0].step == 2 && width % 2)
                row[2 * n] = from[0].step == 2 ? in[2 * n] : in[n - 1];
        }
    }
}

bool rf_same_samples(uint32_t format, uint32_t other)
{
    const bool half = format == REFOCUS_FRAME_NV12 || format == REFOCUS_FRAME_NV21 ||
                      format == REFOCUS_FRAME_YUV420;
    const bool other_half = other == REFOCUS_FRAME_NV12 ||
                            other == REFOCUS_FRAME_NV21 ||
                            other == REFOCUS_FRAME_YUV420;

    if (half || other_half)
        return half && other_half;
    return (format == REFOCUS_FRAME_YUYV || format == REFOCUS_FRAME_UYVY) &&
           (other == REFOCUS_FRAME_YUYV || other == REFOCUS_FRAME_UYVY);
}
