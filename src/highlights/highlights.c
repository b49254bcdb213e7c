#include "highlights/highlights.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "renderer/renderer.h"
#include "tiles/ranges.h"
#include "tiles/tiles.h"

enum {
    AROUND = 12,                      /* surroundings: 25 x 25 pixels */
    AREA = (2 * AROUND + 1) * (2 * AROUND + 1),
    RIM = 3,                          /* pixels around that tell the hue */
    LEVEL = RF_LIGHT_MAX * 94 / 100,  /* where clipping begins to count */
    HALF_LIT = RF_LIGHT_MAX * 40 / 100,
    GAIN = 3,                         /* full gain of 4 adds three times white */
    WIDEST = 3,                       /* pixels that a lamp is widened by */
    BLURRED = 512,                    /* Q7.8: what it may be widened over */
};

static int clamp(int v, int most)
{
    return v < 0 ? 0 : v > most ? most : v;
}

static int brightest(const struct refocus_renderer *r, ptrdiff_t at)
{
    int most = r->front.light[0][at];

    most = r->front.light[1][at] > most ? r->front.light[1][at] : most;
    return r->front.light[2][at] > most ? r->front.light[2][at] : most;
}

/* Mean colour of the surroundings, from a sparse grid: every third pixel of 25 x 25. */
static void surroundings(const struct refocus_renderer *r, int x, int y, int mean[3])
{
    int sum[3] = {0, 0, 0}, n = 0;

    for (int j = -AROUND; j <= AROUND; j += 3) {
        for (int i = -AROUND; i <= AROUND; i += 3) {
            const ptrdiff_t at =
                clamp(y + j, r->height - 1) * r->stride + clamp(x + i, r->width - 1);

            for (int c = 0; c < 3; c++)
                sum[c] += r->front.light[c][at];
            n++;
        }
    }
    for (int c = 0; c < 3; c++)
        mean[c] = sum[c] / n;
}

/* Colour of the lamp's rim, its largest channel RF_LIGHT_MAX; white if it has none. */
static void rim_hue(const struct refocus_renderer *r, int x, int y, const int around[3],
                    int hue[3])
{
    int64_t sum[3] = {0, 0, 0}, most;

    for (int j = -RIM; j <= RIM; j++) {
        for (int i = -RIM; i <= RIM; i++) {
            const int qx = clamp(x + i, r->width - 1), qy = clamp(y + j, r->height - 1);
            const ptrdiff_t at = qy * r->stride + qx;

            if (brightest(r, at) >= LEVEL) /* a clipped channel has lost the hue */
                continue;
            for (int c = 0; c < 3; c++)
                if (r->front.light[c][at] > around[c])
                    sum[c] += r->front.light[c][at] - around[c];
        }
    }
    most = sum[0] > sum[1] ? sum[0] : sum[1];
    most = sum[2] > most ? sum[2] : most;
    for (int c = 0; c < 3; c++)
        hue[c] = most < RF_LIGHT_MAX / 4 ? RF_LIGHT_MAX : (int)(sum[c] * RF_LIGHT_MAX / most);
}

/* 0 to 256 as v goes from a to b. */
static int ramp(int64_t v, int64_t a, int64_t b)
{
    return v >= b ? 256 : v <= a ? 0 : (int)(256 * (v - a) / (b - a));
}

/*
 * How steep the rim is around (x, y), 0 to 256. Where a pixel is lit in part, a lamp of L times
 * white still clips down to a share of 0.94 / L of it and is half lit only from there to 0.4 / L:
 * the brighter, the fewer half lit pixels around it. White paint and the shine of rounded things
 * fade out over many.
 */
static int steepness(const struct refocus_renderer *r, int x, int y)
{
    int clipped = 0, half_lit = 0;

    for (int j = -RIM; j <= RIM; j++) {
        for (int i = -RIM; i <= RIM; i++) {
            const int b = brightest(r, clamp(y + j, r->height - 1) * r->stride +
                                           clamp(x + i, r->width - 1));

            clipped += b >= LEVEL;
            half_lit += b < LEVEL && b >= HALF_LIT;
        }
    }
    return ramp(clipped, 2 * half_lit, 4 * half_lit);
}

