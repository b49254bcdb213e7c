/* silhouette.c: finds pixels at the silhouette of something bright, and the depth that they belong
 * to. */
#include "highlights/known.h"

#include <limits.h>
#include <stdbool.h>
#include <stdlib.h>

#include "highlights/silhouette_run.h"
#include "kernels/kernels.h"
#include "support/compare.h"
#include "support/places.h"

enum {
    JUMP = 65535 / 32,             /* disparities this far apart are two surfaces */
    LEVEL = RF_LIGHT_MAX * 9 / 10, /* clipped, or nearly */
    CONTRAST = RF_LIGHT_MAX / 2,   /* least |N - F| */
    FAR = 3,
    STRIP = 16, /* rows of RUNS runs are gone through together */
    RUNS = 16,
};

static bool is_bright(const struct rf_silhouette_window *w, ptrdiff_t at)
{
    return rf_brightest_at(&w->light, at) >= LEVEL;
}

/* The pixels two away from one. */
static const int8_t ring[16][2] = {{-2, -2}, {-1, -2}, {0, -2}, {1, -2}, {2, -2}, {-2, -1},
                                   {2, -1},  {-2, 0},  {2, 0},  {-2, 1}, {2, 1},  {-2, 2},
                                   {-1, 2},  {0, 2},   {1, 2},  {2, 2}};

/* Whether pixel (x, y) is a mixture with the bright, nearer pixel at n. */
static bool is_mixture(const struct rf_silhouette_window *w, int x, int y, ptrdiff_t n)
{
    const ptrdiff_t p = y * w->light.stride + x;
    const int middle = (w->disparity.at[p] + w->disparity.at[n]) / 2;
    int64_t along = 0, contrast = 0, own = 0;
    int sum[3] = {0, 0, 0}, count = 0;

    for (int k = 0; k < 16; k++) {
        const ptrdiff_t q = rf_within(y + ring[k][1], w->view->height - 1) * w->light.stride +
                            rf_within(x + ring[k][0], w->view->width - 1);
        const int behind = w->disparity.at[q] <= middle;

        count += behind;
        for (int c = 0; c < 3; c++)
            sum[c] += behind * w->light.channel[c][q];
    }
    if (!count)
        return false;
    for (int c = 0; c < 3; c++) {
        const int64_t far = sum[c] / count, near = w->light.channel[c][n];

        along += (w->light.channel[c][p] - far) * (near - far);
        contrast += (near - far) * (near - far);
        own += w->light.channel[c][p] * (near - far);
    }
    return contrast >= (int64_t)CONTRAST * CONTRAST && 20 * along > contrast && 5 * along > 2 * own;
}

static void add(const struct rf_silhouette_window *w, struct rf_silhouettes *list, int x, int y,
                uint16_t disparity)
{
    const struct rf_silhouette pixel = {(uint16_t)(x + w->view->x0), (uint16_t)(y + w->view->y0),
                                        disparity};

    rf_add_place(list->pixel, &list->count, list->capacity, &pixel, sizeof pixel);
}

/* Whether a bright pixel farther than `own` has none of that depth beside it: then it is not the
 * silhouette of such a pixel. */
static bool is_apart(const struct rf_silhouette_window *w, int x, int y, int own)
{
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) {
            const ptrdiff_t q = rf_within(y + j, w->view->height - 1) * w->light.stride +
                                rf_within(x + i, w->view->width - 1);

            if (abs(w->disparity.at[q] - own) <= JUMP && is_bright(w, q))
                return false;
        }
    return true;
}

/* Whether there are bright pixels that are farther. */
static bool has_far(const struct rf_silhouette_window *w, struct rf_rect in, int own)
{
    for (int y = in.y0; y < in.y1; y++)
        for (int x = in.x0; x < in.x1; x++)
            if (w->disparity.at[y * w->light.stride + x] < own - JUMP &&
                is_bright(w, y * w->light.stride + x))
                return true;
    return false;
}

/* Whether of the pixels at that depth at least half as many are dark as are bright, and some bright
 * ones are farther; pixel `at` of the run has it. */
static bool may_belong_to_background(const struct rf_silhouette_run *run, int at, int y, int own)
{
    const int16_t least = rf_signed16(own < JUMP ? 0 : own - JUMP);
    const int16_t most = rf_signed16(own + JUMP < UINT16_MAX ? own + JUMP : UINT16_MAX);
    int16_t dark[RF_RUN_LANES] = {0}, bright[RF_RUN_LANES] = {0}, farther[RF_RUN_LANES] = {0};
    int darks = 0, brights = 0, fars = 0;

    for (int j = 0; j < RF_RUN_SIDE; j++) {
        const int16_t *const light = run->light[j] + at;
        const int16_t *const d = run->disparity[rf_run_row(y + j - RF_RUN_AROUND)] + at;

        for (int i = 0; i < RF_RUN_LANES; i++) {
            const int alike = (d[i] >= least) & (d[i] <= most);

            dark[i] = (int16_t)(dark[i] + ((light[i] < RF_RUN_DARK) & alike));
            bright[i] = (int16_t)(bright[i] + ((light[i] >= LEVEL) & alike));
            farther[i] = (int16_t)(farther[i] + ((light[i] >= LEVEL) & (d[i] < least)));
        }
    }
    for (int i = 0; i < RF_RUN_SIDE; i++) {
        darks += dark[i];
        brights += bright[i];
        fars += farther[i];
    }
    return fars >= FAR && 2 * darks >= brights;
}

