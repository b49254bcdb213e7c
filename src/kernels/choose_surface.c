/* choose_surface.c: the depth upsampler: chooses the surface that each pixel of a cell belongs to,
 * and its disparity there. */
#include "kernels/kernels.h"
#include "kernels/lanes.h"

#include <string.h>

enum { ALIKE_TO = 8 }; /* where the table ends */

/* Whole vectors of pixels, so that the compiler knows how many. */
enum { LANES = 32 };

/* The box around the colours of pixels. */
struct box {
    uint8_t low[3], high[3];
};

static struct box box_of(uint8_t *const colour[3])
{
    struct box box;

    for (int c = 0; c < 3; c++) {
        uint8_t low = 255, high = 0;

        for (int x = 0; x < LANES; x++) {
            low = rf_least16(low, colour[c][x]);
            high = rf_most16(high, colour[c][x]);
        }
        box.low[c] = low;
        box.high[c] = high;
    }
    return box;
}

static int off_box(const struct box *box, int c, uint8_t v)
{
    return v - rf_least16(v, box->high[c]) + rf_most16(v, box->low[c]) - v;
}

static void look(uint16_t alike[LANES], uint8_t *const colour[3], const struct box *box,
                 const struct rf_window *window, uint64_t samples)
{
    const uint8_t *restrict p0 = colour[0], *restrict p1 = colour[1];
    const uint8_t *restrict p2 = colour[2];
    uint16_t sum[LANES] = {0};

    for (; samples; samples &= samples - 1) {
        const int k = __builtin_ctzll(samples);
        const uint8_t c0 = window->colour[0][k], c1 = window->colour[1][k];
        const uint8_t c2 = window->colour[2][k];

        if (off_box(box, 0, c0) + off_box(box, 1, c1) + off_box(box, 2, c2) > ALIKE_TO)
            continue;
        /* The table, in numbers: (124 - 11 d)^4 / 2^20. */
        for (int x = 0; x < LANES; x++) {
            const uint8_t d =
                (uint8_t)(rf_apart16(p0[x], c0) + rf_apart16(p1[x], c1) + rf_apart16(p2[x], c2));
            const uint8_t like = (uint8_t)(124 - 11 * rf_least16(d, 11));
            const uint16_t square = (uint16_t)(like * like);
            const uint16_t fourth = (uint16_t)((uint32_t)square * square >> 16);

            sum[x] = (uint16_t)(sum[x] + (fourth >> 4));
        }
    }
    memcpy(alike, sum, sizeof sum);
}

static void add_taps(uint16_t prior[LANES], const struct rf_cell *cell,
                     const struct rf_surface *surface, const struct rf_placement *placement,
                     int from)
{
    for (int x = 0; x < LANES; x++)
        prior[x] = 0;
    for (unsigned taps = surface->taps; taps; taps &= taps - 1) {
        const int t = __builtin_ctz(taps);
        const uint16_t *restrict near_by = placement->near_by[t] + from;
        const uint16_t trust = cell->trust[t];

        if (cell->sure)
            for (int x = 0; x < LANES; x++)
                prior[x] = (uint16_t)(prior[x] + near_by[x]);
        else
            for (int x = 0; x < LANES; x++)
                prior[x] = (uint16_t)(prior[x] + ((uint32_t)near_by[x] * trust >> 16));
    }
}

/* The prior of each surface. Where the taps are sure, the surface with the most
 * of them is given what the others leave. */
static void expect(uint16_t prior[RF_TAP_COUNT][LANES], const struct rf_cell *cell,
                   const struct rf_placement *placement, int from)
{
    const int rest = cell->sure ? cell->greatest : RF_TAP_COUNT;
    uint16_t left[LANES];

    memcpy(left, placement->all + from, sizeof left);
    for (int k = 0; k < cell->surfaces; k++) {
        if (k == rest)
            continue;
        add_taps(prior[k], cell, &cell->surface[k], placement, from);
        for (int x = 0; x < LANES; x++)
            left[x] = (uint16_t)(left[x] - prior[k][x]);
    }
    if (rest < RF_TAP_COUNT)
        memcpy(prior[rest], left, sizeof left);
}

static void height_of(uint16_t height[LANES], const struct rf_surface *surface,
                      const struct rf_placement *placement, int from)
{
    const int mean = surface->mean, right = surface->right, below = surface->below;
    const int low = surface->low, range = surface->range;
    const int16_t *restrict at_x = placement->x + from, *restrict at_y = placement->y + from;

    for (int x = 0; x < LANES; x++) {
        const int d =
            mean + ((right * at_x[x] + (1 << 14)) >> 15) + ((below * at_y[x] + (1 << 14)) >> 15);

        height[x] = (uint16_t)(low + (d < 0 ? 0 : d > range ? range : d));
    }
}

static void choose(uint16_t *restrict out, uint8_t *restrict sure, const struct rf_cell *cell,
                   const struct rf_window *window, const struct rf_placement *placement,
                   uint8_t *const colour[3], int from)
{
    const struct box box = box_of(colour);
    uint16_t best[LANES] = {0}, second[LANES] = {0}, prior[RF_TAP_COUNT][LANES];

    expect(prior, cell, placement, from);
    for (int x = 0; x < LANES; x++)
        out[x] = cell->surface[0].low;
    for (int k = 0; k < cell->surfaces; k++) {
        const struct rf_surface *s = &cell->surface[k];
        const uint16_t grow = s->grow, scale = s->scale;
        uint16_t alike[LANES], height[LANES];

        look(alike, colour, &box, window, s->samples);
        height_of(height, s, placement, from);
        for (int x = 0; x < LANES; x++) {
            const uint16_t mean = (uint16_t)((uint32_t)(uint16_t)(alike[x] * grow) * scale >> 16);
            const uint16_t evidence = (uint16_t)(4 * mean + RF_UNLIKE);
            const uint16_t score = (uint16_t)((uint32_t)prior[k][x] * evidence >> 16);
            const uint16_t less = score < best[x] ? score : best[x];

            out[x] = score > best[x] ? height[x] : out[x];
            second[x] = second[x] > less ? second[x] : less;
            best[x] = score > best[x] ? score : best[x];
        }
    }
    for (int x = 0; x < LANES; x++)
        sure[x] = best[x] / 4 > second[x] ? 255 : 0;
}

void rf_choose_surface_c(uint16_t out[RF_BATCH], uint8_t sure[RF_BATCH], const struct rf_cell *cell,
                         const struct rf_window *window, const struct rf_placement *placement,
                         uint8_t colour[3][RF_BATCH + RF_BATCH_SPARE], int n)
{
    for (int x = 0; x < n; x += LANES) {
        uint8_t *const own[3] = {colour[0] + x, colour[1] + x, colour[2] + x};

        choose(out + x, sure + x, cell, window, placement, own, x);
    }
}
