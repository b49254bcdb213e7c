/* light_pyramid.c: makes the levels of a pyramid of means. */
#include "highlights/light_pyramid.h"

#include <stddef.h>
#include <string.h>

#include "support/compare.h"

void rf_pyramid_halve(const float *fine, int width, int height, float *out)
{
    const int across = (width + 1) / 2, down = (height + 1) / 2;

    for (int y = 0; y < down; y++) {
        const float *a = fine + (ptrdiff_t)(2 * y) * width;
        const float *b = fine + (ptrdiff_t)rf_smaller(2 * y + 1, height - 1) * width;

        for (int x = 0; x < across; x++) {
            const int x1 = rf_smaller(2 * x + 1, width - 1);

            out[(ptrdiff_t)y * across + x] = (a[2 * x] + a[x1] + b[2 * x] + b[x1]) * 0.25f;
        }
    }
}

/* The mean beside the one that value i of the finer level lies in, on its own side. */
static int beside(int i, int means)
{
    return rf_larger(rf_smaller(i / 2 + (i % 2 ? 1 : -1), means - 1), 0);
}

void rf_pyramid_add_doubled(const float *next, float part, int width, int height, float *fine)
{
    const int across = (width + 1) / 2, down = (height + 1) / 2;

    for (int y = 0; y < height; y++) {
        const float *a = next + (ptrdiff_t)(y / 2) * across;
        const float *b = next + (ptrdiff_t)beside(y, down) * across;

        for (int x = 0; x < width; x++) {
            const int x0 = x / 2, x1 = beside(x, across);
            const float upper = 3 * a[x0] + a[x1], lower = 3 * b[x0] + b[x1];

            fine[(ptrdiff_t)y * width + x] += part * (3 * upper + lower) * (1.0f / 16);
        }
    }
}

void rf_pyramid_smooth(float *at, int width, int height)
{
    float above[RF_PYRAMID_SIDE], own[RF_PYRAMID_SIDE];

    for (int y = 0; y < height; y++) {
        float *row = at + (ptrdiff_t)y * width, before = row[0];

        for (int x = 0; x < width; x++) {
            const float v = row[x], after = row[rf_smaller(x + 1, width - 1)];

            row[x] = (before + 2 * v + after) * 0.25f;
            before = v;
        }
    }
    memcpy(above, at, (size_t)width * sizeof *at);
    for (int y = 0; y < height; y++) {
        float *row = at + (ptrdiff_t)y * width;
        const float *below = at + (ptrdiff_t)rf_smaller(y + 1, height - 1) * width;

        memcpy(own, row, (size_t)width * sizeof *at);
        for (int x = 0; x < width; x++)
            row[x] = (above[x] + 2 * own[x] + below[x]) * 0.25f;
        memcpy(above, own, (size_t)width * sizeof *at);
    }
}
