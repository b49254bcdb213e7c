/* moved.c: shows how the edges of a depth map were moved. */
#include "views/moved.h"

#include <math.h>
#include <stddef.h>
#include "views/peaking.h"

enum { CODE = 257 }; /* one of 255 */

static double sample(const struct refocus_disparity *map, int x, int y)
{
    const uint8_t *row = (const uint8_t *)map->samples + y * map->stride;

    return map->bits == 16 ? ((const uint16_t *)(const void *)row)[x] : row[x] * CODE;
}

static double limited(double at, int count)
{
    return fmin(fmax(at, 0), count - 1);
}

/* The map between its samples, at a pixel of a picture of this size. */
static double interpolated(const struct refocus_disparity *map, int x, int y, int width, int height)
{
    const double across = limited((x + 0.5) * map->width / width - 0.5, map->width);
    const double down = limited((y + 0.5) * map->height / height - 0.5, map->height);
    const int x0 = (int)across, y0 = (int)down;
    const int x1 = x0 + 1 < map->width ? x0 + 1 : x0, y1 = y0 + 1 < map->height ? y0 + 1 : y0;
    const double u = across - x0, v = down - y0;

    return (1 - v) * ((1 - u) * sample(map, x0, y0) + u * sample(map, x1, y0)) +
           v * ((1 - u) * sample(map, x0, y1) + u * sample(map, x1, y1));
}

void moved_draw(const struct refocus_image *photo, const uint16_t *disparity,
                const struct refocus_disparity *given, const struct refocus_image *out)
{
    static const int nearer[3] = {255, 140, 0}, farther[3] = {40, 120, 255};

    for (int y = 0; y < photo->height; y++) {
        const uint8_t *row = photo->plane[0] + y * photo->stride[0];
        uint8_t *to = out->plane[0] + y * out->stride[0];

        for (int x = 0; x < photo->width; x++, disparity++) {
            const double grey = peaking_luma(row + 3 * x);
            const double by =
                given ? *disparity - interpolated(given, x, y, photo->width, photo->height) : 0;
            /* A third for one code, all of it from a tenth of the range on. */
            const double part = fabs(by) < CODE ? 0 : fmin(1, 0.33 + fabs(by) / 9830);
            const int *colour = by > 0 ? nearer : farther;

            for (int c = 0; c < 3; c++)
                to[3 * x + c] = (uint8_t)lround(grey + part * (colour[c] - grey));
        }
    }
}
