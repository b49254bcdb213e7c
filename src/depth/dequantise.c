/* dequantise.c: makes slopes of the steps in a disparity map that has few codes. */
#include "depth/dequantise.h"

#include <stdbool.h>
#include <string.h>

#include "support/compare.h"

enum {
    CODES = 65536,
    FEWEST = 32,            /* codes in use, of a map that is smoothed */
    MOST = 320,             /* 8 bits, and some between that came by way of resampling */
    MOST_STEP = CODES / 64, /* 6 bits */
    PIXELS_A_CODE = 64,     /* fewer: a small picture of a fine map */
    LOOKED_AT = 1 << 17,    /* pixels, about: the others hardly have more codes */
    ROWS = 16,              /* a work item of a thread */
    PASSES = 3,
};

/* Neighbours of another step are no more than this away: one step, and what rounding and the
 * passes before made of it. */
static uint16_t most_alike(int step)
{
    return (uint16_t)(step * 8 / 5);
}
_Static_assert(MOST_STEP * 8 / 5 <= RF_MOST_SMOOTHED, "sums of differences fit in 16 bits");

static int code_at(const struct refocus_disparity *map, const uint8_t *row, int x)
{
    return map->bits == 16 ? ((const uint16_t *)row)[x] : row[x] * 257;
}

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
            const int code = code_at(map, row, x);
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

/* One pass of smoothing, from a plane to another. */
struct pass {
    const struct rf_dequantiser *d;
    struct rf_disparity_q16 in, out;
    int apart;
};

/* n pixels of a row from x on, n at most the distance of the neighbours, some of which lie beyond
 * the sides: there the last pixel is repeated. */
static void smooth_side(const struct pass *pass, uint16_t *out, const uint16_t *const row[3], int x,
                        int n)
{
    const struct rf_dequantiser *d = pass->d;
    const int apart = pass->apart;
    uint16_t near_by[3][3 * RF_DEQUANTISE_REACH];
    const uint16_t *from[3];

    for (int j = 0; j < 3; j++) {
        for (int i = 0; i < n + 2 * apart; i++) {
            const int at = rf_larger(x - apart + i, 0);

            near_by[j][i] = row[j][rf_smaller(at, d->width - 1)];
        }
        from[j] = near_by[j] + apart;
    }
    d->kernels->smooth_codes(out + x, from, apart, most_alike(d->step), n);
}

static void smooth_row(const struct pass *pass, int y)
{
    const struct rf_dequantiser *d = pass->d;
    const int left = rf_smaller(pass->apart, d->width);
    const int right = rf_larger(d->width - pass->apart, left);
    uint16_t *out = pass->out.at + y * pass->out.stride;
    const uint16_t *row[3], *middle[3];

    for (int j = 0; j < 3; j++) {
        const int v = rf_larger(y + (j - 1) * pass->apart, 0);

        row[j] = pass->in.at + rf_smaller(v, d->height - 1) * pass->in.stride;
        middle[j] = row[j] + left;
    }
    smooth_side(pass, out, row, 0, left);
    d->kernels->smooth_codes(out + left, middle, pass->apart, most_alike(d->step), right - left);
    smooth_side(pass, out, row, right, d->width - right);
}

static void smooth_band(void *context, int band, int worker)
{
    const struct pass *pass = context;
    const int end = rf_smaller((band + 1) * ROWS, pass->d->height);

    (void)worker;
    for (int y = band * ROWS; y < end; y++)
        smooth_row(pass, y);
}

static void clamp_band(void *context, int band, int worker)
{
    const struct pass *pass = context;
    const struct rf_dequantiser *d = pass->d;
    const int end = rf_smaller((band + 1) * ROWS, d->height);

    (void)worker;
    for (int y = band * ROWS; y < end; y++)
        d->kernels->clamp_codes(d->code.at + y * d->code.stride, pass->in.at + y * pass->in.stride,
                                (uint16_t)(d->step / 2), d->width);
}

static void run_bands(struct rf_pool *pool, rf_work_fn *work, struct pass *pass)
{
    const int bands = (pass->d->height + ROWS - 1) / ROWS;

    if (pool)
        rf_pool_run(pool, work, pass, bands);
    for (int band = 0; !pool && band < bands; band++)
        work(pass, band, 0);
}

void rf_dequantise(const struct rf_dequantiser *d, struct rf_pool *pool)
{
    static const int apart[PASSES] = {4, 2, 1};
    struct pass pass = {.d = d, .in = d->code};

    for (int i = 0; i < PASSES; i++) {
        pass.out = d->spare[i % 2];
        pass.apart = apart[i];
        run_bands(pool, smooth_band, &pass);
        pass.in = pass.out;
    }
    run_bands(pool, clamp_band, &pass);
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
            code[(v - y0) * SIDE + u - x0] =
                (uint16_t)code_at(map, (const uint8_t *)map->samples + v * map->stride, u);
    if (step)
        rf_dequantise(&d, NULL);
    for (int v = 0; v < height; v++)
        memcpy(out + v * width, code + (y - y0 + v) * SIDE + x - x0, (size_t)width * sizeof *out);
}
