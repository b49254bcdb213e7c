/* yuv.c: converts pictures of R, G, B to formats of Y, U, V and back. */
#include "yuv.h"

#include <math.h>

struct colour {
    double kr, kb, black, luma, chroma; /* codes of black, of black to white, of 1 of U and V */
};

static struct colour colour_of(const struct refocus_image *yuv)
{
    const int hd = yuv->matrix == REFOCUS_MATRIX_BT709;
    const int full = yuv->range == REFOCUS_RANGE_FULL;

    return (struct colour){hd ? 0.2126 : 0.299, hd ? 0.0722 : 0.114, full ? 0 : 16,
                           full ? 255 : 219, full ? 255 : 224};
}

static uint8_t *sample(const struct refocus_image *p, int i, int x, int y)
{
    const int cx = x / 2, cy = p->format == REFOCUS_FORMAT_YUYV ? y : y / 2;

    switch (p->format) {
    case REFOCUS_FORMAT_YUYV:
        return p->plane[0] + y * p->stride[0] + (i ? 4 * cx + 2 * i - 1 : 2 * x);
    case REFOCUS_FORMAT_I420:
        return i ? p->plane[i] + cy * p->stride[i] + cx : p->plane[0] + y * p->stride[0] + x;
    case REFOCUS_FORMAT_NV21:
        i = i ? 3 - i : 0;
    }
    return i ? p->plane[1] + cy * p->stride[1] + 2 * cx + i - 1
             : p->plane[0] + y * p->stride[0] + x;
}

static uint8_t code(double v)
{
    return (uint8_t)(v < 0 ? 0 : v > 255 ? 255 : v + 0.5);
}

/* Y, U, V of a pixel: 0..1 and -0.5..0.5. */
static void split(const struct colour *c, const uint8_t *rgb, double yuv[3])
{
    const double r = rgb[0] / 255.0, g = rgb[1] / 255.0, b = rgb[2] / 255.0;

    yuv[0] = c->kr * r + (1 - c->kr - c->kb) * g + c->kb * b;
    yuv[1] = (b - yuv[0]) / (2 * (1 - c->kb));
    yuv[2] = (r - yuv[0]) / (2 * (1 - c->kr));
}

void yuv_from_rgb(const struct refocus_image *rgb, const struct refocus_image *yuv)
{
    const int rows = yuv->format == REFOCUS_FORMAT_YUYV ? 1 : 2;
    const struct colour c = colour_of(yuv);

    for (int y = 0; y < yuv->height; y += rows) {
        for (int x = 0; x < yuv->width; x += 2) {
            double sum[3] = {0, 0, 0}, one[3];
            int count = 0;

            for (int j = y; j < y + rows && j < yuv->height; j++) {
                for (int i = x; i < x + 2 && i < yuv->width; i++) {
                    split(&c, rgb->plane[0] + j * rgb->stride[0] + 3 * i, one);
                    *sample(yuv, 0, i, j) = code(c.black + c.luma * one[0]);
                    for (int k = 0; k < 3; k++)
                        sum[k] += one[k];
                    count++;
                }
            }
            for (int k = 1; k < 3; k++)
                *sample(yuv, k, x, y) = code(128 + c.chroma * sum[k] / count);
        }
    }
}

void yuv_to_rgb(const struct refocus_image *yuv, const struct refocus_image *rgb)
{
    const struct colour c = colour_of(yuv);

    for (int y = 0; y < yuv->height; y++) {
        for (int x = 0; x < yuv->width; x++) {
            uint8_t *out = rgb->plane[0] + y * rgb->stride[0] + 3 * x;
            const double luma = (*sample(yuv, 0, x, y) - c.black) / c.luma;
            const double b = luma + 2 * (1 - c.kb) * (*sample(yuv, 1, x, y) - 128) / c.chroma;
            const double r = luma + 2 * (1 - c.kr) * (*sample(yuv, 2, x, y) - 128) / c.chroma;
            const double g = (luma - c.kr * r - c.kb * b) / (1 - c.kr - c.kb);

            out[0] = code(255 * r);
            out[1] = code(255 * g);
            out[2] = code(255 * b);
        }
    }
}
