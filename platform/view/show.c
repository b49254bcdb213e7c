/* show.c: the pixels of the window are sampled from a picture of the photo. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "show.h"

enum { BACKGROUND = 0x202020, ALPHA = -16777216 /* 0xff000000 */ };

static int clamp(double value, int least, int most)
{
    return value <= least ? least : value >= most ? most : (int)value;
}

/* Pixel of the photo under the middle of a window pixel. */
static double photo_place(double corner, double scale, int pixel)
{
    return corner + (pixel + 0.5) / scale - 0.5;
}

static bool is_outside(double place, int size)
{
    return !(place >= -0.5 && place < size - 0.5);
}

/* The pixels that each column of the window stands for, worked out once. */
struct columns {
    uint32_t *sums;    /* 3 for each column */
    int32_t *edge;     /* the source pixel that each begins with, and that after the last */
    int32_t *left;     /* the source pixel left of its middle, */
    int32_t *across;   /* distance to the right of it, in 1/256 */
    int32_t *nearest;  /* pixel of the photo */
    uint32_t *wide[2]; /* source rows brought to the window's width, */
    int wide_of[2];    /* numbers of these rows; even rows come first */
};

/* Pixels of the source before which column or row `pixel` of the window begins. */
static int source_edge(const struct rf_show *show, double corner, double scale, int pixel, int size)
{
    return clamp((corner + pixel / scale) / show->reduction, 0, size);
}

static void find_columns(const struct rf_show *show, const struct rf_view_state *state,
                         struct columns *columns, uint32_t *scratch)
{
    const int w = state->width;

    columns->sums = scratch;
    columns->edge = (int32_t *)scratch + 3 * w;
    columns->left = columns->edge + w + 1;
    columns->across = columns->left + w;
    columns->nearest = columns->across + w;
    columns->wide[0] = scratch + 7 * w + 1;
    columns->wide[1] = columns->wide[0] + w;
    columns->wide_of[0] = columns->wide_of[1] = -1;
    for (int i = 0; i <= w; i++)
        columns->edge[i] = source_edge(show, state->x, state->scale, i, show->width);
    for (int i = 0; i < w; i++) {
        const double place = photo_place(state->x, state->scale, i);
        const double u = (place + 0.5) / show->reduction - 0.5;

        columns->left[i] = clamp(floor(u), -1, show->width - 1);
        columns->across[i] = clamp((u - columns->left[i]) * 256, 0, 255);
        columns->nearest[i] = clamp(floor(place + 0.5), 0, show->photo_width - 1);
    }
}

/* A row as means of whole source pixels, where the window is smaller. */
static void draw_mean(const struct rf_show *show, const struct rf_view_state *state, int row,
                      uint32_t *out, const struct columns *columns)
{
    const int w = state->width;
    const int32_t *const edge = columns->edge;
    uint32_t *const sums = columns->sums;
    int top = source_edge(show, state->y, state->scale, row, show->height - 1);
    int bottom = source_edge(show, state->y, state->scale, row + 1, show->height);

    bottom = bottom > top ? bottom : top + 1;
    memset(sums, 0, 3 * (size_t)w * sizeof *sums);
    for (int y = top; y < bottom; y++) {
        const uint8_t *const from = show->rgb + 3 * (size_t)y * (size_t)show->width;

        for (int i = 0; i < w; i++) {
            uint32_t r = 0, g = 0, b = 0;

            for (int x = edge[i]; x < edge[i + 1]; x++) {
                r += from[3 * x];
                g += from[3 * x + 1];
                b += from[3 * x + 2];
            }
            sums[3 * i] += r;
            sums[3 * i + 1] += g;
            sums[3 * i + 2] += b;
        }
    }
    for (int i = 0; i < w; i++) {
        const int wide = edge[i + 1] > edge[i] ? edge[i + 1] - edge[i] : 1;
        const uint32_t n = (uint32_t)((bottom - top) * wide);

        out[i] = (sums[3 * i] / n) << 16 | (sums[3 * i + 1] / n) << 8 | sums[3 * i + 2] / n;
    }
}

static uint32_t mix(uint32_t a, uint32_t b, uint32_t part_q8)
{
    const uint32_t rb = ((a & 0xff00ff) * (256 - part_q8) + (b & 0xff00ff) * part_q8) >> 8;
    const uint32_t g = ((a & 0x00ff00) * (256 - part_q8) + (b & 0x00ff00) * part_q8) >> 8;

    return (rb & 0xff00ff) | (g & 0x00ff00);
}

static uint32_t pixel_of(const uint8_t *p)
{
    return (uint32_t)p[0] << 16 | (uint32_t)p[1] << 8 | p[2];
}

