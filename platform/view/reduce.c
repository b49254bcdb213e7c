/* reduce.c: a photo and its depth are reduced by a whole number for quick pictures. */
#include <math.h>
#include "reduce.h"

static int least(int a, int b)
{
    return a < b ? a : b;
}

/* The sRGB curve, close enough for the eye: x^2.2 to 16 bits. */
static void make_tables(uint16_t *linear, uint8_t *stored)
{
    for (int i = 0; i < 256; i++)
        linear[i] = (uint16_t)(65535 * pow(i / 255.0, 2.2) + 0.5);
    for (int i = 0; i < 4096; i++)
        stored[i] = (uint8_t)(255 * pow((i + 0.5) / 4096, 1 / 2.2) + 0.5);
}

void rf_reduce_photo(const struct refocus_image *photo, int n, uint8_t *to)
{
    uint16_t linear[256];
    uint8_t stored[4096];

    make_tables(linear, stored);
    for (int y = 0; y < photo->height; y += n) {
        const int rows = least(n, photo->height - y);

        for (int x = 0; x < photo->width; x += n, to += 3) {
            const int columns = least(n, photo->width - x);
            uint64_t r = 0, g = 0, b = 0;

            for (int j = 0; j < rows; j++) {
                const uint8_t *p = photo->plane[0] + (y + j) * photo->stride[0] + 3 * x;

                for (int i = 0; i < columns; i++, p += 3) {
                    r += linear[p[0]];
                    g += linear[p[1]];
                    b += linear[p[2]];
                }
            }
            to[0] = stored[r / (uint64_t)(rows * columns) >> 4];
            to[1] = stored[g / (uint64_t)(rows * columns) >> 4];
            to[2] = stored[b / (uint64_t)(rows * columns) >> 4];
        }
    }
}

void rf_reduce_disparity(const uint16_t *disparity, int width, int height, int n, uint16_t *to)
{
    for (int y = 0; y < height; y += n) {
        const uint16_t *const row =
            disparity + (size_t)least(y + n / 2, height - 1) * (size_t)width;

        for (int x = 0; x < width; x += n)
            *to++ = row[least(x + n / 2, width - 1)];
    }
}
