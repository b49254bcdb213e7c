/* faults.c: spoils exact disparities in known ways. */
#include "faults.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { QUARTER = 4, REACH = 4, OFF = 3 };

static int clamp(int i, int size)
{
    return i < 0 ? 0 : i >= size ? size - 1 : i;
}

static int same(const uint16_t *exact, int width, int height, uint16_t *out)
{
    memcpy(out, exact, (size_t)width * (size_t)height * sizeof *out);
    return 0;
}

static int eight_bits(const uint16_t *exact, int width, int height, uint16_t *out)
{
    for (int i = 0; i < width * height; i++)
        out[i] = (uint16_t)((exact[i] + 128) / 257 * 257);
    return 0;
}

/* ----- softer, coarser ----- */

enum { MOST_BLUR = 36 }; /* 3 sigma of the softest */

/* Gaussian along rows, and rows become columns, so that twice is both ways. */
static void blur_rows(const double *in, int width, int height, double sigma, double *turned)
{
    const int reach = (int)ceil(3 * sigma);
    double weight[MOST_BLUR + 1];

    for (int i = 0; i <= reach; i++)
        weight[i] = exp(-i * i / (2 * sigma * sigma));
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            double sum = 0, total = 0;

            for (int i = -reach; i <= reach; i++) {
                sum += weight[abs(i)] * in[y * width + clamp(x + i, width)];
                total += weight[abs(i)];
            }
            turned[x * height + y] = sum / total;
        }
    }
}

/* Returns 0, or -1 without memory. */
static int blur(double *plane, int width, int height, double sigma)
{
    double *turned = malloc((size_t)width * (size_t)height * sizeof *turned);

    if (!turned)
        return -1;
    blur_rows(plane, width, height, sigma, turned);
    blur_rows(turned, height, width, sigma, plane);
    free(turned);
    return 0;
}

static int soften(const uint16_t *exact, int width, int height, double sigma, uint16_t *out)
{
    const size_t pixels = (size_t)width * (size_t)height;
    double *plane = calloc(pixels, sizeof *plane);
    int result;

    if (!plane)
        return -1;
    for (size_t i = 0; i < pixels; i++)
        plane[i] = exact[i];
    if (!(result = blur(plane, width, height, sigma)))
        for (size_t i = 0; i < pixels; i++)
            out[i] = (uint16_t)lrint(plane[i]);
    free(plane);
    return result;
}

static int soft2(const uint16_t *exact, int width, int height, uint16_t *out)
{
    return soften(exact, width, height, 2, out);
}

static int soft4(const uint16_t *exact, int width, int height, uint16_t *out)
{
    return soften(exact, width, height, 4, out);
}

static int quarter(const uint16_t *exact, int width, int height, uint16_t *out)
{
    for (int y = 0; y < height / QUARTER; y++) {
        for (int x = 0; x < width / QUARTER; x++) {
            int sum = QUARTER * QUARTER / 2;

            for (int i = 0; i < QUARTER * QUARTER; i++)
                sum += exact[(y * QUARTER + i / QUARTER) * width + x * QUARTER + i % QUARTER];
            *out++ = (uint16_t)(sum / (QUARTER * QUARTER));
        }
    }
    return 0;
}

/* ----- near surfaces larger and smaller ----- */

/* The nearest of a disc, or the farthest. */
static void filter_disc(const uint16_t *exact, int width, int height, bool nearest, uint16_t *out)
{
    for (int p = 0; p < width * height; p++) {
        uint16_t found = exact[p];

        for (int v = -REACH; v <= REACH; v++) {
            for (int u = -REACH; u <= REACH; u++) {
                const uint16_t d =
                    exact[clamp(p / width + v, height) * width + clamp(p % width + u, width)];

                if (u * u + v * v <= REACH * REACH && (nearest ? d > found : d < found))
                    found = d;
            }
        }
        out[p] = found;
    }
}