/* A source row, between its pixels, at the window's width; kept for the next row. */
static const uint32_t *widen(const struct rf_show *show, int width, int y, struct columns *columns)
{
    const uint8_t *const from = show->rgb + 3 * (size_t)y * (size_t)show->width;
    uint32_t *const wide = columns->wide[y & 1];

    if (columns->wide_of[y & 1] == y)
        return wide;
    columns->wide_of[y & 1] = y;
    for (int i = 0; i < width; i++) {
        const int at = columns->left[i];
        const int left = 3 * (at > 0 ? at : 0);
        const int right = 3 * (at + 1 < show->width ? at + 1 : at);

        wide[i] = mix(pixel_of(from + left), pixel_of(from + right), (uint32_t)columns->across[i]);
    }
    return wide;
}

/* A row between the source's pixels, where the window is as large or larger. */
static void draw_between(const struct rf_show *show, const struct rf_view_state *state, int row,
                         uint32_t *out, struct columns *columns)
{
    const double v = (photo_place(state->y, state->scale, row) + 0.5) / show->reduction - 0.5;
    const int top = clamp(floor(v), 0, show->height - 1);
    const int bottom = clamp(floor(v) + 1, 0, show->height - 1);
    const uint32_t down = (uint32_t)clamp((v - floor(v)) * 256, 0, 255);
    const uint32_t *const a = widen(show, state->width, top, columns);
    const uint32_t *const b = widen(show, state->width, bottom, columns);

    for (int i = 0; i < state->width; i++)
        out[i] = mix(a[i], b[i], down);
}

static const uint16_t *depth_row(const struct rf_show *show, const struct rf_view_state *state,
                                 int row)
{
    const int y =
        clamp(floor(photo_place(state->y, state->scale, row) + 0.5), 0, show->photo_height - 1);

    return show->disparity + (size_t)y * (size_t)show->photo_width;
}

static void draw_depth(const struct rf_show *show, const struct rf_view_state *state, int row,
                       uint32_t *out, const struct columns *columns)
{
    const uint16_t *const from = depth_row(show, state, row);

    for (int i = 0; i < state->width; i++)
        out[i] = (uint32_t)(from[columns->nearest[i]] >> 8) * 0x010101;
}

static int luma(uint32_t pixel)
{
    return (int)(2 * (pixel >> 16 & 255) + 5 * (pixel >> 8 & 255) + (pixel & 255)) / 8;
}

/* Edges of the picture where the lens blurs by less than a pixel of the window, or of
 * the photo. below: the next row, or the same. */
static void mark_sharp(const struct rf_show *show, const struct rf_view_state *state, int row,
                       uint32_t *out, const uint32_t *below, const struct columns *columns)
{
    enum { EDGE = 20, TINT = 0x20ff40 };
    const double pixel = state->scale < 1 ? 1 / state->scale : 1;
    const double within = state->blur > 0 ? 65535 * pixel / (double)state->blur : 65535;
    const uint16_t *const from = depth_row(show, state, row);

    for (int i = 0; i + 1 < state->width; i++) {
        const int here = luma(out[i]);

        if (fabs(from[columns->nearest[i]] - 65535 * (double)show->focus) <= within &&
            (abs(luma(out[i + 1]) - here) > EDGE || abs(luma(below[i]) - here) > EDGE))
            out[i] = TINT;
    }
}

static void blank_outside(const struct rf_show *show, const struct rf_view_state *state, int row,
                          uint32_t *out)
{
    const bool all = is_outside(photo_place(state->y, state->scale, row), show->photo_height);

    for (int i = 0; i < state->width; i++) {
        if (all || is_outside(photo_place(state->x, state->scale, i), show->photo_width))
            out[i] = BACKGROUND;
        out[i] |= (uint32_t)ALPHA;
    }
}

void rf_show(const struct rf_show *show, const struct rf_view_state *state, uint32_t *pixels,
             uint32_t *scratch)
{
    const bool smaller = state->scale * show->reduction < 1;
    struct columns columns;

    find_columns(show, state, &columns, scratch);
    for (int row = 0; row < state->height; row++) {
        uint32_t *const out = pixels + (size_t)row * (size_t)state->width;

        if (state->mode == RF_VIEW_DEPTH)
            draw_depth(show, state, row, out, &columns);
        else if (smaller)
            draw_mean(show, state, row, out, &columns);
        else
            draw_between(show, state, row, out, &columns);
    }
    for (int row = 0; row < state->height; row++) {
        uint32_t *const out = pixels + (size_t)row * (size_t)state->width;

        if (state->peaking)
            mark_sharp(show, state, row, out, row + 1 < state->height ? out + state->width : out,
                       &columns);
        blank_outside(show, state, row, out);
    }
}
