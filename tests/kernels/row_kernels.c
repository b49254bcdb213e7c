/* row_kernels.c: the table of row kernels, and a plain reference for those that row_background.c
 * has not. */
#include "row_kernels.h"
#include "row_background.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_RADIUS = 127 * 256 + 1 };

/* The parameter holds both parts of a focus. */
static struct rf_focus focus_of(int parameter)
{
    uint32_t seed = (uint32_t)parameter;
    struct rf_focus focus = {(uint16_t)noise(&seed), (uint16_t)(noise(&seed) % MOST_RADIUS), 0};

    if (parameter % 3 == 0)
        focus.disparity = parameter % 2 ? 65535 : 0;
    if (parameter % 5 == 0)
        focus.radius = MOST_RADIUS;
    return focus;
}

static void run_signed_blur(const struct rf_kernels *k, void *const *row, int parameter, int n)
{
    k->signed_blur(row[0], row[1], focus_of(parameter), n);
}

static void expect_signed_blur(void *const *row, int parameter, int n)
{
    const struct rf_focus focus = focus_of(parameter);
    int16_t *blur = row[0];
    const uint16_t *disparity = row[1];

    for (int x = 0; x < n; x++) {
        const int64_t distance = (int64_t)focus.disparity - disparity[x];
        const int64_t q24 = distance * focus.radius;

        if (q24 >= 0)
            blur[x] = (int16_t)((q24 + 32768) / 65536);
        else
            blur[x] = (int16_t) - ((-q24 + 32768) / 65536);
    }
}

/* The parameter holds where the neighbours are, too. */
static int apart_of(int parameter)
{
    return 1 + parameter % 4;
}

/* Returns over how much blur the mean comes in. */
static int over_of(int parameter)
{
    return parameter % 3 ? 1 + parameter / 4 : 1;
}

static void run_smooth3(const struct rf_kernels *k, void *const *row, int parameter, int n)
{
    uint16_t *const out[3] = {row[0], row[1], row[2]};
    const uint16_t *const light[3] = {row[3], row[4], row[5]};

    k->smooth3(out, light, row[6], apart_of(parameter), parameter, over_of(parameter), n);
}

/* Whether two blurs are alike for the first: within an eighth of it, one pixel to two. */
static bool alike(int own, int other)
{
    const double most = fmin(fmax(floor(abs(own) / 8.0), 256), 511);

    return abs(other - own) <= most;
}

/* A pixel and its two neighbours as smooth3 has it. */
static uint16_t smoothed(const uint16_t *light, const int16_t *blur, int parameter)
{
    const int apart = apart_of(parameter), over = over_of(parameter);
    int64_t part = abs(blur[0]) - parameter, way = 0;

    for (int i = -apart; i <= apart; i += apart)
        if (alike(blur[0], blur[i]))
            way += light[i] - light[0];
    part = part < 0 ? 0 : part > over ? over : part;
    part = part * (65535 / over) * 10923 / 65536;
    /* halves towards what is less */
    return (uint16_t)(light[0] - (int)floor((double)(-way * part) / 32768 + 0.5));
}

static void expect_smooth3(void *const *row, int parameter, int n)
{
    for (int c = 0; c < 3; c++)
        for (int x = 0; x < n; x++)
            ((uint16_t *)row[c])[x] =
                smoothed((const uint16_t *)row[3 + c] + x, (const int16_t *)row[6] + x, parameter);
}

static void run_means(const struct rf_kernels *k, void *const *row, int parameter, int n)
{
    k->means(row[0], row[1], rf_mean_scale((uint64_t)parameter), n);
}

/* floor(sum scale / 2^30 + 1/2), its product by hand in two halves. */
static void expect_means(void *const *row, int parameter, int n)
{
    const uint64_t scale = rf_mean_scale((uint64_t)parameter);
    uint16_t *mean = row[0];
    const uint32_t *sum = row[1];

    for (int x = 0; x < n; x++) {
        const uint64_t high = (sum[x] >> 16) * scale, low = (sum[x] & 0xffff) * scale;

        mean[x] = (uint16_t)((high * 65536 + low + 536870912) / 1073741824);
    }
}

static void run_clamp_row(const struct rf_kernels *k, void *const *row, int parameter, int n)
{
    k->clamp_row(row[0], (uint16_t)parameter, n);
}

static void expect_clamp_row(void *const *row, int parameter, int n)
{
    uint16_t *value = row[0];

    for (int x = 0; x < n; x++)
        if (value[x] > parameter)
            value[x] = (uint16_t)parameter;
}

