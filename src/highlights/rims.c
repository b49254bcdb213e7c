#include "highlights/rims.h"

#include <stdbool.h>
#include <stdlib.h>

#include "focus/focus.h"
#include "highlights/clipped.h"
#include "image/viewport.h"
#include "renderer/renderer.h"
#include "support/places.h"
#include "tiles/ranges.h"
#include "tiles/tiles.h"

enum {
    JUMP = 65535 / 32,             /* disparities this far apart are two surfaces */
    LEVEL = RF_LIGHT_MAX * 9 / 10, /* clipped, or nearly */
    CONTRAST = RF_LIGHT_MAX / 2,   /* least |N - F| */
    DARK = RF_LIGHT_MAX / 2,
    AROUND = 6, /* pixels on each side that tell whose light it is */
    FAR = 3,
};

static bool is_bright(const struct refocus_renderer *r, ptrdiff_t at)
{
    return rf_brightest_at(r, at) >= LEVEL;
}

/* Whether pixel (x, y) is the rim of the bright, nearer pixel at n. */
static bool is_rim(const struct refocus_renderer *r, int x, int y, ptrdiff_t n)
{
    const ptrdiff_t p = y * r->view.stride + x;
    const int middle = (r->disparity.at[p] + r->disparity.at[n]) / 2;
    int64_t sum[3] = {0, 0, 0}, along = 0, contrast = 0, own = 0;
    int count = 0;

    for (int j = -2; j <= 2; j++) {
        for (int i = -2; i <= 2; i++) {
            const ptrdiff_t q = rf_within(y + j, r->view.height - 1) * r->view.stride +
                                rf_within(x + i, r->view.width - 1);

            if ((i > -2 && i < 2 && j > -2 && j < 2) || r->disparity.at[q] > middle)
                continue;
            count++;
            for (int c = 0; c < 3; c++)
                sum[c] += r->light.channel[c][q];
        }
    }
    if (!count)
        return false;
    for (int c = 0; c < 3; c++) {
        const int64_t far = sum[c] / count, near = r->light.channel[c][n];

        along += (r->light.channel[c][p] - far) * (near - far);
        contrast += (near - far) * (near - far);
        own += r->light.channel[c][p] * (near - far);
    }
    return contrast >= (int64_t)CONTRAST * CONTRAST && 20 * along > contrast && 5 * along > 2 * own;
}

static void add_rim(const struct refocus_renderer *r, struct rf_photo *photo, int x, int y,
                    uint16_t disparity)
{
    const struct rf_rim rim = {(uint16_t)(x + r->view.x0), (uint16_t)(y + r->view.y0), disparity};

    rf_add_place(photo->rim, &photo->rims, photo->capacity, &rim, sizeof rim);
}

/* Whether a bright pixel farther than `own` has none of that depth beside it: it is no rim. */
static bool is_apart(const struct refocus_renderer *r, int x, int y, int own)
{
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) {
            const ptrdiff_t q = rf_within(y + j, r->view.height - 1) * r->view.stride +
                                rf_within(x + i, r->view.width - 1);

            if (abs(r->disparity.at[q] - own) <= JUMP && is_bright(r, q))
                return false;
        }
    return true;
}

/* Whether there are bright ones that are farther. */
static bool has_far(const struct refocus_renderer *r, struct rf_rect in, int own)
{
    for (int y = in.y0; y < in.y1; y++)
        for (int x = in.x0; x < in.x1; x++)
            if (r->disparity.at[y * r->view.stride + x] < own - JUMP &&
                is_bright(r, y * r->view.stride + x))
                return true;
    return false;
}

/* Whether half as many pixels there as are bright at that depth are dark at it, and there are
 * bright ones that are farther. */
static bool may_be_behind(const struct refocus_renderer *r, struct rf_rect in, int own)
{
    int dark = 0, bright = 0, far = 0;

    for (int y = in.y0; y < in.y1; y++)
        for (int x = in.x0; x < in.x1; x++) {
            const ptrdiff_t q = y * r->view.stride + x;
            const int away = r->disparity.at[q] - own, light = rf_brightest_at(r, q);

            dark += light < DARK && abs(away) <= JUMP;
            bright += light >= LEVEL && abs(away) <= JUMP;
            far += light >= LEVEL && away < -JUMP;
        }
    return far >= FAR && 2 * dark >= bright;
}

/* Whether the bright pixel (x, y) is of something farther, whose disparity it gets. */
static bool is_behind(const struct refocus_renderer *r, int x, int y, uint16_t *disparity)
{
    const int own = r->disparity.at[y * r->view.stride + x];
    const struct rf_rect in = rf_around(&r->view, x, y, AROUND);
    int far = 0, behind = 0;

    if (!has_far(r, rf_around(&r->view, x, y, 1), own) || !may_be_behind(r, in, own))
        return false;
    for (int py = in.y0; py < in.y1; py++)
        for (int px = in.x0; px < in.x1; px++) {
            const ptrdiff_t q = py * r->view.stride + px;
            const int d = r->disparity.at[q];

            if (d >= own - JUMP || !is_bright(r, q) || !is_apart(r, px, py, own))
                continue;
            far++;
            behind = d > behind ? d : behind;
        }
    *disparity = (uint16_t)behind;
    return far >= FAR;
}

/* Whether pixel (x, y) is the rim of the one at n. */
static bool has_rim(const struct refocus_renderer *r, int x, int y, ptrdiff_t n)
{
    return r->disparity.at[y * r->view.stride + x] + JUMP < r->disparity.at[n] && is_bright(r, n) &&
           is_rim(r, x, y, n);
}

