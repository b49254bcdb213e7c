#include "thin/thin.h"

#include <stdlib.h>
#include <string.h>

#include "thin/veil.h"
#include "focus/focus.h"
#include "gather/frame.h"
#include "passes/planes.h"
#include "image/viewport.h"
#include "renderer/renderer.h"
#include "tiles/ranges.h"

enum { CELLS = RF_TILE / RF_CELL };

const struct rf_thin_run *rf_thin_run_of(const struct refocus_renderer *r, int tx, int ty)
{
    const struct rf_photo *photo = &r->photo;
    const int row = ty + r->view.y0 / RF_TILE, column = tx + r->view.x0 / RF_TILE;
    const int across = (photo->width + RF_TILE - 1) / RF_TILE;

    return &photo->thin.run[(size_t)row * across + column];
}

struct rf_thin *rf_thin_of(const struct refocus_renderer *r, int tx, int ty, uint32_t *count)
{
    const struct rf_photo *photo = &r->photo;
    const struct rf_thin_run *run = rf_thin_run_of(r, tx, ty);
    const int row = ty + r->view.y0 / RF_TILE;

    *count = run->count;
    return photo->thin.pixel + (uint64_t)row * rf_thin_capacity(photo->width) + run->first;
}

struct rf_apart *rf_apart_of(const struct refocus_renderer *r, int tx, int ty)
{
    return &r->veil.apart[(size_t)ty * r->view.tiles_x + tx];
}

bool rf_takes_apart(const struct rf_frame *f)
{
    return f->veils || f->holds;
}

/* Whether a tile holds some cells all of which is as near as a blur: nothing thin fills
 * many. */
static bool is_filled(const struct refocus_renderer *r, int tx, int ty, int blur)
{
    enum { FEW = 3 };
    int filled = 0;

    for (int j = 0; j < CELLS; j++) {
        const int16_t *most = rf_cell_most(r, ty * CELLS + j) + tx * CELLS;

        for (int i = 0; i < CELLS; i++)
            filled += most[i] <= blur;
    }
    return filled > FEW;
}

/* Whether nothing that is nearly as near as a blur reaches a tile, but for what is
 * thin: what is drawn is laid over all. */
static bool is_alone(const struct refocus_renderer *r, int tx, int ty, int blur)
{
    const int reach = (abs(blur) + 256 * RF_TILE - 1) / (256 * RF_TILE);

    for (int y = ty - reach; y <= ty + reach; y++)
        for (int x = tx - reach; x <= tx + reach; x++)
            if (x >= 0 && y >= 0 && x < r->view.tiles_x && y < r->view.tiles_y &&
                is_filled(r, x, y, blur * 3 / 4))
                return false;
    return true;
}

/* Whether all of a tile are, or none, as far as its run can say. */
static bool are_all_veils(const struct rf_frame *f, const struct rf_thin_run *run)
{
    return f->plan.plain && run->least >= f->thin_bounds[RF_THIN_LEVELS - 1].veil_from;
}

static bool is_no_veil(const struct rf_frame *f, const struct rf_thin_run *run)
{
    return f->plan.plain && run->most < f->thin_bounds[0].veil_from;
}

/* Of those of a tile that are to be drawn the farthest near disparity; 65536: none. */
static int farthest_veil(const struct rf_frame *f, int tx, int ty)
{
    const struct rf_thin_run *run = rf_thin_run_of(f->r, tx, ty);
    uint32_t count;
    const struct rf_thin *thin = rf_thin_of(f->r, tx, ty, &count);
    int least = 65536;

    if (count == 0 || is_no_veil(f, run))
        return least;
    if (are_all_veils(f, run))
        return run->least;
    for (uint32_t i = 0; i < count; i++)
        if (rf_is_veil(f, &thin[i], tx, ty) && thin[i].near_disparity < least)
            least = thin[i].near_disparity;
    return least;
}

static void choose_veils(const struct rf_frame *f, int tx, int ty, struct rf_apart *apart)
{
    const bool all = are_all_veils(f, rf_thin_run_of(f->r, tx, ty));
    const int d = farthest_veil(f, tx, ty);
    uint32_t count;
    const struct rf_thin *thin = rf_thin_of(f->r, tx, ty, &count);

    if (d > 65535 ||
        !is_alone(f->r, tx, ty, rf_thin_blur(f, (uint16_t)d, tx * RF_TILE, ty * RF_TILE)))
        return;
    apart->veils = true;
    for (uint32_t i = 0; i < count; i++)
        if (all || rf_is_veil(f, &thin[i], tx, ty))
            apart->veil[i / 64] |= UINT64_C(1) << i % 64;
}

static void choose_band(void *context, int band, int worker)
{
    const struct rf_frame *f = context;

    (void)worker;
    f->r->veil.swapped[band] = false;
    for (int tx = 0; tx < f->r->view.tiles_x; tx++) {
        struct rf_apart *apart = rf_apart_of(f->r, tx, band);

        *apart = (struct rf_apart){.veils = false};
        if (f->veils)
            choose_veils(f, tx, band, apart);
        if (f->holds)
            rf_choose_held(f, tx, band, apart);
    }
}