static void run_smooth1(const struct rf_kernels *k, void *const *row, int parameter, int n)
{
    k->smooth1(row[0], row[1], row[2], apart_of(parameter), parameter, over_of(parameter), n);
}

static void expect_smooth1(void *const *row, int parameter, int n)
{
    for (int x = 0; x < n; x++)
        ((uint16_t *)row[0])[x] =
            smoothed((const uint16_t *)row[1] + x, (const int16_t *)row[2] + x, parameter);
}

static void run_sharpest4(const struct rf_kernels *k, void *const *row, int parameter, int n)
{
    (void)parameter;
    k->sharpest4(row[0], row[1], row[2], n);
}

static void expect_sharpest4(void *const *row, int parameter, int n)
{
    int16_t *out = row[0];

    (void)parameter;
    for (int x = 0; x < n; x++) {
        int best = 40000;

        for (int i = 0; i < 4; i++) {
            const int16_t s = ((const int16_t *)row[1 + i / 2])[2 * x + i % 2];

            if (abs(s) < abs(best))
                best = s;
        }
        out[2 * x] = out[2 * x + 1] = (int16_t)best;
    }
}

static void run_split2(const struct rf_kernels *k, void *const *row, int parameter, int n)
{
    (void)parameter;
    k->split2(row[0], row[1], row[2], row[3], n);
}

static void expect_split2(void *const *row, int parameter, int n)
{
    const uint16_t *upper = row[2], *lower = row[3];

    (void)parameter;
    for (int i = 0; i < 2 * n; i++)
        ((uint16_t *)row[i % 2])[i / 2] = (uint16_t)((upper[i] + lower[i] + 1) / 2);
}

static void run_join2(const struct rf_kernels *k, void *const *row, int parameter, int n)
{
    (void)parameter;
    k->join2(row[0], row[1], row[2], n);
}

static void expect_join2(void *const *row, int parameter, int n)
{
    (void)parameter;
    for (int i = 0; i < 2 * n; i++)
        ((uint16_t *)row[0])[i] = ((const uint16_t *)row[1 + i % 2])[i / 2];
}

/* The parameter holds how far the neighbours are away, and how much they may differ. */
static int code_apart_of(int parameter)
{
    static const int apart[] = {1, 2, 4};

    return apart[parameter % 3];
}

static void run_smooth_codes(const struct rf_kernels *k, void *const *row, int parameter, int n)
{
    const uint16_t *const in[3] = {row[1], row[2], row[3]};

    k->smooth_codes(row[0], in, code_apart_of(parameter), (uint16_t)parameter, n);
}

static void expect_smooth_codes(void *const *row, int parameter, int n)
{
    const int apart = code_apart_of(parameter);

    for (int x = 0; x < n; x++) {
        const int own = ((const uint16_t *)row[2])[x];
        int sum = 0;

        for (int j = -1; j <= 1; j++)
            for (int i = -1; i <= 1; i++) {
                const int away = ((const uint16_t *)row[2 + j])[x + i * apart] - own;
                const int opposite = ((const uint16_t *)row[2 - j])[x - i * apart] - own;

                if (abs(away) <= parameter && abs(opposite) <= parameter)
                    sum += (2 - abs(i)) * (2 - abs(j)) * away;
            }
        ((uint16_t *)row[0])[x] = (uint16_t)(own + (int)floor((sum + 8) / 16.0));
    }
}

static void run_clamp_codes(const struct rf_kernels *k, void *const *row, int parameter, int n)
{
    k->clamp_codes(row[0], row[1], (uint16_t)parameter, n);
}

static void expect_clamp_codes(void *const *row, int parameter, int n)
{
    uint16_t *code = row[0];

    for (int x = 0; x < n; x++) {
        const int smooth = ((const uint16_t *)row[1])[x], away = smooth - code[x];

        code[x] =
            (uint16_t)(abs(away) <= parameter ? smooth : code[x] + (away < 0 ? -1 : 1) * parameter);
    }
}