/* Whether pixel (x, y), whose surroundings have this sum of luminance, is a clipped lamp. */
static bool is_lamp(const struct refocus_renderer *r, int x, int y, int own, int64_t sum,
                    struct rf_highlight *lamp)
{
    const int level = ramp(brightest(r, y * r->stride + x), LEVEL, RF_LIGHT_MAX);
    const int alone = ramp((int64_t)own * AREA, 3 * sum, 6 * sum);
    int strength = level * alone / 256;
    int around[3], hue[3];

    if (strength)
        strength = strength * steepness(r, x, y) / 256;
    if (!strength)
        return false;
    surroundings(r, x, y, around);
    rim_hue(r, x, y, around, hue);
    lamp->x = (uint16_t)x;
    lamp->y = (uint16_t)y;
    for (int c = 0; c < 3; c++)
        lamp->added[c] = (uint16_t)(GAIN * hue[c] * strength / 256);
    return true;
}

static bool has_bright(const struct refocus_renderer *r, int y)
{
    const ptrdiff_t at = y * r->stride;

    return r->kernels.brightest(r->front.light[0] + at, r->front.light[1] + at,
                                r->front.light[2] + at, r->width) > LEVEL;
}

static void luminance_row(const struct refocus_renderer *r, uint16_t *out, int y)
{
    const ptrdiff_t at = clamp(y, r->height - 1) * r->stride;

    r->kernels.luminance(out, r->front.light[0] + at, r->front.light[1] + at,
                         r->front.light[2] + at, r->width);
}

/* Sums of 25 luminances in columns around row y, from those around row y - 1 unless `afresh`.
 * At most 25 * 2047 < 2^16. */
static void sum_columns(const struct refocus_renderer *r, uint16_t *sum, uint16_t *row, int y,
                        bool afresh)
{
    if (afresh)
        memset(sum, 0, (size_t)r->width * sizeof *sum);
    for (int j = afresh ? -AROUND : AROUND; j <= AROUND; j++) {
        luminance_row(r, row, y + j);
        for (int x = 0; x < r->width; x++)
            sum[x] = (uint16_t)(sum[x] + row[x]);
    }
    if (afresh)
        return;
    luminance_row(r, row, y - AROUND - 1);
    for (int x = 0; x < r->width; x++)
        sum[x] = (uint16_t)(sum[x] - row[x]);
}

static int sum_around(const struct refocus_renderer *r, const uint16_t *columns, int x)
{
    int sum = 0;

    for (int i = -AROUND; i <= AROUND; i++)
        sum += columns[clamp(x + i, r->width - 1)];
    return sum;
}

/* The lamps of a row whose columns are summed; the luminance of its pixels is in `row`. */
static void find_in_row(struct refocus_renderer *r, struct rf_highlights *found, int y,
                        const uint16_t *columns, const uint16_t *row)
{
    int sum = 0, last = -2; /* pixel that the sum is of */

    for (int x = 0; x < r->width; x++) {
        if (brightest(r, y * r->stride + x) <= LEVEL)
            continue;
        if (x == last + 1)
            sum += columns[clamp(x + AROUND, r->width - 1)] -
                   columns[clamp(last - AROUND, r->width - 1)];
        else
            sum = sum_around(r, columns, x);
        last = x;
        if (found->count < found->capacity &&
            is_lamp(r, x, y, row[x], sum, &found->lamp[found->count]))
            found->count++;
    }
}

void rf_find_highlights(struct refocus_renderer *r, int part, uint16_t *scratch)
{
    const int y0 = part * RF_LAMP_ROWS;
    const int y1 = y0 + RF_LAMP_ROWS < r->height ? y0 + RF_LAMP_ROWS : r->height;
    struct rf_highlights *found = &r->highlights[part];
    uint16_t *columns = scratch, *row = scratch + r->width;
    int summed = -2 * AROUND; /* row that the columns are summed around */

    found->count = 0;
    for (int y = y0; y < y1; y++) {
        if (!has_bright(r, y))
            continue;
        if (y - summed > AROUND) {
            sum_columns(r, columns, row, y, true);
        } else {
            while (summed < y)
                sum_columns(r, columns, row, ++summed, false);
        }
        summed = y;
        luminance_row(r, row, y);
        find_in_row(r, found, y, columns, row);
    }
}

