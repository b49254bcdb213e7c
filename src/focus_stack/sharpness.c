/* sharpness.c: how sharp each part of a frame of a focus stack is, and its small pictures. */
#include "focus_stack/focus_stack.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct measured {
    struct refocus_stack *stack;
    struct rf_stack_frame *frame;
    uint32_t *squares, *across; /* squares of sharpness, and their sums along rows */
};

static void load_row(void *context, int y, int worker)
{
    const struct measured *m = context;
    const size_t w = (size_t)m->stack->width;
    const uint8_t *restrict rgb = m->frame->rgb + 3 * (size_t)y * w;
    uint8_t *restrict luma = m->stack->luma + (size_t)y * w;

    (void)worker;
    for (size_t x = 0; x < w; x++) {
        const int r = rgb[3 * x], g = rgb[3 * x + 1], b = rgb[3 * x + 2];

        luma[x] = (uint8_t)((5 * r + 9 * g + 2 * b + 8) >> 4);
    }
}

/* A row of a worker's own, of the photo's width. */
static uint16_t *row_of(const struct refocus_stack *s, int worker)
{
    return s->depth_row + (ptrdiff_t)worker * s->width;
}

/* Luminance by binomial weights over 3 x 3 pixels, Q4. */
static void smooth_row(void *context, int y, int worker)
{
    const struct measured *m = context;
    const struct refocus_stack *s = m->stack;
    const int w = s->width;
    const uint8_t *restrict at = s->luma + (size_t)y * (size_t)w;
    const uint8_t *restrict up = y ? at - w : at;
    const uint8_t *restrict down = y + 1 < s->height ? at + w : at;
    uint16_t *restrict out = s->smooth + (size_t)y * (size_t)w;
    uint16_t *restrict sum = row_of(s, worker);

    for (int x = 0; x < w; x++)
        sum[x] = (uint16_t)(up[x] + 2 * at[x] + down[x]);
    for (int x = 1; x < w - 1; x++)
        out[x] = (uint16_t)(sum[x - 1] + 2 * sum[x] + sum[x + 1]);
    out[0] = (uint16_t)(3 * sum[0] + sum[1]);
    out[w - 1] = (uint16_t)(3 * sum[w - 1] + sum[w - 2]);
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

/* Sharpness of a row of samples: means over their pixels. The squares of it are at most 4080^2,
 * Q2, below 2^24: 16 of them fit 32 bits, and each is exact in single precision. */
static void reduce_row(void *context, int row, int worker)
{
    const struct measured *m = context;
    const struct refocus_stack *s = m->stack;
    const int k = s->reduced, w = s->columns;
    const int below = (row + 1) * k < s->height ? (row + 1) * k : s->height;
    uint16_t *restrict line = row_of(s, worker);
    uint32_t *restrict squares = m->squares + (size_t)row * (size_t)w;

    memset(squares, 0, (size_t)w * sizeof *squares);
    for (int y = row * k; y < below; y++) {
        differences(s, line, y);
        for (int x = 0; x < s->width; x++)
            squares[x / k] += line[x];
    }
    for (int x = 0; x < w; x++) {
        const int wide = (x + 1) * k < s->width ? k : s->width - x * k;
        const uint32_t mean = squares[x] / (uint32_t)(wide * (below - row * k)) >> 2;

        squares[x] = mean * mean >> 2;
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

static void across_row(void *context, int y, int worker)
{
    const struct measured *m = context;
    const size_t w = (size_t)m->stack->columns;

    (void)worker;
    across(m->across + (size_t)y * w, m->squares + (size_t)y * w, m->stack->columns);
}

/* Likewise down the columns. */
static void down_row(void *context, int y, int worker)
{
    const struct measured *m = context;
    const size_t w = (size_t)m->stack->columns;
    const uint32_t *restrict row[5];
    uint32_t *restrict to = m->squares + (size_t)y * w;

    (void)worker;
    for (int i = 0; i < 5; i++)
        row[i] = m->across + (size_t)rf_stack_clamp(y + i - 2, m->stack->rows - 1) * w;
    for (size_t x = 0; x < w; x++)
        to[x] = (row[0][x] + row[4][x] + 4 * (row[1][x] + row[3][x]) + 6 * row[2][x] + 8) >> 4;
}

static void root_row(void *context, int y, int worker)
{
    const struct measured *m = context;
    const size_t w = (size_t)m->stack->columns;
    const uint32_t *restrict squares = m->squares + (size_t)y * w;
    uint16_t *restrict out = m->frame->sharpness + (size_t)y * w;

    (void)worker;
    for (size_t x = 0; x < w; x++)
        out[x] = (uint16_t)(8 * sqrtf((float)squares[x]));
}

/* A row of the finest small picture: means of the smooth luminance over squares. */
static void small_row(void *context, int y, int worker)
{
    const struct measured *m = context;
    const struct refocus_stack *s = m->stack;
    const int k = s->small_by, w = s->width / k;
    const uint16_t *smooth = s->smooth + (size_t)(y * k) * (size_t)s->width;
    uint16_t *out = m->frame->small[0] + (size_t)y * (size_t)w;

    (void)worker;
    for (int x = 0; x < w; x++) {
        uint32_t sum = 0;

        for (int v = 0; v < k; v++)
            for (int u = 0; u < k; u++)
                sum += smooth[(size_t)v * (size_t)s->width + (size_t)(x * k + u)];
        out[x] = (uint16_t)(sum / (uint32_t)(k * k));
    }
}

/* The others are means over 2 x 2 pixels of the last. */
static void halve(const struct refocus_stack *s, struct rf_stack_frame *frame)
{
    int w = s->width / s->small_by, h = s->height / s->small_by;

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
    const size_t samples = (size_t)s->columns * (size_t)s->rows;
    uint32_t *sum = (uint32_t *)(void *)s->sum;
    struct measured m = {s, frame, sum, sum + samples};

    rf_pool_run(s->pool, load_row, &m, s->height);
    rf_pool_run(s->pool, smooth_row, &m, s->height);
    rf_pool_run(s->pool, reduce_row, &m, s->rows);
    /* The root of the mean square of sharpness around each sample, by a Gaussian of sqrt(2)
     * samples: a strong edge then outweighs the weak ones that its blur makes beside it. */
    for (int i = 0; i < 2; i++) {
        rf_pool_run(s->pool, across_row, &m, s->rows);
        rf_pool_run(s->pool, down_row, &m, s->rows);
    }
    rf_pool_run(s->pool, root_row, &m, s->rows);
    rf_pool_run(s->pool, small_row, &m, s->height / s->small_by);
    halve(s, frame);
    rf_stack_measure_colour(s, frame);
}
