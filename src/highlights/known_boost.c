/* known_boost.c: known light above white is added to what rays hit, where it is left to them and
 * where it is in focus. */
#include "highlights/known.h"

#include <stdlib.h>
#include <string.h>

#include "highlights/in_window.h"
#include "image/border.h"
#include "support/compare.h"

enum {
    REACH = 3, /* pixels that light left to the rays is spread over, each way */
    PATCH = RF_TILE + 2 * REACH,
    ALIKE = 256, /* Q7.8: how much blurs may differ that it is spread over */
};

/* Light above white of pixels in and around a tile, Q12. */
struct patch {
    int excess[3][PATCH * PATCH];
};

struct boost {
    const struct rf_executor *exec;
    const struct rf_highlight_window *window;
    struct rf_light_q12 smooth;
    struct rf_background background;
    double gap;
    int most;
};

bool rf_known_is_left(const struct rf_highlight_window *w, int tx, int ty)
{
    const struct rf_viewport *view = w->view;
    const int tiles_x = (view->photo_width + RF_TILE - 1) / RF_TILE;
    const int tiles_y = (view->photo_height + RF_TILE - 1) / RF_TILE;
    const int x = view->x0 / RF_TILE + tx, y = view->y0 / RF_TILE + ty;

    return x >= 0 && y >= 0 && x < tiles_x && y < tiles_y &&
           w->highlights->by_rays[y * tiles_x + x];
}

static bool is_near_left(const struct rf_highlight_window *w, int tx, int ty)
{
    for (int i = 0; i < 9; i++)
        if (rf_known_is_left(w, tx + i % 3 - 1, ty + i / 3 - 1))
            return true;
    return false;
}

/* Reads what is left to the rays in and around a tile of the window; 0 elsewhere. */
static void read_left(const struct rf_highlight_window *w, int tx, int ty, struct patch *patch)
{
    const struct rf_viewport *view = w->view;
    const int x0 = tx * RF_TILE - REACH, y0 = ty * RF_TILE - REACH;

    memset(patch, 0, sizeof *patch);
    for (int i = 0; i < 9; i++) {
        const int nx = tx + i % 3 - 1, ny = ty + i / 3 - 1;
        /* The part of that tile that lies in the patch and in the window. */
        const struct rf_rect part = {
            rf_larger(rf_larger(nx * RF_TILE, x0), 0), rf_larger(rf_larger(ny * RF_TILE, y0), 0),
            rf_smaller(rf_smaller((nx + 1) * RF_TILE, x0 + PATCH), view->width),
            rf_smaller(rf_smaller((ny + 1) * RF_TILE, y0 + PATCH), view->height)};

        for (int y = part.y0; y < part.y1 && rf_known_is_left(w, nx, ny); y++)
            for (int x = part.x0; x < part.x1; x++) {
                int excess[3];

                rf_known_excess(w->known, view->x0 + x, view->y0 + y, excess);
                for (int c = 0; c < 3; c++)
                    patch->excess[c][(y - y0) * PATCH + x - x0] = excess[c];
            }
    }
}

/* The mean of the patch over the pixels around one that are blurred as it is. */
static void mean_around(const struct boost *b, const struct patch *patch, int x, int y, int at,
                        int reach, int mean[3])
{
    const struct rf_viewport *view = b->window->view;
    const int own = rf_window_blur(b->window, x, y);
    int64_t sum[3] = {0, 0, 0};
    int count = 0;

    for (int v = rf_larger(-reach, -y); v <= rf_smaller(reach, view->height - 1 - y); v++)
        for (int u = rf_larger(-reach, -x); u <= rf_smaller(reach, view->width - 1 - x); u++) {
            if (u * u + v * v > reach * reach + 1 ||
                abs(rf_window_blur(b->window, x + u, y + v) - own) > ALIKE)
                continue;
            for (int c = 0; c < 3; c++)
                sum[c] += patch->excess[c][at + v * PATCH + u];
            count++;
        }
    for (int c = 0; c < 3; c++)
        mean[c] = (int)((sum[c] + count / 2) / count);
}

/* Adds light to a pixel. Returns the brightest of its channels. */
static int add_light(const struct boost *b, int x, int y, const int more[3])
{
    int brightest = 0;

    for (int c = 0; c < 3; c++) {
        uint16_t *light = &b->smooth.channel[c][y * b->smooth.stride + x];
        const int64_t sum = *light + (int64_t)more[c];

        *light = (uint16_t)(sum < b->most ? sum : b->most);
        brightest = rf_larger(brightest, *light);
    }
    return brightest;
}

