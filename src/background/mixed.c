/* mixed.c: leaves out of the background the pixels that the photo mixes with what hides it. */
#include "background/mark.h"

#include <stdlib.h>

#include "kernels/kernels.h"
#include "support/compare.h"

enum { STEP = 4 << 8 }; /* Q7.8; mark.h */

/* A pixel and what lies around it. */
struct site {
    const struct rf_viewport *view;
    const struct rf_mark *mark;
    int step; /* STEP, as blurs are stored */
    int x, y;
    const int16_t *blur;
    ptrdiff_t light; /* index of its light */
};

static inline int16_t lesser(int16_t a, int16_t b)
{
    return a < b ? a : b;
}

static bool is_hiding(int blur, int other, int step)
{
    return blur - other > step && blur + other < 0;
}

/* The distance of the light of two pixels that lie so far from the site. */
static int distance(const struct site *site, ptrdiff_t a, ptrdiff_t b)
{
    int sum = 0;

    for (int c = 0; c < site->mark->planes; c++) {
        const uint16_t *light = site->mark->smooth.channel[c] + site->light;

        sum += abs(light[a] - light[b]);
    }
    return sum;
}

/* Whether the surface of the site goes on there. */
static bool goes_on(const struct site *site, ptrdiff_t at)
{
    return rf_clamp(site->blur[at] - *site->blur, 0, site->step) == site->blur[at] - *site->blur;
}

/* Whether the pixel there is beside one that hides the surface of the site. */
static bool is_beside(const struct site *site, ptrdiff_t at)
{
    const ptrdiff_t stride = site->mark->blur.stride;

    for (ptrdiff_t y = at - stride; y <= at + stride; y += stride)
        if (is_hiding(*site->blur, site->blur[y - 1], site->step) ||
            is_hiding(*site->blur, site->blur[y], site->step) ||
            is_hiding(*site->blur, site->blur[y + 1], site->step))
            return true;
    return false;
}

/* Whether the site is a mixture of the pixels before and behind it in a direction. */
static bool is_mixed(const struct site *site, int dx, int dy)
{
    const int far_x = site->x - 2 * dx, far_y = site->y - 2 * dy;
    const ptrdiff_t out = -(dy * site->mark->blur.stride + dx);
    const ptrdiff_t away = -(dy * site->mark->smooth.stride + dx);
    int change;

    if (far_x < 0 || far_x >= site->view->width || far_y < 0 || far_y >= site->view->height)
        return false;
    if (!is_hiding(*site->blur, site->blur[-2 * out], site->step) || !goes_on(site, out) ||
        !goes_on(site, 2 * out) || is_beside(site, 2 * out))
        return false;
    change = distance(site, 0, away);
    return change > 4 * distance(site, away, 2 * away) &&
           8 * (change + distance(site, 0, -away)) <= 9 * distance(site, away, -away);
}

/* Whether it is one in at least half of the directions in which something hides it. */
static bool is_mixture(const struct site *site)
{
    int sides = 0, mixed = 0;

    for (int dy = -1; dy <= 1; dy++)
        for (int dx = -1; dx <= 1; dx++)
            if (is_hiding(*site->blur, site->blur[dy * site->mark->blur.stride + dx], site->step)) {
                sides++;
                mixed += is_mixed(site, dx, dy);
            }
    return mixed > 0 && 2 * mixed >= sides;
}

/* Whether any of a row of a tile's pixels has such a neighbour. */
static bool has_sites(const int16_t *blur, ptrdiff_t stride, int step)
{
    int16_t least[RF_TILE + 2]; /* blur of three rows */
    uint16_t found = 0;

    for (int i = 0; i < RF_TILE + 2; i++) {
        const int16_t *at = blur + i - 1;

        least[i] = lesser(lesser(at[-stride], at[stride]), *at);
    }
    for (int i = 0; i < RF_TILE; i++) {
        const int16_t nearest = lesser(lesser(least[i], least[i + 1]), least[i + 2]);

        found |= (uint16_t)((uint16_t)(blur[i] - nearest) > step) &
                 (uint16_t)(nearest < (int16_t)-blur[i]);
    }
    return found;
}

static void leave_row(struct site *site, int x0, int y)
{
    const struct rf_mark *mark = site->mark;
    const int16_t *row = mark->blur.at + y * mark->blur.stride;
    int16_t *out = mark->background.blur.at + y * mark->background.blur.stride;
    const int end = rf_smaller(x0 + RF_TILE, site->view->width);

    if (!has_sites(row + x0, mark->blur.stride, site->step))
        return;
    site->y = y;
    for (int x = x0; x < end; x++) {
        site->x = x;
        site->blur = row + x;
        site->light = y * mark->smooth.stride + x;
        if (out[x] != RF_NO_BLUR && is_beside(site, 0) && is_mixture(site))
            out[x] = RF_NO_BLUR;
    }
}

/* The least blur of a tile and those around it. */
static int least_around(const struct rf_viewport *view, const struct rf_bins *bins, int tx, int ty)
{
    int least = INT16_MAX;

    for (int y = rf_larger(ty - 1, 0); y <= rf_smaller(ty + 1, rf_bands(view) - 1); y++)
        for (int x = rf_larger(tx - 1, 0); x <= rf_smaller(tx + 1, view->tiles_x - 1); x++)
            least = rf_smaller(least, bins[y * view->tiles_x + x].least);
    return least;
}

void rf_background_leave_mixed(const struct rf_viewport *view, const struct rf_mark *mark, int band)
{
    struct site site = {.view = view, .mark = mark, .step = STEP >> mark->blur.unit};

    for (int tx = 0; tx < view->tiles_x; tx++) {
        const int least = least_around(view, mark->bins, tx, band);

        if (least >= 0 || mark->bins[band * view->tiles_x + tx].most - least <= site.step)
            continue;
        for (int y = rf_band_start(band); y < rf_band_end(view, band); y++)
            leave_row(&site, tx * RF_TILE, y);
    }
}