/* Whether it is that of one that is nearer than n, or as near and before it. */
static bool has_other(const struct refocus_renderer *r, int x, int y, ptrdiff_t n)
{
    const struct rf_rect in = rf_around(&r->view, x, y, 1);

    for (int py = in.y0; py < in.y1; py++)
        for (int px = in.x0; px < in.x1; px++) {
            const ptrdiff_t q = py * r->view.stride + px;

            if ((r->disparity.at[q] > r->disparity.at[n] ||
                 (r->disparity.at[q] == r->disparity.at[n] && q < n)) &&
                has_rim(r, x, y, q))
                return true;
        }
    return false;
}

/* The rims around a bright pixel beside something much farther, of each the nearest pixel that has
 * it. */
static void find_around(const struct refocus_renderer *r, int x, int y, struct rf_photo *photo)
{
    const ptrdiff_t n = y * r->view.stride + x;
    const struct rf_rect in = rf_around(&r->view, x, y, 1);
    uint16_t behind;

    if (is_behind(r, x, y, &behind)) {
        if (!has_other(r, x, y, n)) /* else it is a rim itself */
            add_rim(r, photo, x, y, behind);
        return;
    }
    for (int py = in.y0; py < in.y1; py++)
        for (int px = in.x0; px < in.x1; px++)
            if (has_rim(r, px, py, n) && !has_other(r, px, py, n))
                add_rim(r, photo, px, py, r->disparity.at[n]);
}

enum { RUN = 32 }; /* most runs of pixels hold nothing bright at a jump */

/* Disparities of a row in a run, and one on each side. Signed: baseline x86 has signed 16-bit
 * extremes only. */
static void take_row(const struct refocus_renderer *r, int x0, int y, int16_t row[RUN + 2])
{
    const uint16_t *d = r->disparity.at + rf_within(y, r->view.height - 1) * r->view.stride;

    if (x0 > 0 && x0 + RUN < r->view.width)
        for (int i = 0; i < RUN + 2; i++)
            row[i] = (int16_t)(d[x0 - 1 + i] ^ 0x8000);
    else
        for (int i = 0; i < RUN + 2; i++)
            row[i] = (int16_t)(d[rf_within(x0 - 1 + i, r->view.width - 1)] ^ 0x8000);
}

static inline int16_t min16(int16_t a, int16_t b)
{
    return a < b ? a : b;
}

/* Pixels of a run that have something much farther beside them, a bit each. */
static uint32_t find_jumps(const struct refocus_renderer *r, int x0, int y)
{
    int16_t above[RUN + 2], own[RUN + 2], below[RUN + 2], least[RUN + 2];
    uint8_t jump[RUN];
    uint32_t bits = 0, any = 0;

    take_row(r, x0, y - 1, above);
    take_row(r, x0, y, own);
    take_row(r, x0, y + 1, below);
    for (int i = 0; i < RUN + 2; i++)
        least[i] = min16(own[i], min16(above[i], below[i]));
    for (int i = 0; i < RUN; i++) {
        const int16_t l = min16(least[i + 1], min16(least[i], least[i + 2]));

        jump[i] = (uint16_t)(own[i + 1] - l) > JUMP;
    }
    for (int i = 0; i < RUN; i++)
        any |= jump[i];
    for (int i = 0; any && i < RUN; i++)
        bits |= (uint32_t)jump[i] << i;
    return bits;
}

void rf_find_rims(struct refocus_renderer *r, struct rf_rect part)
{
    struct rf_photo *photo = &r->photo;

    for (int y = part.y0; y < part.y1; y++) {
        const ptrdiff_t at = y * r->view.stride;

        if (rf_cancelled(&r->exec))
            return;
        for (int x0 = part.x0; x0 < part.x1; x0 += RUN) {
            const int n = part.x1 - x0 < RUN ? part.x1 - x0 : RUN;
            uint32_t bits;

            if (r->exec.kernels->brightest(r->light.channel[0] + at + x0,
                                           r->light.channel[1] + at + x0,
                                           r->light.channel[2] + at + x0, n) < LEVEL)
                continue;
            bits = find_jumps(r, x0, y) & (UINT32_MAX >> (RUN - n));
            if (bits && rf_cancelled(&r->exec))
                return;
            for (; bits; bits &= bits - 1) {
                const int x = x0 + __builtin_ctz(bits);

                if (is_bright(r, at + x))
                    find_around(r, x, y, photo);
            }
        }
    }
}

void rf_patch_rims(struct refocus_renderer *r, const struct rf_focus_plan *plan,
                   struct rf_bin_scale scale)
{
    const struct rf_photo *photo = &r->photo;

    for (uint32_t i = 0; i < photo->rims; i++) {
        const struct rf_rim *rim = &photo->rim[i];
        const int x = rim->x - r->view.x0, y = rim->y - r->view.y0;
        int16_t *s = r->blur.at + y * r->view.stride + x;

        if (i % 1024 == 0 && rf_cancelled(&r->exec))
            return;
        if (x < 0 || y < 0 || x >= r->view.width || y >= r->view.height)
            continue;
        rf_focus_row(plan, s, &rim->disparity, rim->x, rim->y, 1);
        rf_add_bin(&r->view, r->bins, scale, x, y, *s);
        rf_add_to_cell(&r->cells, x, y, *s);
    }
}
