/* pick.c: finds the surface that a tap or a rectangle means. */
#include <refocus/focus.h>

#include <stdbool.h>
#include <string.h>

#include "image/format.h"
#include "image/read.h"
#include "image/disparity_map.h"
#include "support/compare.h"

enum {
    BINS = 2048,
    WIDTH = 65536 / BINS, /* disparities of a bin */
    APART = BINS / 64,    /* empty bins that part two surfaces */
    NOISE = 1024,         /* a bin with at most 1/NOISE of the pixels counts as empty */
    SHARE = 4,            /* the nearest surface with 1/SHARE of the pixels is meant */
};

/* A part of a map: a disc when radius > 0, else the whole rectangle. */
struct part {
    const struct refocus_disparity *map;
    int x0, y0, x1, y1;
    int cx, cy, radius;
};

static int value_at(const struct part *part, int x, int y)
{
    return rf_map_sample(part->map, rf_map_row(part->map, y), x);
}

static bool is_inside(const struct part *part, int x, int y)
{
    const int dx = x - part->cx, dy = y - part->cy;

    return part->radius == 0 || dx * dx + dy * dy <= part->radius * part->radius;
}

static uint32_t count_bins(const struct part *part, uint32_t count[BINS])
{
    uint32_t sum = 0;

    memset(count, 0, BINS * sizeof *count);
    for (int y = part->y0; y < part->y1; y++) {
        for (int x = part->x0; x < part->x1; x++) {
            if (!is_inside(part, x, y))
                continue;
            count[value_at(part, x, y) / WIDTH]++;
            sum++;
        }
    }
    return sum;
}

/* Finds the surface that is meant; returns the bin of its median. */
static int find_surface(const uint32_t count[BINS], uint32_t sum)
{
    uint32_t best = 0, left;
    int best_from = 0;

    for (int bin = BINS - 1; bin >= 0;) { /* from the near side */
        uint32_t own = 0;
        int empty = 0, to = bin;

        for (; bin >= 0 && empty < APART; bin--) {
            own += count[bin];
            empty = count[bin] > sum / NOISE ? 0 : empty + 1;
        }
        if (own > best) {
            best = own;
            best_from = to;
        }
        if (own >= (sum + SHARE - 1) / SHARE) {
            best = own;
            best_from = to;
            break;
        }
    }
    left = (best + 1) / 2;
    while (left > count[best_from])
        left -= count[best_from--];
    return best_from;
}

/* The mean of the disparities in a bin: exact where all are the same. */
static float mean_of_bin(const struct part *part, int bin)
{
    uint64_t sum = 0, count = 0;

    for (int y = part->y0; y < part->y1; y++) {
        for (int x = part->x0; x < part->x1; x++) {
            const int v = value_at(part, x, y);

            if (!is_inside(part, x, y) || v / WIDTH != bin)
                continue;
            sum += (uint64_t)v;
            count++;
        }
    }
    return (float)((double)((sum + count / 2) / count) / 65535.0);
}

static float pick(const struct part *part)
{
    uint32_t count[BINS];
    const uint32_t sum = count_bins(part, count);

    return mean_of_bin(part, find_surface(count, sum));
}

int refocus_focus_at_point(const struct refocus_disparity *given, int x, int y, int radius,
                           float *focus)
{
    struct refocus_disparity own;
    const struct refocus_disparity *const map = &own;
    struct part part = {.map = map, .cx = x, .cy = y};
    const int status = rf_read_map(NULL, "map", &own, given);

    if (status)
        return status;
    if (!focus || x < 0 || y < 0 || x >= map->width || y >= map->height || radius < 0 ||
        radius > REFOCUS_MAX_TAP_RADIUS)
        return REFOCUS_ERR_ARGUMENT;
    if (radius == 0)
        radius = rf_larger(3, rf_larger(map->width, map->height) / 256);
    part.radius = radius;
    part.x0 = rf_larger(x - radius, 0);
    part.y0 = rf_larger(y - radius, 0);
    part.x1 = rf_smaller(x + radius + 1, map->width);
    part.y1 = rf_smaller(y + radius + 1, map->height);
    *focus = pick(&part);
    return REFOCUS_OK;
}

int refocus_focus_in_rectangle(const struct refocus_disparity *given, int x, int y, int width,
                               int height, float *focus)
{
    struct refocus_disparity own;
    const struct refocus_disparity *const map = &own;
    struct part part = {.map = map, .x0 = x, .y0 = y};
    const int status = rf_read_map(NULL, "map", &own, given);

    if (status)
        return status;
    if (!focus || x < 0 || y < 0 || width < 1 || height < 1 || width > map->width - x ||
        height > map->height - y)
        return REFOCUS_ERR_ARGUMENT;
    part.x1 = x + width;
    part.y1 = y + height;
    *focus = pick(&part);
    return REFOCUS_OK;
}
