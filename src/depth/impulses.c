/* impulses.c: samples of a disparity map that are far off those around them are told and put right.
 */
#include "depth/impulses.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "support/compare.h"

enum {
    ALONE = 6554,        /* 0.1: so far off all of its neighbours a sample is alone */
    OFF = 1966,          /* 0.03: so far off the median a sample is put right */
    FEWEST = 256,        /* in 1/65536 of the samples: fewer may be true */
    LOOKED_AT = 1 << 16, /* samples, about */
    REACH = 2,           /* samples that the median takes to each side */
    SIDE = 2 * REACH + 1,
};

/* Whether all eight neighbours are far off, above or below. */
static bool is_alone(const uint16_t *at, ptrdiff_t stride)
{
    for (int v = -1; v <= 1; v++)
        for (int u = -1; u <= 1; u++)
            if ((u || v) && abs(at[v * stride + u] - *at) <= ALONE)
                return false;
    return true;
}

int rf_impulses_of(struct rf_disparity_q16 map, int width, int height)
{
    const int every = (int)((int64_t)width * height / LOOKED_AT) + 1;
    int64_t count = 0, alone = 0, share;

    for (int y = 1; y < height - 1; y += every)
        for (int x = 1; x < width - 1; x++, count++)
            alone += is_alone(map.at + y * map.stride + x, map.stride);
    share = count ? alone * 65536 / count : 0;
    return share < FEWEST ? 0 : (int)share;
}

struct removal {
    struct rf_disparity_q16 map, out;
    int width, height;
};

/* The middle one of the samples around a place, those at the sides repeated. */
static uint16_t median_around(const struct removal *removal, int x, int y)
{
    uint16_t sorted[SIDE * SIDE];
    int n = 0;

    for (int v = y - REACH; v <= y + REACH; v++) {
        const uint16_t *row =
            removal->map.at + rf_clamp(v, 0, removal->height - 1) * removal->map.stride;

        for (int u = x - REACH; u <= x + REACH; u++, n++) {
            const uint16_t value = row[rf_clamp(u, 0, removal->width - 1)];
            int at = n;

            for (; at > 0 && sorted[at - 1] > value; at--)
                sorted[at] = sorted[at - 1];
            sorted[at] = value;
        }
    }
    return sorted[SIDE * SIDE / 2];
}

static void remove_row(void *context, int y, int worker)
{
    const struct removal *removal = context;
    const uint16_t *map = removal->map.at + y * removal->map.stride;
    uint16_t *out = removal->out.at + y * removal->out.stride;

    (void)worker;
    for (int x = 0; x < removal->width; x++) {
        const uint16_t median = median_around(removal, x, y);

        out[x] = abs(map[x] - median) > OFF ? median : map[x];
    }
}

void rf_remove_impulses(struct rf_disparity_q16 map, struct rf_disparity_q16 spare, int width,
                        int height, struct rf_pool *pool)
{
    struct removal removal = {.map = map, .out = spare, .width = width, .height = height};

    rf_pool_run(pool, remove_row, &removal, height);
    for (int y = 0; y < height; y++)
        memcpy(map.at + y * map.stride, spare.at + y * spare.stride,
               (size_t)width * sizeof *map.at);
}