/* Whether a bright pixel of another depth is beside it: then this one is the edge of that,
 * and only its depth says otherwise. */
static bool is_edge(const struct refocus_renderer *r, const struct rf_highlight *lamp)
{
    const int own = abs(r->front.blur[lamp->y * r->stride + lamp->x]);

    for (int j = -2; j <= 2; j++) {
        for (int i = -2; i <= 2; i++) {
            const ptrdiff_t at = clamp(lamp->y + j, r->height - 1) * r->stride +
                                 clamp(lamp->x + i, r->width - 1);

            if (abs(r->front.blur[at]) < own - 256 && brightest(r, at) >= LEVEL)
                return true;
        }
    }
    return false;
}


/*
 * Rays whose gaps are wider than a lamp would show it as a disc of dots. What is around it within
 * half a gap, farther away and blurred itself, takes its blur: then the pre-filter spreads its
 * light over that.
 */
static void widen(struct refocus_renderer *r, const struct rf_highlight *lamp,
                  struct rf_bin_scale scale, double gap)
{
    const int16_t own = r->front.blur[lamp->y * r->stride + lamp->x];
    const int half = (int)(gap * abs(own) / 512), reach = half < WIDEST ? half : WIDEST;

    for (int y = lamp->y - reach; y <= lamp->y + reach; y++) {
        for (int x = lamp->x - reach; x <= lamp->x + reach; x++) {
            const int dx = x - lamp->x, dy = y - lamp->y;
            int16_t *s;

            if (x < 0 || y < 0 || x >= r->width || y >= r->height ||
                dx * dx + dy * dy > reach * reach + 1)
                continue;
            s = r->front.blur + y * r->stride + x;
            if (*s > own && abs(*s) > BLURRED) {
                *s = own;
                rf_add_bin(r, scale, x / RF_TILE, y / RF_TILE, own);
                rf_add_to_cell(r, x, y, own);
            }
        }
    }
}

static void mark(struct refocus_renderer *r, struct rf_highlight *lamp)
{
    struct rf_bins *bins =
        &r->bins[(size_t)(lamp->y / RF_TILE) * r->tiles_x + lamp->x / RF_TILE];
    const int blur = abs(r->front.blur[lamp->y * r->stride + lamp->x]);

    lamp->is_edge = is_edge(r, lamp);
    if (!lamp->is_edge && blur > bins->lamp)
        bins->lamp = (int16_t)blur;
}

bool rf_mark_highlights(struct refocus_renderer *r, struct rf_bin_scale scale, double gap)
{
    bool any = false;

    for (int part = 0; part < rf_lamp_parts(r->height); part++) {
        const struct rf_highlights *found = &r->highlights[part];

        for (uint32_t i = 0; i < found->count; i++)
            mark(r, &found->lamp[i]);
        for (uint32_t i = 0; i < found->count; i++)
            if (!found->lamp[i].is_edge)
                widen(r, &found->lamp[i], scale, gap);
        any = any || found->count;
    }
    return any;
}

static void add(struct refocus_renderer *r, const struct rf_highlight *lamp, int share, int sign)
{
    const ptrdiff_t at = lamp->y * r->stride + lamp->x;
    /* from half a pixel of blur on, all of it from one pixel and a half on */
    const int blurred = lamp->is_edge ? 0 : ramp(abs(r->front.blur[at]), 128, 384);

    for (int c = 0; c < 3; c++)
        r->front.light[c][at] =
            (uint16_t)(r->front.light[c][at] +
                       sign * ((((lamp->added[c] * share) >> 8) * blurred) >> 8));
}

void rf_add_highlights(struct refocus_renderer *r, float gain, int sign)
{
    const int share = (int)((gain - 1) * (256 / GAIN) + 0.5f);

    for (int part = 0; part < rf_lamp_parts(r->height); part++)
        for (uint32_t i = 0; i < r->highlights[part].count; i++)
            add(r, &r->highlights[part].lamp[i], share, sign);
}
