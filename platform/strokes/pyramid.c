/* pyramid.c: the photo at smaller and smaller sizes, each pixel the mean of four. */
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <refocus/status.h>
#include "pyramid.h"

/* Differences are halved to fit: b - y lies within -223 and 223. */
static struct rf_colour colour_of(int r, int g, int b)
{
    const int y = (2 * r + 5 * g + b + 4) >> 3;
    const struct rf_colour colour = {(uint8_t)y, (uint8_t)((b - y + 256) >> 1),
                                     (uint8_t)((r - y + 256) >> 1), 0};

    return colour;
}

void rf_pyramid_row(const struct rf_pyramid *pyramid, int level, int32_t x, int32_t y,
                    int32_t count, struct rf_colour *row)
{
    const struct refocus_image *const photo = &pyramid->photo;
    const int bytes = refocus_format_bytes(photo->format);
    const bool blue_first =
        photo->format == REFOCUS_FORMAT_BGR8 || photo->format == REFOCUS_FORMAT_BGRA8;
    const int red = blue_first ? 2 : 0, blue = blue_first ? 0 : 2;
    const uint8_t *p;

    if (level > 0) {
        memcpy(row, pyramid->level[level] + (size_t)y * (size_t)pyramid->width[level] + x,
               (size_t)count * sizeof *row);
        return;
    }
    p = photo->plane[0] + y * photo->stride[0] + (ptrdiff_t)x * bytes;
    for (int32_t i = 0; i < count; i++, p += bytes)
        row[i] = colour_of(p[red], p[1], p[blue]);
}

/* A row of means of two rows, the same one twice at the lower border. */
static void halve_row(struct rf_colour *out, const struct rf_colour *a, const struct rf_colour *b,
                      int32_t width)
{
    for (int32_t x = 0; 2 * x < width; x++) {
        const int32_t l = 2 * x, r = 2 * x + 1 < width ? 2 * x + 1 : l;

        out[x].y = (uint8_t)((a[l].y + a[r].y + b[l].y + b[r].y + 2) >> 2);
        out[x].u = (uint8_t)((a[l].u + a[r].u + b[l].u + b[r].u + 2) >> 2);
        out[x].v = (uint8_t)((a[l].v + a[r].v + b[l].v + b[r].v + 2) >> 2);
        out[x].unused = 0;
    }
}

int rf_pyramid_create(struct rf_pyramid *pyramid, const struct refocus_image *photo)
{
    struct rf_colour *rows;

    memset(pyramid, 0, sizeof *pyramid);
    pyramid->photo = *photo;
    pyramid->width[0] = photo->width;
    pyramid->height[0] = photo->height;
    pyramid->levels = 1;
    rows = malloc(2 * (size_t)photo->width * sizeof *rows);
    if (!rows)
        return REFOCUS_ERR_MEMORY;
    for (int k = 1; k < RF_LEVELS; k++) {
        const int32_t w = pyramid->width[k - 1], h = pyramid->height[k - 1];
        const int32_t half = (w + 1) / 2, rest = (h + 1) / 2;
        const uint64_t bytes = (uint64_t)half * (uint64_t)rest * sizeof *rows;

        if (w == 1 && h == 1)
            break;
        pyramid->level[k] = bytes <= SIZE_MAX ? malloc((size_t)bytes) : NULL;
        if (!pyramid->level[k]) {
            free(rows);
            rf_pyramid_free(pyramid);
            return REFOCUS_ERR_MEMORY;
        }
        for (int32_t y = 0; y < rest; y++) {
            rf_pyramid_row(pyramid, k - 1, 0, 2 * y, w, rows);
            rf_pyramid_row(pyramid, k - 1, 0, 2 * y + 1 < h ? 2 * y + 1 : 2 * y, w, rows + w);
            halve_row(pyramid->level[k] + (size_t)y * (size_t)half, rows, rows + w, w);
        }
        pyramid->width[k] = half;
        pyramid->height[k] = rest;
        pyramid->levels = k + 1;
    }
    free(rows);
    return REFOCUS_OK;
}

void rf_pyramid_free(struct rf_pyramid *pyramid)
{
    for (int k = 0; k < RF_LEVELS; k++)
        free(pyramid->level[k]);
    memset(pyramid, 0, sizeof *pyramid);
}