/* The light of the brightest channel of a pixel, also above white, Q12. */
static int64_t known_light(const struct rf_silhouette_window *w, int x, int y)
{
    int excess[3];

    rf_known_excess(w->known, x + w->view->x0, y + w->view->y0, excess);
    return rf_brightest_at(&w->light, y * w->light.stride + x) +
           rf_larger(rf_larger(excess[0], excess[1]), excess[2]);
}

/* Whether half of the light of a pixel, at the depth `own` of something dark, is that of the
 * brightest farther one beside it, whose disparity it gets. */
static bool is_outshone(const struct rf_silhouette_window *w, int x, int y, int own,
                        uint16_t *disparity)
{
    const struct rf_rect in = rf_around(w->view, x, y, 2);
    const int64_t light = known_light(w, x, y);
    int64_t far = 0, least = light;

    *disparity = 0;
    for (int py = in.y0; py < in.y1; py++)
        for (int px = in.x0; px < in.x1; px++) {
            const int d = w->disparity.at[py * w->light.stride + px];
            const bool beside = abs(px - x) <= 1 && abs(py - y) <= 1;
            const int64_t here = known_light(w, px, py);

            if (abs(d - own) <= JUMP) {
                least = here < least ? here : least;
            } else if (beside && d < own && here > far) {
                far = here;
                *disparity = (uint16_t)d;
            }
        }
    return far > light && least < RF_RUN_DARK && 2 * (light - least) * far >= light * (far - least);
}

/* Whether the bright pixel (x, y) belongs to a farther surface, whose disparity it gets. */
static bool belongs_to_background(const struct rf_silhouette_window *w,
                                  const struct rf_silhouette_run *run, int x, int y,
                                  uint16_t *disparity)
{
    const int own = w->disparity.at[y * w->light.stride + x];
    const struct rf_rect in = rf_around(w->view, x, y, RF_RUN_AROUND);
    int far = 0, nearest = 0;

    if (!has_far(w, rf_around(w->view, x, y, 1), own))
        return false;
    if (w->known && is_outshone(w, x, y, own, disparity))
        return true;
    if (!may_belong_to_background(run, x - run->x0, y, own))
        return false;
    for (int py = in.y0; py < in.y1; py++)
        for (int px = in.x0; px < in.x1; px++) {
            const ptrdiff_t q = py * w->light.stride + px;
            const int d = w->disparity.at[q];

            if (d >= own - JUMP || !is_bright(w, q) || !is_apart(w, px, py, own))
                continue;
            far++;
            nearest = d > nearest ? d : nearest;
        }
    *disparity = (uint16_t)nearest;
    return far >= FAR;
}

/* Whether pixel (x, y) is the silhouette of the one at n. */
static bool is_silhouette(const struct rf_silhouette_window *w, int x, int y, ptrdiff_t n)
{
    return w->disparity.at[y * w->light.stride + x] + JUMP < w->disparity.at[n] &&
           is_bright(w, n) && is_mixture(w, x, y, n) &&
           !(w->known && known_light(w, x, y) > known_light(w, (int)(n % w->light.stride),
                                                            (int)(n / w->light.stride)));
}

/* Whether it is the silhouette of one that is nearer than n, or as near and before it. */
static bool has_other(const struct rf_silhouette_window *w, int x, int y, ptrdiff_t n)
{
    const struct rf_rect in = rf_around(w->view, x, y, 1);

    for (int py = in.y0; py < in.y1; py++)
        for (int px = in.x0; px < in.x1; px++) {
            const ptrdiff_t q = py * w->light.stride + px;

            if ((w->disparity.at[q] > w->disparity.at[n] ||
                 (w->disparity.at[q] == w->disparity.at[n] && q < n)) &&
                is_silhouette(w, x, y, q))
                return true;
        }
    return false;
}

/* Adds the silhouette around a bright pixel beside something much farther: the pixels of which no
 * other bright pixel comes first. */
static void find_around(const struct rf_silhouette_window *w, const struct rf_silhouette_run *run,
                        int x, int y, struct rf_silhouettes *list)
{
    const ptrdiff_t n = y * w->light.stride + x;
    const struct rf_rect in = rf_around(w->view, x, y, 1);
    uint16_t background;

    if (belongs_to_background(w, run, x, y, &background)) {
        if (!has_other(w, x, y, n)) /* else it is a silhouette itself */
            add(w, list, x, y, background);
        return;
    }
    for (int py = in.y0; py < in.y1; py++)
        for (int px = in.x0; px < in.x1; px++)
            if (is_silhouette(w, px, py, n) && !has_other(w, px, py, n))
                add(w, list, px, py, w->disparity.at[n]);
}

