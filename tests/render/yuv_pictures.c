/* yuv_pictures.c: makes and compares photos of Y, U and V for the render tests. */
#include "yuv_pictures.h"

enum { MARGIN = 64, FILL = 0xaa };

const uint32_t yuv_formats[4] = {REFOCUS_FORMAT_NV12, REFOCUS_FORMAT_NV21, REFOCUS_FORMAT_I420,
                                 REFOCUS_FORMAT_YUYV};

struct yuv_picture yuv_make(uint32_t format, int width, int height, int gap)
{
    struct yuv_picture p = {.image = refocus_image_planar(format, NULL, width, height)};
    size_t at = MARGIN;

    p.bytes = MARGIN;
    for (int i = 0; i < refocus_format_planes(format); i++) {
        p.image.stride[i] += gap;
        p.bytes +=
            (size_t)p.image.stride[i] * (size_t)refocus_plane_rows(format, i, height) + MARGIN;
    }
    p.memory = malloc(p.bytes);
    assert_non_null(p.memory);
    memset(p.memory, FILL, p.bytes);
    for (int i = 0; i < refocus_format_planes(format); i++) {
        p.image.plane[i] = p.memory + at;
        at += (size_t)p.image.stride[i] * (size_t)refocus_plane_rows(format, i, height) + MARGIN;
    }
    return p;
}

void yuv_free(struct yuv_picture *p)
{
    free(p->memory);
}

uint8_t *yuv_sample(const struct refocus_image *p, int i, int x, int y)
{
    switch (p->format) {
    case REFOCUS_FORMAT_YUYV:
        return p->plane[0] + y * p->stride[0] + (i ? x / 2 * 4 + 2 * i - 1 : 2 * x);
    case REFOCUS_FORMAT_I420:
        return i ? p->plane[i] + y / 2 * p->stride[i] + x / 2 : p->plane[0] + y * p->stride[0] + x;
    case REFOCUS_FORMAT_NV21:
        i = i ? 3 - i : 0;
        break;
    }
    return i ? p->plane[1] + y / 2 * p->stride[1] + x / 2 * 2 + i - 1
             : p->plane[0] + y * p->stride[0] + x;
}

static uint8_t rounded(double v)
{
    return (uint8_t)(v < 0 ? 0 : v > 255 ? 255 : v + 0.5);
}

void yuv_from_picture(const struct yuv_picture *to, const struct picture *from)
{
    static const double rows[3][3] = {
        {65.481, 128.553, 24.966}, {-37.797, -74.203, 112.0}, {112.0, -93.786, -18.214}};
    const int w = from->width, h = from->height;
    const int tall = to->image.format == REFOCUS_FORMAT_YUYV ? 1 : 2;

    for (int y = 0; y < h; y++) {
        for (int x = 0; x < w; x++) {
            for (int i = 0; i < 3; i++) {
                const int x0 = i ? x / 2 * 2 : x, y0 = i ? y / tall * tall : y;
                double sum = 0;
                int n = 0;

                for (int q = y0; q < y0 + (i ? tall : 1) && q < h; q++)
                    for (int p = x0; p < x0 + (i ? 2 : 1) && p < w; p++, n++)
                        for (int c = 0; c < 3; c++)
                            sum += rows[i][c] * from->rgb[3 * (q * w + p) + c] / 255;
                *yuv_sample(&to->image, i, x, y) = rounded((i ? 128 : 16) + sum / n);
            }
        }
    }
}

void yuv_noise(const struct yuv_picture *p, uint32_t seed)
{
    for (int y = 0; y < p->image.height; y++)
        for (int x = 0; x < p->image.width; x++)
            for (int i = 0; i < 3; i++)
                *yuv_sample(&p->image, i, x, y) = (uint8_t)(noise(&seed) >> 7);
}

void assert_same_yuv(const struct refocus_image *a, const struct refocus_image *b, const char *what)
{
    for (int y = 0; y < a->height; y++)
        for (int x = 0; x < a->width; x++)
            for (int i = 0; i < 3; i++) {
                const int is = *yuv_sample(a, i, x, y), should = *yuv_sample(b, i, x, y);

                if (is != should)
                    fail_msg("%s: %c of (%d, %d) is %d, should be %d", what, "YUV"[i], x, y, is,
                             should);
            }
}

void assert_margins(const struct yuv_picture *p, const char *what)
{
    uint8_t *seen = calloc(p->bytes, 1);

    assert_non_null(seen);
    for (int y = 0; y < p->image.height; y++)
        for (int x = 0; x < p->image.width; x++)
            for (int i = 0; i < 3; i++)
                seen[yuv_sample(&p->image, i, x, y) - p->memory] = 1;
    if (p->image.format == REFOCUS_FORMAT_YUYV && p->image.width % 2)
        for (int y = 0; y < p->image.height; y++) /* written like the one before */
            seen[yuv_sample(&p->image, 0, p->image.width - 1, y) + 2 - p->memory] = 1;
    for (size_t i = 0; i < p->bytes; i++)
        if (!seen[i] && p->memory[i] != FILL)
            fail_msg("%s: byte %ld beside the picture was written", what, (long)i);
    free(seen);
}
