/* samples.c: samples of Y, U and V are copied from one order in memory to another. */
#include "samples.h"
#include <string.h>
#include "layout.h"

uint32_t rf_frame_format_of(uint32_t image_format)
{
    switch (image_format) {
    case REFOCUS_FORMAT_NV12:
        return REFOCUS_FRAME_NV12;
    case REFOCUS_FORMAT_NV21:
        return REFOCUS_FRAME_NV21;
    case REFOCUS_FORMAT_I420:
        return REFOCUS_FRAME_YUV420;
    case REFOCUS_FORMAT_YUYV:
        return REFOCUS_FRAME_YUYV;
    default:
        return REFOCUS_FRAME_ANY;
    }
}

void rf_samples_of(struct rf_samples samples[3], uint32_t format, const uint8_t *const plane[3],
                   const ptrdiff_t stride[3])
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

static void copy_row(uint8_t *to, int to_step, const uint8_t *from, int from_step, int n)
{
    if (to_step == 1 && from_step == 1) {
        memcpy(to, from, (size_t)n);
        return;
    }
    for (int x = 0; x < n; x++)
        to[x * to_step] = from[x * from_step];
}

/* The mean of two rows, half up. */
static void mix_rows(uint8_t *to, int to_step, const uint8_t *a, const uint8_t *b, int step, int n)
{
    for (int x = 0; x < n; x++)
        to[x * to_step] = (uint8_t)((a[x * step] + b[x * step] + 1) / 2);
}

static void copy_luma(const struct rf_samples *to, const struct rf_samples *from, int width,
                      int height)
{
    for (int y = 0; y < height; y++) {
        uint8_t *row = to->first + y * to->stride;
        const uint8_t *in = from->first + y * from->stride;

        copy_row(row, to->step, in, from->step, width);
        if (to->step == 2 && width % 2) /* the pixel that completes a pair */
            row[2 * width] = from->step == 2 ? in[2 * width] : in[width - 1];
    }
}

static void copy_chroma(const struct rf_samples *to, int to_rows, const struct rf_samples *from,
                        int from_rows, int n)
{
    for (int y = 0; y < to_rows; y++) {
        const int first = to_rows < from_rows ? 2 * y : to_rows > from_rows ? y / 2 : y;
        const int second = to_rows < from_rows && first + 1 < from_rows ? first + 1 : first;
        uint8_t *row = to->first + y * to->stride;
        const uint8_t *in = from->first + first * from->stride;

        if (second > first)
            mix_rows(row, to->step, in, in + from->stride, from->step, n);
        else
            copy_row(row, to->step, in, from->step, n);
    }
}

void rf_copy_samples(const struct rf_samples to[3], int to_rows, const struct rf_samples from[3],
                     int from_rows, int width, int height)
{
    copy_luma(&to[0], &from[0], width, height);
    for (int i = 1; i < 3; i++)
        copy_chroma(&to[i], to_rows, &from[i], from_rows, (width + 1) / 2);
}

static bool is_packed(uint32_t format)
{
    return format == REFOCUS_FRAME_YUYV || format == REFOCUS_FRAME_UYVY;
}

bool rf_has_samples(uint32_t format)
{
    return is_packed(format) || format == REFOCUS_FRAME_NV12 || format == REFOCUS_FRAME_NV21 ||
           format == REFOCUS_FRAME_YUV420;
}

bool rf_same_samples(uint32_t format, uint32_t other)
{
    return rf_has_samples(format) && rf_has_samples(other) && is_packed(format) == is_packed(other);
}

int rf_rows_of_chroma(uint32_t format, int height)
{
    return is_packed(format) ? height : (height + 1) / 2;
}

static void copy_planes(const struct refocus_image *image, const struct refocus_frame *frame)
{
    for (int i = 0; i < rf_format_planes(frame->format); i++)
        for (int y = 0; y < rf_plane_rows(frame->format, i, image->height); y++)
            memcpy((uint8_t *)(uintptr_t)frame->plane[i] + y * frame->stride[i],
                   image->plane[i] + y * image->stride[i],
                   (size_t)rf_plane_row(frame->format, i, image->width));
}

void rf_rearrange(const struct refocus_image *image, const struct refocus_frame *frame,
                  int chroma_rows)
{
    const uint32_t format = rf_frame_format_of(image->format);
    const uint8_t *const plane[3] = {image->plane[0], image->plane[1], image->plane[2]};
    const int rows = rf_rows_of_chroma(format, image->height);
    struct rf_samples from[3], to[3];

    if (format == frame->format && chroma_rows == rows) {
        copy_planes(image, frame);
        return;
    }
    rf_samples_of(from, format, plane, image->stride);
    rf_samples_of(to, frame->format, frame->plane, frame->stride);
    rf_copy_samples(to, chroma_rows, from, rows, image->width, image->height);
}