static int grown(const uint16_t *exact, int width, int height, uint16_t *out)
{
    filter_disc(exact, width, height, true, out);
    return 0;
}

static int shrunk(const uint16_t *exact, int width, int height, uint16_t *out)
{
    filter_disc(exact, width, height, false, out);
    return 0;
}

/* ----- beside the photo ----- */

static int shifted(const uint16_t *exact, int width, int height, uint16_t *out)
{
    for (int p = 0; p < width * height; p++)
        out[p] = exact[p / width * width + clamp(p % width - OFF, width)];
    return 0;
}

/* Smooth noise of variance 1 about 0. Returns 0, or -1 without memory. */
static int smooth_noise(double *plane, int width, int height, uint32_t seed)
{
    const int pixels = width * height;
    double mean = 0, squares = 0;

    for (int i = 0; i < pixels; i++) {
        seed = seed * 1664525u + 1013904223u;
        plane[i] = (double)(seed >> 16) - 32767.5;
    }
    if (blur(plane, width, height, 12))
        return -1;
    for (int i = 0; i < pixels; i++)
        mean += plane[i] / pixels;
    for (int i = 0; i < pixels; i++)
        squares += (plane[i] - mean) * (plane[i] - mean) / pixels;
    for (int i = 0; i < pixels; i++)
        plane[i] = (plane[i] - mean) / sqrt(squares);
    return 0;
}

/* By 2 pixels, as the root of the mean square of what both directions make together. */
static int displaced(const uint16_t *exact, int width, int height, uint16_t *out)
{
    const size_t pixels = (size_t)width * (size_t)height;
    double *right = malloc(pixels * sizeof *right), *down = malloc(pixels * sizeof *down);
    int result = -1;

    if (right && down && !smooth_noise(right, width, height, 1) &&
        !smooth_noise(down, width, height, 2)) {
        for (int p = 0; p < width * height; p++) {
            const int x = p % width - (int)lrint(sqrt(2) * right[p]);
            const int y = p / width - (int)lrint(sqrt(2) * down[p]);

            out[p] = exact[clamp(y, height) * width + clamp(x, width)];
        }
        result = 0;
    }
    free(right);
    free(down);
    return result;
}

/* ----- noise ----- */

/* Noise of this standard deviation, a share of the range: a sum of twelve even ones. */
static int noise(const uint16_t *exact, int width, int height, uint16_t *out, double deviation)
{
    uint32_t seed = 3;

    for (int i = 0; i < width * height; i++) {
        double sum = -6;

        for (int k = 0; k < 12; k++) {
            seed = seed * 1664525u + 1013904223u;
            sum += (seed >> 8) / 16777216.0;
        }
        out[i] = (uint16_t)lrint(fmin(fmax(exact[i] + 65535 * deviation * sum, 0), 65535));
    }
    return 0;
}

static int noise1(const uint16_t *exact, int width, int height, uint16_t *out)
{
    return noise(exact, width, height, out, 0.01);
}

static int noise2(const uint16_t *exact, int width, int height, uint16_t *out)
{
    return noise(exact, width, height, out, 0.02);
}

static int noise5(const uint16_t *exact, int width, int height, uint16_t *out)
{
    return noise(exact, width, height, out, 0.05);
}

const struct fault faults[] = {
    {"exact", same, 1},
    {"8 bits", eight_bits, 1},
    {"soft, sigma 2", soft2, 1},
    {"soft, sigma 4", soft4, 1},
    {"quarter size", quarter, QUARTER},
    {"grown by 4 px", grown, 1},
    {"shrunk by 4 px", shrunk, 1},
    {"shifted by 3 px", shifted, 1},
    {"displaced by 2 px", displaced, 1},
    {"noise of 1 %", noise1, 1},
    {"noise of 2 %", noise2, 1},
    {"noise of 5 %", noise5, 1},
    {NULL, NULL, 0},
};
