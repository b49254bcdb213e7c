#include "passes/planes.h"

#include <math.h>
#include <string.h>

void rf_signed_blur_rows(struct refocus_renderer *r, const struct rf_focus_plan *plan, int y0,
                         int y1)
{
    for (int y = y0; y < y1; y++) {
        int16_t *blur = r->blur.at + y * r->view.stride;
        const uint16_t *disparity = r->disparity.at + y * r->view.stride;

        if (plan->plain)
            r->exec.kernels->signed_blur(blur, disparity, plan->focus, r->view.width);
        else
            rf_focus_row(plan, blur, disparity, r->view.x0, r->view.y0 + y, r->view.width);
    }
    rf_extend_rows(&r->view, r->blur.at, r->view.stride, y0, y1);
}

/* Whether a tile holds blurs above `least`. */
static bool is_wide(const struct refocus_renderer *r, int tx, int ty, int least)
{
    const struct rf_bins *bins = &r->bins[(size_t)ty * r->view.tiles_x + tx];

    return bins->most > least || -bins->least > least;
}

enum { RUN = 256, MARGIN = 1 << (RF_PREFILTER_STEPS - 1) }; /* columns at a time */

/* n columns of a row, from `at` on, n at most RUN: three rows to one, then columns. */
static void smooth_run(const struct refocus_renderer *r, uint16_t *const out[3],
                       uint16_t *const in[3], ptrdiff_t at, int step, int least, int over, int n)
{
    const ptrdiff_t from = at - step;
    const int16_t *s = r->blur.at;
    uint16_t row[3][RUN + 2 * MARGIN];

    r->exec.kernels->smooth3((uint16_t *const[3]){row[0], row[1], row[2]},
                             (const uint16_t *const[3]){in[0] + from, in[1] + from, in[2] + from},
                             s + from, step * r->view.stride, least, over, n + 2 * step);
    r->exec.kernels->smooth3(
        (uint16_t *const[3]){out[0] + at, out[1] + at, out[2] + at},
        (const uint16_t *const[3]){row[0] + step, row[1] + step, row[2] + step}, s + at, step,
        least, over, n);
}

static bool is_wide_near(const struct refocus_renderer *r, int tx, int ty, int least)
{
    for (int y = ty - 1; y <= ty + 1; y++)
        for (int x = tx - 1; x <= tx + 1; x++)
            if (x >= 0 && x < r->view.tiles_x && y >= 0 && y < r->view.tiles_y &&
                is_wide(r, x, y, least))
                return true;
    return false;
}

/* Steps 1 and 2 are there and back between two planes, so that tiles that step 1 leaves alone need
 * not be moved at all, but where step 2 looks at them. */
enum rf_task rf_prefilter_task(const struct refocus_renderer *r, const int above[], int step,
                               int tx, int ty)
{
    if (is_wide(r, tx, ty, above[step]))
        return RF_FILTER;
    if (step == 0 || (step == 1 && is_wide_near(r, tx, ty, above[1])) ||
        (step == 2 && is_wide(r, tx, ty, above[1])))
        return RF_COPY;
    return RF_SKIP;
}

static void do_task(const struct refocus_renderer *r, enum rf_task task, uint16_t *const out[3],
                    uint16_t *const in[3], ptrdiff_t at, int step, int least, int over, int n)
{
    for (int x = 0; task == RF_FILTER && x < n; x += RUN)
        smooth_run(r, out, in, at + x, 1 << step, least, over, n - x < RUN ? n - x : RUN);
    for (int c = 0; task == RF_COPY && c < 3; c++)
        memcpy(out[c] + at, in[c] + at, (size_t)n * 2);
}

void rf_prefilter_rows(struct refocus_renderer *r, uint16_t *const out[3], uint16_t *const in[3],
                       const int above[RF_PREFILTER_STEPS], bool fades, int step, int ty)
{
    const int over = rf_prefilter_over(above[step], fades);
    const struct rf_bins *bins = r->bins + (size_t)ty * r->view.tiles_x;
    const int y0 = ty * RF_TILE, y1 = y0 + RF_TILE < r->view.height ? y0 + RF_TILE : r->view.height;

    for (int tx = 0, end; tx < r->view.tiles_x; tx = end) {
        const enum rf_task task = rf_prefilter_task(r, above, step, tx, ty);
        const bool taken = step == 0 && bins[tx].taken;
        const int x0 = tx * RF_TILE;
        int n;

        for (end = tx + 1; end < r->view.tiles_x &&
                           rf_prefilter_task(r, above, step, end, ty) == task &&
                           taken == (step == 0 && bins[end].taken);)
            end++;
        n = (end * RF_TILE < r->view.width ? end * RF_TILE : r->view.width) - x0;
        for (int y = y0; y < y1; y++)
            do_task(r, task, out, taken ? r->background.light.channel : in, y * r->view.stride + x0,
                    step, above[step], over, n);
    }
    for (int c = 0; c < 3; c++)
        rf_extend_rows(&r->view, out[c], r->view.stride, y0, y1);
}
