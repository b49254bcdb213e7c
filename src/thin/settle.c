/* settle.c: gives the pixels at the silhouettes of the caller's matte the disparity of the side
 * that it says they are on: maps are softer than mattes, and lie beside them.
 *
 * Deep in a side is a pixel with none of another side DEEP or fewer pixels away. A pixel that is
 * sure to be on a side keeps its disparity if a deep one within REACH has it, too, and else gets
 * that of the nearest deep one. Where there is none, as in hair, it keeps its own, unless a pixel
 * beside it that is on the other side has the same: then the map has lost one of the two, and it is
 * lost.
 */
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "focus/focus.h"
#include "thin/mixture.h"

enum { DEEP = 6, REACH = 10, BESIDE = 3 };

static void read_band(void *context, int band, int worker)
{
    const struct rf_matte_pass *pass = context;
    const struct rf_viewport *view = pass->view;

    (void)worker;
    for (int y = rf_band_start(band); y < rf_band_end(view, band); y++)
        for (int x = 0; x < view->width; x++)
            pass->alpha.at[y * pass->alpha.stride + x] =
                (uint16_t)((rf_map_at(pass->matte, view->width, view->height, x, y) + 128) / 257);
}

/* Finds what is deep, by the least and the greatest alpha around each pixel, down and then across.
 */
static void deepen_band(void *context, int band, int worker)
{
    const struct rf_matte_pass *pass = context;
    const int width = pass->view->width, bottom = pass->view->height - 1;
    uint16_t *restrict least = rf_scratch(pass->exec, worker), *restrict most = least + width;

    for (int y = rf_band_start(band); y < rf_band_end(pass->view, band); y++) {
        memset(least, 255, (size_t)width * sizeof *least);
        memset(most, 0, (size_t)width * sizeof *most);
        for (int v = rf_within(y - DEEP, bottom); v <= rf_within(y + DEEP, bottom); v++) {
            const uint16_t *restrict alpha = pass->alpha.at + v * pass->alpha.stride;

            for (int x = 0; x < width; x++) {
                least[x] = alpha[x] < least[x] ? alpha[x] : least[x];
                most[x] = alpha[x] > most[x] ? alpha[x] : most[x];
            }
        }
        for (int x = 0, ones = DEEP, zeros = DEEP; x < width + DEEP; x++) { /* in a row */
            ones = x >= width || rf_is_sure(least[x], true) ? ones + 1 : 0;
            zeros = x >= width || rf_is_sure(most[x], false) ? zeros + 1 : 0;
            if (x >= DEEP)
                pass->near.at[y * pass->near.stride + x - DEEP] =
                    ones > 2 * DEEP || zeros > 2 * DEEP;
        }
    }
}

static bool is_same(int a, int b)
{
    return abs(a - b) <= RF_SURFACE_JUMP;
}

/* The disparity of a pixel; lost: it is not known. */
static uint16_t settled(const struct rf_matte_pass *pass, bool near, int x, int y, bool *lost)
{
    const struct rf_rect in = rf_around(pass->view, x, y, REACH);
    const uint16_t own = pass->disparity.at[y * pass->disparity.stride + x];
    int nearest = INT_MAX;
    uint16_t found = own;
    bool other = false;

    for (int v = in.y0; v < in.y1; v++)
        for (int u = in.x0; u < in.x1; u++) {
            const int alpha = pass->alpha.at[v * pass->alpha.stride + u];
            const int away = (u - x) * (u - x) + (v - y) * (v - y);
            const uint16_t d = pass->disparity.at[v * pass->disparity.stride + u];

            other |= away <= BESIDE * BESIDE && rf_is_sure(alpha, !near) && is_same(d, own);
            if (!pass->near.at[v * pass->near.stride + u] || !rf_is_sure(alpha, near))
                continue;
            if (is_same(d, own))
                return own;
            if (away < nearest) {
                nearest = away;
                found = d;
            }
        }
    *lost = other && nearest == INT_MAX;
    return found;
}

static void settle_band(void *context, int band, int worker)
{
    const struct rf_matte_pass *pass = context;

    (void)worker;
    for (int y = rf_band_start(band); y < rf_band_end(pass->view, band); y++)
        for (int x = 0; x < pass->view->width; x++) {
            const int alpha = pass->alpha.at[y * pass->alpha.stride + x];
            const bool near = alpha >= 128, deep = pass->near.at[y * pass->near.stride + x];
            bool lost = false;

            pass->far.at[y * pass->far.stride + x] =
                rf_is_sure(alpha, near) && !deep
                    ? settled(pass, near, x, y, &lost)
                    : pass->disparity.at[y * pass->disparity.stride + x];
            pass->lost.at[y * pass->lost.stride + x] = lost;
        }
}

static void take_band(void *context, int band, int worker)
{
    const struct rf_matte_pass *pass = context;

    (void)worker;
    for (int y = rf_band_start(band); y < rf_band_end(pass->view, band); y++)
        memcpy(pass->disparity.at + y * pass->disparity.stride, pass->far.at + y * pass->far.stride,
               (size_t)pass->view->width * sizeof *pass->far.at);
}

void rf_settle_sides(const struct rf_matte_pass *pass)
{
    rf_work_fn *const work[] = {read_band, deepen_band, settle_band, take_band};

    for (size_t i = 0; i < sizeof work / sizeof *work; i++)
        rf_pool_run(pass->exec->pool, work[i], (void *)pass, rf_bands(pass->view));
}