const struct row_kernel row_kernels[] = {
    {"smooth_codes",
     4,
     {{DISPARITY, 1, 0, 0}, {DISPARITY, 1, 4, 0}, {DISPARITY, 1, 4, 0}, {DISPARITY, 1, 4, 0}},
     0,
     RF_MOST_SMOOTHED,
     run_smooth_codes,
     expect_smooth_codes},
    {"clamp_codes",
     2,
     {{DISPARITY, 1, 0, 0}, {DISPARITY, 1, 0, 0}},
     0,
     UINT16_MAX,
     run_clamp_codes,
     expect_clamp_codes},
    {"smooth1",
     3,
     {{LIGHT, 1, 0, 0}, {LIGHT, 1, 4, 0}, {BLUR, 1, 4, 0}},
     0,
     INT16_MAX,
     run_smooth1,
     expect_smooth1},
    {"sharpest4",
     3,
     {{BLUR, 2, 0, 0}, {BLUR, 2, 0, 0}, {BLUR, 2, 0, 0}},
     0,
     0,
     run_sharpest4,
     expect_sharpest4},
    {"push1",
     6,
     {{LIGHT, 1, 0, 0},
      {BLUR, 1, 0, 0},
      {LIGHT, 2, 0, 0},
      {LIGHT, 2, 0, 0},
      {BLUR_OR_NONE, 2, 0, 0},
      {BLUR_OR_NONE, 2, 0, 0}},
     0,
     INT16_MAX,
     run_push1,
     expect_push1},
    {"split2",
     4,
     {{LIGHT, 1, 0, 0}, {LIGHT, 1, 0, 0}, {LIGHT, 2, 0, 0}, {LIGHT, 2, 0, 0}},
     0,
     0,
     run_split2,
     expect_split2},
    {"join2",
     3,
     {{LIGHT, 2, 0, 0}, {LIGHT, 1, 0, 0}, {LIGHT, 1, 0, 0}},
     0,
     0,
     run_join2,
     expect_join2},
    {"signed_blur",
     2,
     {{BLUR, 1, 0, 0}, {DISPARITY, 1, 0, 0}},
     0,
     30000,
     run_signed_blur,
     expect_signed_blur},
    {"smooth3",
     7,
     {{LIGHT, 1, 0, 0},
      {LIGHT, 1, 0, 0},
      {LIGHT, 1, 0, 0},
      {LIGHT, 1, 4, 0},
      {LIGHT, 1, 4, 0},
      {LIGHT, 1, 4, 0},
      {BLUR, 1, 4, 0}},
     0,
     INT16_MAX,
     run_smooth3,
     expect_smooth3},
    {"spread_row",
     2,
     {{RAISED, 1, 0, SPREAD_MARGIN}, {SCRATCH, 1, 0, SPREAD_MARGIN}},
     1,
     258,
     run_spread_row,
     expect_spread_row},
    {"dilate_from",
     2,
     {{RAISED, 1, 0, 0}, {RAISED, 1, 1, 0}},
     0,
     RF_MAX_UNIT,
     run_dilate_from,
     expect_dilate_from},
    {"mark_foreground",
     3,
     {{BLUR, 1, 0, 0}, {BLUR, 1, 0, 0}, {RAISED, 1, 0, 0}},
     0,
     0,
     run_mark_foreground,
     expect_mark_foreground},
    {"push",
     10,
     {{LIGHT, 1, 0, 0},
      {LIGHT, 1, 0, 0},
      {LIGHT, 1, 0, 0},
      {BLUR, 1, 0, 0},
      {LIGHT, 2, 0, 0},
      {LIGHT, 2, 0, 0},
      {LIGHT, 2, 0, 0},
      {LIGHT, 2, 0, 0},
      {BLUR_OR_NONE, 2, 0, 0},
      {BLUR_OR_NONE, 2, 0, 0}},
     0,
     INT16_MAX,
     run_push,
     expect_push},
    {"pull",
     8,
     {{LIGHT, 2, 0, 0},
      {BLUR_OR_NONE, 2, 0, 0},
      {LIGHT, 1, 0, 0},
      {LIGHT, 1, 0, 0},
      {BLUR, 1, 0, 0},
      {BLUR, 1, 0, 0},
      {SCRATCH, 1, 0, 1},
      {SCRATCH, 1, 0, 1}},
     0,
     INT16_MAX,
     run_pull,
     expect_pull},
    {"pull_blur",
     4,
     {{BLUR_OR_NONE, 2, 0, 0}, {BLUR, 1, 0, 0}, {BLUR, 1, 0, 0}, {SCRATCH, 1, 0, 1}},
     0,
     INT16_MAX,
     run_pull_blur,
     expect_pull_blur},
    {"means", 2, {{LIGHT, 1, 0, 0}, {SUM, 1, 0, 0}}, 1, 1024, run_means, expect_means},
    {"clamp_row", 1, {{LIGHT, 1, 0, 0}}, 0, UINT16_MAX, run_clamp_row, expect_clamp_row},
};
const int row_kernel_count = sizeof row_kernels / sizeof row_kernels[0];
