/* sharpness.c: how sharp each part of a frame of a focus stack is, and its small pictures. */
#include "focus_stack/focus_stack.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void load(struct refocus_stack *s, const struct rf_stack_frame *frame)
{
    const size_t pixels = (size_t)s->width * (size_t)s->height;
    const uint8_t *restrict rgb = frame->rgb;
    uint8_t *restrict luma = s->luma;

    for (size_t i = 0; i < pixels; i++) {
        const int r = rgb[3 * i], g = rgb[3 * i + 1], b = rgb[3 * i + 2];

        luma[i] = (uint8_t)((5 * r + 9 * g + 2 * b + 8) >> 4);
    }
}

/* Luminance by binomial weights over 3 x 3 pixels, Q4. */
static void smooth(struct refocus_stack *s)
{
    const int w = s->width;

    for (int y = 0; y < s->height; y++) {
        const uint8_t *restrict at = s->luma + (size_t)y * (size_t)w;
        const uint8_t *restrict up = y ? at - w : at;
        const uint8_t *restrict down = y + 1 < s->height ? at + w : at;
        uint16_t *restrict out = s->smooth + (size_t)y * (size_t)w;
        uint16_t *restrict sum = s->moved; /* at least a row, and unused here */

        for (int x = 0; x < w; x++)
            sum[x] = (uint16_t)(up[x] + 2 * at[x] + down[x]);
        for (int x = 1; x < w - 1; x++)
            out[x] = (uint16_t)(sum[x - 1] + 2 * sum[x] + sum[x + 1]);
        out[0] = (uint16_t)(3 * sum[0] + sum[1]);
        out[w - 1] = (uint16_t)(3 * sum[w - 1] + sum[w - 2]);
    }
}

static int difference(int before, int middle, int after)
{
    return abs(2 * middle - before - after);
}

/* Sums of second differences of a row: over one pixel of the luminance, over two of the smooth
 * one. At most 2 (16 (2 x 255) + 2 x 16 x 255) = 32640. */
static void differences(const struct refocus_stack *s, uint16_t *restrict out, int y)
{
    const int w = s->width, h = s->height;
    const uint8_t *fine[3];
    const uint16_t *coarse[3];

    for (int i = -1; i <= 1; i++) {
        fine[i + 1] = s->luma + (size_t)rf_stack_clamp(y + i, h - 1) * (size_t)w;
        coarse[i + 1] = s->smooth + (size_t)rf_stack_clamp(y + 2 * i, h - 1) * (size_t)w;
    }
    for (int x = 0; x < w; x++) {
        const int l = x ? x - 1 : x, r = x + 1 < w ? x + 1 : x;
        const int ll = x > 1 ? x - 2 : 0, rr = x + 2 < w ? x + 2 : w - 1;

        out[x] = (uint16_t)(16 * difference(fine[1][l], fine[1][x], fine[1][r]) +
                            16 * difference(fine[0][x], fine[1][x], fine[2][x]) +
                            difference(coarse[1][ll], coarse[1][x], coarse[1][rr]) +
                            difference(coarse[0][x], coarse[1][x], coarse[2][x]));
    }
}

/* Sharpness of a row of samples: means over their pixels. */
static void reduce(struct refocus_stack *s, struct rf_stack_frame *frame, int row)
{
    const int k = s->reduced;
    uint16_t *restrict line = s->moved;
    uint32_t *restrict sum = s->column;
    uint16_t *restrict out = frame->sharpness + (size_t)row * (size_t)s->columns;
    const int below = (row + 1) * k < s->height ? (row + 1) * k : s->height;

    memset(sum, 0, (size_t)s->columns * sizeof *sum);
    for (int y = row * k; y < below; y++) {
        differences(s, line, y);
        for (int x = 0; x < s->width; x++)
            sum[x / k] += line[x];
    }
    for (int x = 0; x < s->columns; x++) {
        const int wide = (x + 1) * k < s->width ? k : s->width - x * k;

        out[x] = (uint16_t)(sum[x] / (uint32_t)(wide * (below - row * k)));
    }
}