/* Copies disparities of a row in a run, and one on each side. */
static void copy_row(const struct rf_silhouette_window *w, int x0, int y, int16_t row[RF_RUN + 2])
{
    const uint16_t *d = w->disparity.at + rf_within(y, w->view->height - 1) * w->light.stride;

    if (x0 > 0 && x0 + RF_RUN < w->view->width)
        for (int i = 0; i < RF_RUN + 2; i++)
            row[i] = rf_signed16(d[x0 - 1 + i]);
    else
        for (int i = 0; i < RF_RUN + 2; i++)
            row[i] = rf_signed16(d[rf_within(x0 - 1 + i, w->view->width - 1)]);
}

/* Pixels of a run that have something much farther beside them, a bit each. */
static uint32_t find_jumps(const struct rf_silhouette_window *w, int x0, int y)
{
    int16_t above[RF_RUN + 2], own[RF_RUN + 2], below[RF_RUN + 2], least[RF_RUN + 2];
    uint8_t jump[RF_RUN];
    uint32_t bits = 0, any = 0;

    copy_row(w, x0, y - 1, above);
    copy_row(w, x0, y, own);
    copy_row(w, x0, y + 1, below);
    for (int i = 0; i < RF_RUN + 2; i++)
        least[i] = rf_min16(own[i], rf_min16(above[i], below[i]));
    for (int i = 0; i < RF_RUN; i++) {
        const int16_t l = rf_min16(least[i + 1], rf_min16(least[i], least[i + 2]));

        jump[i] = (uint16_t)(own[i + 1] - l) > JUMP;
    }
    for (int i = 0; i < RF_RUN; i++)
        any |= jump[i];
    for (int i = 0; any && i < RF_RUN; i++)
        bits |= (uint32_t)jump[i] << i;
    return bits;
}

/* The pixels from `at` on that are bright, of those given, a bit each. */
static uint32_t bright_of(const struct rf_silhouette_window *w, ptrdiff_t at, uint32_t pixels)
{
    uint32_t bright = 0;

    for (; pixels; pixels &= pixels - 1)
        if (is_bright(w, at + __builtin_ctz(pixels)))
            bright |= pixels & -pixels;
    return bright;
}

/* The bright pixels of a run that have something much farther beside them, a bit each. */
static uint32_t candidates(const struct rf_executor *exec, const struct rf_silhouette_window *w,
                           int x0, int y, int n)
{
    uint16_t *const *const light = w->light.channel;
    const ptrdiff_t at = y * w->light.stride + x0;

    if (exec->kernels->brightest(light[0] + at, light[1] + at, light[2] + at, n) < LEVEL)
        return 0;
    return bright_of(w, at, find_jumps(w, x0, y) & (UINT32_MAX >> (RF_RUN - n)));
}

/* Finds the silhouettes of a run in rows from y0 on, of which `bits` has the candidates. */
static void find_in_run(const struct rf_executor *exec, const struct rf_silhouette_window *w,
                        struct rf_silhouette_run *run, int y0, const uint32_t *bits,
                        struct rf_silhouettes *list)
{
    run->next = INT_MIN;
    for (int y = y0; y < y0 + STRIP && !rf_cancelled(exec); y++) {
        uint32_t left = bits[y - y0];

        if (!left)
            continue;
        rf_run_go_to(w, y, run);
        left = rf_run_without_noise(run, y, left);
        if (left)
            rf_run_take_light(w, y, run);
        for (; left; left &= left - 1)
            find_around(w, run, run->x0 + __builtin_ctz(left), y, list);
    }
}

void rf_find_silhouettes(const struct rf_executor *exec, const struct rf_silhouette_window *w,
                         struct rf_rect part, struct rf_silhouettes *silhouettes)
{
    struct rf_silhouette_run run = {.next = 0};

    for (int y0 = part.y0; y0 < part.y1; y0 += STRIP)
        for (int x0 = part.x0; x0 < part.x1; x0 += RF_RUN * RUNS) {
            const int runs = rf_smaller((part.x1 - x0 + RF_RUN - 1) / RF_RUN, RUNS);
            uint32_t bits[RUNS][STRIP] = {{0}}, any[RUNS] = {0};

            if (rf_cancelled(exec))
                return;
            for (int y = y0; y < rf_smaller(y0 + STRIP, part.y1); y++)
                for (int k = 0; k < runs; k++) {
                    const int x = x0 + RF_RUN * k;

                    bits[k][y - y0] = candidates(exec, w, x, y, rf_smaller(part.x1 - x, RF_RUN));
                    any[k] |= bits[k][y - y0];
                }
            for (int k = 0; k < runs; k++) {
                run.x0 = x0 + RF_RUN * k;
                if (any[k])
                    find_in_run(exec, w, &run, y0, bits[k], silhouettes);
            }
        }
}
