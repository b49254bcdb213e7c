/* dequantise.c: makes slopes of the steps in a disparity map that has few codes. */
#include "depth/dequantise.h"

#include <stdbool.h>
#include <string.h>

#include "depth/smooth.h"
#include "image/disparity_map.h"
#include "support/compare.h"

enum {
    CODES = 65536,
    FEWEST = 32,            /* codes in use, of a map that is smoothed */
    MOST = 320,             /* 8 bits, and some between that came by way of resampling */
    MOST_STEP = CODES / 64, /* 6 bits */
    PIXELS_A_CODE = 64,     /* fewer: a small picture of a fine map */
    LOOKED_AT = 1 << 17,    /* pixels, about: the others hardly have more codes */
};

/* Neighbours of another step are no more than this away: one step, and what rounding and the
 * passes before made of it. */
static uint16_t most_alike(int step)
{
    return (uint16_t)(step * 8 / 5);
}
_Static_assert(MOST_STEP * 8 / 5 <= RF_MOST_SMOOTHED, "sums of differences fit in 16 bits");

/* Sets the bits of the codes in use, and returns how many; MOST + 1: more than MOST. Of a large map
 * it looks at some pixels of each row, others in the next. */
static int find_codes(const struct refocus_disparity *map, uint64_t used[CODES / 64])
{
    const int64_t pixels = (int64_t)map->width * map->height;
    const int every = (int)(pixels / LOOKED_AT) + 1;
    int found = 0;

    memset(used, 0, CODES / 8);
    for (int y = 0; y < map->height && found <= MOST; y++) {
        const uint8_t *row = (const uint8_t *)map->samples + y * map->stride;

        for (int x = 5 * y % every; x < map->width; x += every) {
            const int code = rf_map_sample(map, row, x);
            const uint64_t bit = UINT64_C(1) << code % 64;

            found += !(used[code / 64] & bit);
            used[code / 64] |= bit;
        }
    }
    return found <= MOST ? found : MOST + 1;
}

/* The steps from each code in use to the next one; returns how many. */
static int find_steps(int step[MOST], const uint64_t used[CODES / 64])
{
    int count = 0, last = -1;

    for (int i = 0; i < CODES / 64; i++)
        for (uint64_t left = used[i]; left; left &= left - 1) {
            const int code = 64 * i + __builtin_ctzll(left);

            if (last >= 0)
                step[count++] = code - last;
            last = code;
        }
    return count;
}

static bool nine_of_ten_up_to(int most, const int step[], int count)
{
    int within = 0;

    for (int i = 0; i < count; i++)
        within += step[i] <= most;
    return 10 * within >= 9 * count;
}

int rf_code_step(const struct refocus_disparity *map)
{
    uint64_t used[CODES / 64];
    const int codes = find_codes(map, used);
    int step[MOST], count, low = 1, high = MOST_STEP;

    if (codes < FEWEST || codes > MOST ||
        (int64_t)codes * PIXELS_A_CODE > (int64_t)map->width * map->height)
        return 0;
    count = find_steps(step, used);
    if (!nine_of_ten_up_to(high, step, count))
        return 0;
    while (low < high) {
        const int middle = (low + high) / 2;

        if (nine_of_ten_up_to(middle, step, count))
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

void rf_dequantise(const struct rf_dequantiser *d, struct rf_pool *pool)
{
    const uint16_t alike = most_alike(d->step);
    const struct rf_smooth_pass passes[] = {{4, alike}, {2, alike}, {1, alike}};
    const struct rf_smoother smoother = {
        .kernels = d->kernels,
        .code = d->code,
        .spare = {d->spare[0], d->spare[1]},
        .width = d->width,
        .height = d->height,
        .pass = passes,
        .passes = sizeof passes / sizeof *passes,
        .most_moved = (uint16_t)(d->step / 2),
    };

    rf_smooth(&smoother, pool);
}

void rf_dequantised_patch(const struct rf_kernels *kernels, const struct refocus_disparity *map,
                          int step, int x, int y, int width, int height, uint16_t *out)
{
    enum { SIDE = RF_DEQUANTISE_PATCH + 2 * RF_DEQUANTISE_REACH };
    const int reach = step ? RF_DEQUANTISE_REACH : 0;
    const int x0 = rf_larger(x - reach, 0), y0 = rf_larger(y - reach, 0);
    const int x1 = rf_smaller(x + width + reach, map->width);
    const int y1 = rf_smaller(y + height + reach, map->height);
    uint16_t code[SIDE * SIDE], spare[2][SIDE * SIDE];
    const struct rf_dequantiser d = {
        .kernels = kernels,
        .code = {code, SIDE},
        .spare = {{spare[0], SIDE}, {spare[1], SIDE}},
        .width = x1 - x0,
        .height = y1 - y0,
        .step = step,
    };

    for (int v = y0; v < y1; v++)
        for (int u = x0; u < x1; u++)
            code[(v - y0) * SIDE + u - x0] = rf_map_sample(map, rf_map_row(map, v), u);
    if (step)
        rf_dequantise(&d, NULL);
    for (int v = 0; v < height; v++)
        memcpy(out + v * width, code + (y - y0 + v) * SIDE + x - x0, (size_t)width * sizeof *out);
}