/* Weights 1 4 6 4 1 along a row of samples; beyond its ends lies the last one. */
static void across(uint32_t *restrict out, const uint32_t *restrict in, int n)
{
    for (int x = 0; x < n; x++) {
        const uint32_t beside = in[x > 0 ? x - 1 : 0] + in[x + 1 < n ? x + 1 : n - 1];
        const uint32_t far = in[x > 1 ? x - 2 : 0] + in[x + 2 < n ? x + 2 : n - 1];

        out[x] = (far + 4 * beside + 6 * in[x] + 8) >> 4;
    }
}

/* Likewise down the columns, row by row. */
static void down(uint32_t *restrict out, const uint32_t *restrict in, int width, int rows)
{
    const size_t w = (size_t)width;

    for (int y = 0; y < rows; y++) {
        const uint32_t *restrict r0 = in + (size_t)rf_stack_clamp(y - 2, rows - 1) * w;
        const uint32_t *restrict r1 = in + (size_t)rf_stack_clamp(y - 1, rows - 1) * w;
        const uint32_t *restrict r2 = in + (size_t)y * w;
        const uint32_t *restrict r3 = in + (size_t)rf_stack_clamp(y + 1, rows - 1) * w;
        const uint32_t *restrict r4 = in + (size_t)rf_stack_clamp(y + 2, rows - 1) * w;
        uint32_t *restrict to = out + (size_t)y * w;

        for (size_t x = 0; x < w; x++)
            to[x] = (r0[x] + r4[x] + 4 * (r1[x] + r3[x]) + 6 * r2[x] + 8) >> 4;
    }
}

/* The root of the mean square of sharpness around each sample, by a Gaussian of sqrt(2) samples: a
 * strong edge then outweighs the weak ones that its blur makes beside it. Squares of Q2 are below
 * 2^24, so that 16 of them fit 32 bits and each is exact in single precision. */
static void gather(struct refocus_stack *s, struct rf_stack_frame *frame)
{
    const size_t w = (size_t)s->columns, samples = w * (size_t)s->rows;
    uint32_t *restrict a = (uint32_t *)(void *)s->sum, *restrict b = a + samples;
    uint16_t *restrict sharpness = frame->sharpness;

    for (size_t i = 0; i < samples; i++) {
        const uint32_t v = sharpness[i] >> 2;

        a[i] = v * v >> 2;
    }
    for (int i = 0; i < 2; i++) {
        for (int y = 0; y < s->rows; y++)
            across(b + (size_t)y * w, a + (size_t)y * w, s->columns);
        down(a, b, s->columns, s->rows);
    }
    for (size_t i = 0; i < samples; i++)
        sharpness[i] = (uint16_t)(8 * sqrtf((float)a[i]));
}

/* Means of the smooth luminance over squares, then of those over 2 x 2. */
static void make_small(struct refocus_stack *s, struct rf_stack_frame *frame)
{
    int k = s->small_by, w = s->width / k, h = s->height / k;

    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            uint32_t sum = 0;

            for (int v = 0; v < k; v++)
                for (int u = 0; u < k; u++)
                    sum += s->smooth[(size_t)(y * k + v) * (size_t)s->width + (size_t)(x * k + u)];
            frame->small[0][(size_t)y * (size_t)w + (size_t)x] =
                (uint16_t)(sum / (uint32_t)(k * k));
        }
    for (int i = 1; i < RF_STACK_LEVELS; i++) {
        const uint16_t *in = frame->small[i - 1];
        const size_t wide = (size_t)w;

        w /= 2;
        h /= 2;
        for (int y = 0; y < h; y++)
            for (int x = 0; x < w; x++) {
                const uint16_t *p = in + (size_t)(2 * y) * wide + (size_t)(2 * x);

                frame->small[i][(size_t)y * (size_t)w + (size_t)x] =
                    (uint16_t)((p[0] + p[1] + p[wide] + p[wide + 1] + 2) >> 2);
            }
    }
}

void rf_stack_measure(struct refocus_stack *s, struct rf_stack_frame *frame)
{
    load(s, frame);
    smooth(s);
    for (int row = 0; row < s->rows; row++)
        reduce(s, frame, row);
    gather(s, frame);
    make_small(s, frame);
    rf_stack_measure_colour(s, frame);
}