/* Rays may find a pixel that nothing hides in the hidden background. */
static void copy_behind(const struct boost *b, int x, int y)
{
    const struct rf_background *const to = &b->background;

    if (to->blur.at[y * to->blur.stride + x] != b->window->blur.at[y * b->window->blur.stride + x])
        return;
    for (int c = 0; c < 3; c++)
        to->light.channel[c][y * to->light.stride + x] =
            b->smooth.channel[c][y * b->smooth.stride + x];
}

/* Adds their own light to pixels in focus. It shows where something before them is blurred: there
 * it is what some of the rays hit. */
static int boost_in_focus(const struct boost *b, int tx, int ty)
{
    const struct rf_highlight_window *w = b->window;
    const struct rf_viewport *view = w->view;
    const int x1 = rf_smaller((tx + 1) * RF_TILE, view->width);
    const int y1 = rf_smaller((ty + 1) * RF_TILE, view->height);
    int brightest = 0;

    for (int y = ty * RF_TILE; y < y1; y++)
        for (int x = tx * RF_TILE; x < x1; x++) {
            int own[3];

            if (abs(rf_window_blur(w, x, y)) >= RF_KNOWN_FROM)
                continue;
            rf_known_excess(w->known, view->x0 + x, view->y0 + y, own);
            brightest = rf_larger(brightest, add_light(b, x, y, own));
            copy_behind(b, x, y);
        }
    return brightest;
}

/* Light that is left to the rays and out of focus becomes the mean around. */
static int boost_left(const struct boost *b, int tx, int ty)
{
    const struct rf_highlight_window *w = b->window;
    const struct rf_viewport *view = w->view;
    const int x1 = rf_smaller((tx + 1) * RF_TILE, view->width);
    const int y1 = rf_smaller((ty + 1) * RF_TILE, view->height);
    struct patch patch;
    int brightest = 0;

    read_left(w, tx, ty, &patch);
    for (int y = ty * RF_TILE; y < y1; y++)
        for (int x = tx * RF_TILE; x < x1; x++) {
            const int at = (y % RF_TILE + REACH) * PATCH + x % RF_TILE + REACH;
            const int blur = abs(rf_window_blur(w, x, y));
            const int half = (int)(b->gap * blur / 512);
            int mean[3];

            if (blur < RF_KNOWN_FROM)
                continue;
            mean_around(b, &patch, x, y, at, half < REACH ? half : REACH, mean);
            brightest = rf_larger(brightest, add_light(b, x, y, mean));
        }
    return brightest;
}

static void boost_tile(void *context, int item, int worker)
{
    const struct boost *b = context;
    const struct rf_highlight_window *w = b->window;
    const int tx = item % w->view->tiles_x, ty = item / w->view->tiles_x;
    uint16_t *const brightest = &w->bins[item].brightest;

    (void)worker;
    *brightest = (uint16_t)rf_larger(*brightest, boost_in_focus(b, tx, ty));
    if (is_near_left(w, tx, ty))
        *brightest = (uint16_t)rf_larger(*brightest, boost_left(b, tx, ty));
}

/* Rays read beyond the window's sides, too. */
static void extend_band(void *context, int band, int worker)
{
    const struct boost *b = context;
    const struct rf_viewport *view = b->window->view;

    (void)worker;
    for (int c = 0; c < 3; c++) {
        rf_extend_rows(view, b->smooth.channel[c], b->smooth.stride, rf_band_start(band),
                       rf_band_end(view, band));
        rf_extend_rows(view, b->background.light.channel[c], b->background.light.stride,
                       rf_band_start(band), rf_band_end(view, band));
    }
}

void rf_boost_known(const struct rf_executor *exec, const struct rf_highlight_window *window,
                    struct rf_light_q12 smooth, struct rf_background background, double gap,
                    int most)
{
    struct boost boost = {exec, window, smooth, background, gap, most};

    rf_pool_run(exec->pool, boost_tile, &boost, window->view->tiles_x * window->view->tiles_y);
    rf_pool_run(exec->pool, extend_band, &boost, rf_bands(window->view));
}

void rf_raise_known(const struct rf_executor *exec, const struct rf_highlight_window *window,
                    const struct rf_foreground_cells *foreground)
{
    const struct rf_viewport *view = window->view;

    for (int ty = 0; ty < view->tiles_y && !rf_cancelled(exec); ty++)
        for (int tx = 0; tx < view->tiles_x; tx++)
            if (rf_known_is_left(window, tx, ty))
                rf_force_foreground(view, foreground,
                                    (struct rf_rect){tx * RF_TILE - REACH, ty * RF_TILE - REACH,
                                                     (tx + 1) * RF_TILE + REACH,
                                                     (ty + 1) * RF_TILE + REACH});
}
