/* rgb_to_yuv.c: RGB8 pictures become frames in the formats that sinks want. */
#include "rgb_to_yuv.h"
#include <string.h>
#include "layout.h"

/* Limited range in 1/65536: 219 Kr, 219 Kg, 219 Kb and so on, of 255. */
struct weights {
    int y[3], u[3], v[3];
};
static const struct weights weights_of[] = {
    [REFOCUS_MATRIX_BT601] = {{16829, 33039, 6416}, {-9714, -19070, 28784}, {28784, -24103, -4681}},
    [REFOCUS_MATRIX_BT709] = {{11966, 40254, 4064}, {-6596, -22188, 28784}, {28784, -26145, -2639}},
};

static const struct weights *choose_weights(const struct refocus_frame *frame)
{
    return &weights_of[frame->matrix == REFOCUS_MATRIX_BT709 ? REFOCUS_MATRIX_BT709
                                                             : REFOCUS_MATRIX_BT601];
}

static uint8_t luma(const struct weights *w, const uint8_t *p)
{
    return (uint8_t)((w->y[0] * p[0] + w->y[1] * p[1] + w->y[2] * p[2] + (16 << 16) + 32768) >> 16);
}

/* U or V of sums of 2^shift pixels. */
static uint8_t chroma(const int w[3], int r, int g, int b, int shift)
{
    return (uint8_t)((w[0] * r + w[1] * g + w[2] * b + (257 << (15 + shift))) >> (16 + shift));
}

static uint8_t *plane_row(const struct refocus_frame *frame, int plane, int y)
{
    return (uint8_t *)(uintptr_t)frame->plane[plane] + y * frame->stride[plane];
}

static void encode_packed_422(const struct refocus_image *image, const struct refocus_frame *frame,
                              int y)
{
    const struct weights *const w = choose_weights(frame);
    const int first = frame->format == REFOCUS_FRAME_UYVY; /* offset of the first Y */
    const uint8_t *rgb = image->plane[0] + y * image->stride[0];
    uint8_t *out = plane_row(frame, 0, y);

    for (int x = 0; x < image->width; x += 2) {
        const uint8_t *a = rgb + 3 * x, *b = x + 1 < image->width ? a + 3 : a;
        const int red = a[0] + b[0], green = a[1] + b[1], blue = a[2] + b[2];

        out[2 * x + first] = luma(w, a);
        out[2 * x + 2 + first] = luma(w, b);
        out[2 * x + 1 - first] = chroma(w->u, red, green, blue, 1);
        out[2 * x + 3 - first] = chroma(w->v, red, green, blue, 1);
    }
}

/* Two rows of Y and one of U and V. */
static void encode_420(const struct refocus_image *image, const struct refocus_frame *frame, int y)
{
    const struct weights *const w = choose_weights(frame);
    const uint8_t *top = image->plane[0] + y * image->stride[0];
    const uint8_t *low = y + 1 < image->height ? top + image->stride[0] : top;
    const bool planar = frame->format == REFOCUS_FRAME_YUV420;
    const bool swapped = frame->format == REFOCUS_FRAME_NV21;
    const int step = planar ? 1 : 2;
    uint8_t *out[2] = {plane_row(frame, 0, y), plane_row(frame, 0, y + (low != top))};
    uint8_t *u = plane_row(frame, 1, y / 2) + swapped;
    uint8_t *v = planar ? plane_row(frame, 2, y / 2) : plane_row(frame, 1, y / 2) + !swapped;

    for (int x = 0; x < image->width; x++) {
        out[0][x] = luma(w, top + 3 * x);
        out[1][x] = luma(w, low + 3 * x);
    }
    for (int x = 0; x < image->width; x += 2) {
        const int a = 3 * x, b = x + 1 < image->width ? a + 3 : a;
        const int red = top[a] + top[b] + low[a] + low[b];
        const int green = top[a + 1] + top[b + 1] + low[a + 1] + low[b + 1];
        const int blue = top[a + 2] + top[b + 2] + low[a + 2] + low[b + 2];

        u[x / 2 * step] = chroma(w->u, red, green, blue, 2);
        v[x / 2 * step] = chroma(w->v, red, green, blue, 2);
    }
}

static void encode_rgb(const struct refocus_image *image, const struct refocus_frame *frame, int y)
{
    const bool blue = frame->format == REFOCUS_FRAME_BGR24 || frame->format == REFOCUS_FRAME_BGRX;
    const int bytes = frame->format >= REFOCUS_FRAME_RGBX ? 4 : 3;
    const uint8_t *rgb = image->plane[0] + y * image->stride[0];
    uint8_t *out = plane_row(frame, 0, y);

    if (frame->format == REFOCUS_FRAME_RGB24) {
        memcpy(out, rgb, (size_t)image->width * 3);
        return;
    }
    for (int x = 0; x < image->width; x++, out += bytes, rgb += 3) {
        out[0] = rgb[blue ? 2 : 0];
        out[1] = rgb[1];
        out[2] = rgb[blue ? 0 : 2];
        if (bytes == 4)
            out[3] = 255;
    }
}

bool rf_can_encode(uint32_t format)
{
    return format >= REFOCUS_FRAME_YUYV && format <= REFOCUS_FRAME_BGRX;
}

void rf_encode(const struct refocus_image *image, const struct refocus_frame *frame)
{
    const bool halves = rf_format_planes(frame->format) > 1;

    for (int y = 0; y < image->height; y += halves ? 2 : 1)
        if (halves)
            encode_420(image, frame, y);
        else if (frame->format <= REFOCUS_FRAME_UYVY)
            encode_packed_422(image, frame, y);
        else
            encode_rgb(image, frame, y);
}