static bool is_any(const struct rf_apart *apart)
{
    return apart->veils || apart->held;
}

static bool is_apart(const struct rf_apart *apart, uint32_t i)
{
    return rf_has_bit(apart->veil, i) || rf_has_bit(apart->hold, i);
}

/* F's blur where what is before it is drawn. */
static void patch_tile(const struct rf_frame *f, int tx, int ty)
{
    const struct refocus_renderer *r = f->r;
    const struct rf_apart *apart = rf_apart_of(r, tx, ty);
    uint32_t count;
    const struct rf_thin *thin = rf_thin_of(r, tx, ty, &count);

    for (uint32_t i = 0; i < count; i++) {
        const int x = tx * RF_TILE + thin[i].at % RF_TILE;
        const int y = ty * RF_TILE + thin[i].at / RF_TILE;

        if (is_apart(apart, i))
            r->blur.at[y * r->view.stride + x] =
                (int16_t)rf_thin_blur(f, thin[i].far_disparity, x, y);
    }
}

static void patch_band(void *context, int band, int worker)
{
    const struct rf_frame *f = context;
    struct refocus_renderer *r = f->r;
    bool any = false;

    (void)worker;
    for (int tx = 0; tx < r->view.tiles_x; tx++) {
        if (!is_any(rf_apart_of(r, tx, band)))
            continue;
        any = true;
        patch_tile(f, tx, band);
    }
    if (!any)
        return;
    rf_extend_rows(&r->view, r->blur.at, rf_band_start(band), rf_band_end(&r->view, band));
    rf_cell_rows(r, band);
    rf_bin_tiles(r, f->scale, band);
}

void rf_take_thin_apart(struct rf_frame *f)
{
    rf_pool_run(&f->r->pool, choose_band, f, rf_bands(&f->r->view));
    rf_pool_run(&f->r->pool, patch_band, f, rf_bands(&f->r->view));
    if (f->veils)
        rf_veil_draw(f);
}

void rf_sharp_means(const struct rf_frame *f, int tx, int ty, uint16_t mean[3][RF_TILE * RF_TILE])
{
    const struct refocus_renderer *r = f->r;
    const ptrdiff_t at = ty * RF_TILE * r->view.stride + tx * RF_TILE;
    const struct rf_apart *apart = rf_apart_of(r, tx, ty);
    uint32_t count;
    const struct rf_thin *thin = rf_thin_of(r, tx, ty, &count);

    for (int c = 0; c < 3; c++)
        for (int i = 0; i < RF_TILE * RF_TILE; i++)
            mean[c][i] =
                (uint16_t)(4 *
                           r->light.channel[c][at + i / RF_TILE * r->view.stride + i % RF_TILE]);
    for (uint32_t i = 0; i < count; i++) {
        if (!is_apart(apart, i))
            continue;
        for (int c = 0; c < 3; c++)
            mean[c][thin[i].at] = (uint16_t)(4 * thin[i].light[c]);
    }
}

static void swap_tile(const struct rf_frame *f, int tx, int ty)
{
    const struct refocus_renderer *r = f->r;
    const ptrdiff_t stride = r->view.stride, tile = ty * RF_TILE * stride + tx * RF_TILE;
    uint16_t *const red = r->light.channel[0] + tile, *const green = r->light.channel[1] + tile,
                    *const blue = r->light.channel[2] + tile;
    const struct rf_apart *apart = rf_apart_of(r, tx, ty);
    uint32_t count;
    struct rf_thin *thin = rf_thin_of(r, tx, ty, &count);

    for (uint32_t i = 0; i < count; i++) {
        const ptrdiff_t at = thin[i].at / RF_TILE * stride + thin[i].at % RF_TILE;
        const uint16_t light[3] = {red[at], green[at], blue[at]};

        if (!is_apart(apart, i))
            continue;
        red[at] = thin[i].light[0];
        green[at] = thin[i].light[1];
        blue[at] = thin[i].light[2];
        for (int c = 0; c < 3; c++)
            thin[i].light[c] = light[c];
    }
}

static void swap_row(const struct rf_frame *f, int ty)
{
    for (int tx = 0; tx < f->r->view.tiles_x; tx++)
        if (is_any(rf_apart_of(f->r, tx, ty)))
            swap_tile(f, tx, ty);
    f->r->veil.swapped[ty] = !f->r->veil.swapped[ty];
}

static void swap_band(void *context, int band, int worker)
{
    (void)worker;
    swap_row(context, band);
}

void rf_swap_thin_light(struct rf_frame *f)
{
    rf_pool_run(&f->r->pool, swap_band, f, rf_bands(&f->r->view));
}

static void swap_band_back(void *context, int band, int worker)
{
    const struct rf_frame *f = context;

    (void)worker;
    if (f->r->veil.swapped[band])
        swap_row(f, band);
}

/* The pool leaves out what comes after the run was cancelled. */
void rf_swap_thin_light_back(struct rf_frame *f)
{
    rf_pool_run(&f->r->pool, swap_band_back, f, rf_bands(&f->r->view));
    for (int ty = 0; ty < f->r->view.tiles_y; ty++)
        if (f->r->veil.swapped[ty])
            swap_row(f, ty);
}
