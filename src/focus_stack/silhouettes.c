/* silhouettes.c: depth beside a nearer surface is told by the frame that is focused on that
 * surface.
 *
 * Windows of sharpness take the silhouette of a surface for part of what is around it, as far as
 * they reach. The guide that fill.c goes by does not tell: it shows what is beside the surface in
 * two focuses, sharp farther out and blurred where depth is too near, and so has an edge at the
 * wrong place. Here it becomes, as far as windows reach from the surface, the frame that is focused
 * on it: all that is behind is blurred, and the silhouette is the one sharp edge. Depth is then
 * filled once more, along columns first, by half of the votes of what is on the nearer side there,
 * as half of it may be behind. Two frames do not have one that is focused on the nearer surface.
 */
#include "focus_stack/focus_stack.h"

#include <string.h>

enum {
    REACH = 8, /* samples: that of the widest window, costs.c */
    APART = 4, /* surfaces are apart by this part of all depths */
};

static inline uint16_t larger(uint16_t a, uint16_t b)
{
    return a > b ? a : b;
}

static inline uint16_t smaller(uint16_t a, uint16_t b)
{
    return a < b ? a : b;
}

/* The larger ones of two rows, and the smaller ones of two others. */
static void extremes(uint16_t *restrict most, uint16_t *restrict least, const uint16_t *in_most,
                     const uint16_t *in_least, size_t n)
{
    for (size_t x = 0; x < n; x++) {
        most[x] = larger(most[x], in_most[x]);
        least[x] = smaller(least[x], in_least[x]);
    }
}

/* Row y: the extremes of the rows around it into `column`, then of those along the row. */
static void extremes_of_row(const struct refocus_stack *s, int y, uint16_t *column, uint16_t *out)
{
    const size_t w = (size_t)s->columns;
    uint16_t *most = column, *least = column + w;

    memcpy(most, s->depth + (size_t)y * w, w * sizeof *most);
    memcpy(least, most, w * sizeof *least);
    for (int v = y - REACH; v <= y + REACH; v++)
        if (v >= 0 && v < s->rows)
            extremes(most, least, s->depth + (size_t)v * w, s->depth + (size_t)v * w, w);
    memcpy(out, column, 2 * w * sizeof *out);
    for (size_t d = 1; d <= REACH && d < w; d++) {
        extremes(out, out + w, most + d, least + d, w - d);
        extremes(out + d, out + w + d, most, least, w - d);
    }
}

void rf_stack_silhouettes(struct refocus_stack *s)
{
    const size_t w = (size_t)s->columns;
    const size_t samples = w * (size_t)s->rows;
    const int apart = 256 * (s->depths - 1) / APART;
    uint16_t *column = (uint16_t *)s->path, *most = column + 2 * w, *least = most + w;

    memcpy(s->luma, s->sure, samples);
    for (int y = 0; y < s->rows; y++) {
        struct rf_stack_line line[REFOCUS_STACK_MOST_FRAMES];
        const uint8_t *moving[REFOCUS_STACK_MOST_FRAMES];

        extremes_of_row(s, y, column, most);
        rf_stack_sample_lines(s, line, y);
        for (int k = 0; k < s->count; k++)
            moving[k] = rf_stack_moving_row(s, k, y * s->reduced + (s->reduced - 1) / 2);
        for (int x = 0; x < s->columns; x++) {
            const int k = (most[x] / 256 + s->sub / 2) / s->sub;
            const int place = rf_stack_moving_column(s, x * s->reduced + (s->reduced - 1) / 2);

            const size_t i = (size_t)y * w + (size_t)x;

            if (most[x] - least[x] < apart || rf_stack_moves(moving[k], place))
                continue;
            rf_stack_guide(s, line, k, x, y);
            if (2 * s->depth[i] > most[x] + least[x])
                s->sure[i] /= 2;
        }
    }
    rf_stack_fill(s, true);
    memcpy(s->sure, s->luma, samples);
}
