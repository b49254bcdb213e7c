/* separate.c: chooses which mixtures are separated, and exchanges their light with that of
 * the background. */
#include <stdlib.h>
#include <string.h>

#include "background/texture.h"
#include "thin/mixture.h"

enum { CELLS = RF_TILE / RF_CELL };

/* Whether a tile has more than a few cells all of which is as near as a blur: nothing thin fills
 * many cells. */
static bool is_filled(const struct rf_thin_pass *t, int tx, int ty, int blur)
{
    enum { FEW = 3 };
    int filled = 0;

    for (int j = 0; j < CELLS; j++) {
        const int16_t *most = t->cell_most + (ty * CELLS + j) * t->cell_stride + tx * CELLS;

        for (int i = 0; i < CELLS; i++)
            filled += rf_in_pixels(most[i], t->blur.unit) <= blur;
    }
    return filled > FEW;
}

/* Whether nothing that is nearly as near as a blur reaches a tile, except thin structures: the
 * coverage layer is composited over everything, so nothing may be before it. */
static bool is_alone(const struct rf_thin_pass *t, int tx, int ty, int blur)
{
    const int reach = (abs(blur) + 256 * RF_TILE - 1) / (256 * RF_TILE);

    for (int y = ty - reach; y <= ty + reach; y++)
        for (int x = tx - reach; x <= tx + reach; x++)
            if (x >= 0 && y >= 0 && x < t->view->tiles_x && y < t->view->tiles_y &&
                is_filled(t, x, y, blur * 3 / 4))
                return false;
    return true;
}

/* The farthest near disparity of the mixtures of a tile that are splatted; 65536: none is. */
static int farthest_splatted(const struct rf_thin_pass *t, int tx, int ty)
{
    uint32_t count;
    const struct rf_thin *thin = rf_thin_of(t, tx, ty, &count);
    int least = 65536;

    for (uint32_t i = 0; i < count; i++)
        if (rf_is_splatted(t, &thin[i], tx, ty) && thin[i].near_disparity < least)
            least = thin[i].near_disparity;
    return least;
}

static void choose_splatted(const struct rf_thin_pass *t, int tx, int ty,
                            struct rf_thin_choice *choice)
{
    const int d = farthest_splatted(t, tx, ty);
    uint32_t count;
    const struct rf_thin *thin = rf_thin_of(t, tx, ty, &count);

    if (d > 65535 || !is_alone(t, tx, ty, rf_thin_blur(t, (uint16_t)d, tx * RF_TILE, ty * RF_TILE)))
        return;
    choice->splats = true;
    for (uint32_t i = 0; i < count; i++)
        if (rf_is_splatted(t, &thin[i], tx, ty))
            choice->splat[i / 64] |= UINT64_C(1) << i % 64;
}

/* Gaussian noise of a tile spreads so many times as far as rf_bins has it. */
enum { NOISE_SPREAD = 4 };

/* Whether a tile holds one surface, of noise: what looks thin there is none. */
static bool is_noisy(const struct rf_thin_pass *t, int tx, int ty)
{
    const struct rf_bins *bins = &t->bins[(size_t)ty * t->view->tiles_x + tx];

    return bins->noise > 0 && NOISE_SPREAD * bins->noise >= bins->most - bins->least;
}

static void choose_band(void *context, int band, int worker)
{
    const struct rf_thin_pass *t = context;

    (void)worker;
    t->coverage->swapped[band] = false;
    for (int tx = 0; tx < t->view->tiles_x; tx++) {
        struct rf_thin_choice *choice = rf_thin_choice_of(t, tx, band);

        *choice = (struct rf_thin_choice){.splats = false};
        if (!rf_thin_run_of(t, tx, band)->given) {
            if (!t->finds || is_noisy(t, tx, band))
                continue;
            if (t->disc_scale)
                choose_splatted(t, tx, band, choice);
        }
        rf_choose_near(t, tx, band, choice);
        if (t->mattes)
            rf_choose_matted(t, tx, band, choice);
    }
}

static bool is_any(const struct rf_thin_choice *choice)
{
    return choice->splats || choice->mattes || choice->nears;
}

static bool is_apart(const struct rf_thin_choice *choice, uint32_t i)
{
    return rf_has_bit(choice->splat, i) || rf_has_bit(choice->matte, i) ||
           rf_has_bit(choice->near, i);
}

/* Whether the light of a mixture is exchanged: what was found is drawn as N with that of the photo.
 */
static bool is_swapped(const struct rf_thin_choice *choice, uint32_t i, bool given)
{
    return rf_has_bit(choice->splat, i) || rf_has_bit(choice->matte, i) ||
           (given && rf_has_bit(choice->near, i));
}

/* Where N is composited, the planes have the circle of confusion of F. */
static void patch_tile(const struct rf_thin_pass *t, int tx, int ty)
{
    const struct rf_thin_choice *choice = rf_thin_choice_of(t, tx, ty);
    uint32_t count;
    const struct rf_thin *thin = rf_thin_of(t, tx, ty, &count);

    for (uint32_t i = 0; i < count; i++) {
        const int x = tx * RF_TILE + thin[i].at % RF_TILE;
        const int y = ty * RF_TILE + thin[i].at / RF_TILE;

        if (is_apart(choice, i))
            t->blur.at[y * t->view->stride + x] = rf_in_units(
                rf_thin_blur(
                    t, rf_has_bit(choice->near, i) ? thin[i].near_disparity : thin[i].far_disparity,
                    x, y),
                t->blur.unit);
    }
}

bool rf_thin_patch_band(const struct rf_thin_pass *t, int band)
{
    bool any = false;

    for (int tx = 0; tx < t->view->tiles_x; tx++) {
        if (!is_any(rf_thin_choice_of(t, tx, band)))
            continue;
        any = true;
        patch_tile(t, tx, band);
    }
    return any;
}

void rf_thin_separate(const struct rf_thin_pass *t)
{
    rf_pool_run(t->exec->pool, choose_band, (void *)t, rf_bands(t->view));
}

/* The place of a pixel in its tile. */
static ptrdiff_t place_of(const struct rf_thin_pass *t, const struct rf_thin *thin)
{
    return thin->at / RF_TILE * t->view->stride + thin->at % RF_TILE;
}

/* Highlights may have been boosted. */
static int filled_light(const struct rf_thin_pass *t, int channel, ptrdiff_t at)
{
    const int light = t->smooth.channel[channel][at];

    return light < RF_LIGHT_MAX ? light : RF_LIGHT_MAX;
}

void rf_thin_hide(const struct rf_thin_pass *t, struct rf_blur_q8 background_blur, int band)
{
    for (int tx = 0; tx < t->view->tiles_x; tx++) {
        struct rf_thin_choice *choice = rf_thin_choice_of(t, tx, band);
        uint32_t count;
        const struct rf_thin *thin = rf_thin_of(t, tx, band, &count);
        int16_t *tile = background_blur.at + band * RF_TILE * background_blur.stride + tx * RF_TILE;

        memset(choice->filled, 0, sizeof choice->filled);
        for (uint32_t i = 0; i < count && choice->splats; i++) {
            int16_t *blur = tile + place_of(t, &thin[i]);

            if (!rf_has_bit(choice->splat, i) || *blur == RF_NO_BLUR ||
                rf_in_pixels(abs(*blur), background_blur.unit) >= RF_TEXTURE_BLUR)
                continue;
            *blur = RF_NO_BLUR;
            choice->filled[i / 64] |= UINT64_C(1) << i % 64;
        }
    }
}

void rf_thin_hide_none(const struct rf_thin_pass *t)
{
    for (int ty = 0; ty < t->view->tiles_y; ty++)
        for (int tx = 0; tx < t->view->tiles_x; tx++)
            memset(rf_thin_choice_of(t, tx, ty)->filled, 0, sizeof(uint64_t[4]));
}

void rf_thin_take_filled(const struct rf_thin_pass *t, struct rf_background background, int band)
{
    for (int tx = 0; tx < t->view->tiles_x; tx++) {
        const struct rf_thin_choice *choice = rf_thin_choice_of(t, tx, band);
        uint32_t count;
        const struct rf_thin *thin = rf_thin_of(t, tx, band, &count);
        const ptrdiff_t tile = band * RF_TILE * t->view->stride + tx * RF_TILE;

        for (uint32_t i = 0; i < count; i++) {
            const ptrdiff_t at = tile + place_of(t, &thin[i]);

            if (!rf_has_bit(choice->filled, i))
                continue;
            for (int c = 0; c < 3; c++)
                t->smooth.channel[c][at] = background.light.channel[c][at];
            background.blur.at[at] = t->blur.at[at];
        }
    }
}

void rf_thin_sharp_means(const struct rf_thin_pass *t, int tx, int ty,
                         uint16_t mean[3][RF_TILE * RF_TILE])
{
    const ptrdiff_t at = ty * RF_TILE * t->view->stride + tx * RF_TILE;
    const struct rf_thin_choice *choice = rf_thin_choice_of(t, tx, ty);
    uint32_t count;
    const struct rf_thin *thin = rf_thin_of(t, tx, ty, &count);

    for (int c = 0; c < 3; c++)
        for (int i = 0; i < RF_TILE * RF_TILE; i++)
            mean[c][i] =
                (uint16_t)(4 *
                           t->light.channel[c][at + i / RF_TILE * t->view->stride + i % RF_TILE]);
    for (uint32_t i = 0; i < count; i++) {
        if (!is_swapped(choice, i, rf_thin_run_of(t, tx, ty)->given))
            continue;
        for (int c = 0; c < 3; c++)
            mean[c][thin[i].at] =
                (uint16_t)(4 * (rf_has_bit(choice->filled, i)
                                    ? filled_light(t, c, at + place_of(t, &thin[i]))
                                    : thin[i].light[c]));
    }
}

static void swap_tile(const struct rf_thin_pass *t, int tx, int ty)
{
    const bool given = rf_thin_run_of(t, tx, ty)->given;
    const ptrdiff_t stride = t->view->stride, tile = ty * RF_TILE * stride + tx * RF_TILE;
    uint16_t *const red = t->light.channel[0] + tile, *const green = t->light.channel[1] + tile,
                    *const blue = t->light.channel[2] + tile;
    const struct rf_thin_choice *choice = rf_thin_choice_of(t, tx, ty);
    uint32_t count;
    struct rf_thin *thin = rf_thin_of(t, tx, ty, &count);

    for (uint32_t i = 0; i < count; i++) {
        const ptrdiff_t at = thin[i].at / RF_TILE * stride + thin[i].at % RF_TILE;
        uint16_t *const own = rf_has_bit(choice->near, i) ? thin[i].whole : thin[i].light;
        uint16_t light[3];

        if (!is_swapped(choice, i, given))
            continue;
        memcpy(light, own, sizeof light);
        own[0] = red[at];
        own[1] = green[at];
        own[2] = blue[at];
        red[at] = light[0];
        green[at] = light[1];
        blue[at] = light[2];
    }
}

static void swap_row(const struct rf_thin_pass *t, int ty)
{
    for (int tx = 0; tx < t->view->tiles_x; tx++)
        if (is_any(rf_thin_choice_of(t, tx, ty))) {
            swap_tile(t, tx, ty);
            if (t->chroma)
                rf_swap_chroma(t, tx, ty, t->coverage->swapped[ty]);
        }
    t->coverage->swapped[ty] = !t->coverage->swapped[ty];
}

static void swap_band(void *context, int band, int worker)
{
    (void)worker;
    swap_row(context, band);
}

void rf_thin_swap_light(const struct rf_thin_pass *t)
{
    rf_pool_run(t->exec->pool, swap_band, (void *)t, rf_bands(t->view));
}

static void swap_band_back(void *context, int band, int worker)
{
    const struct rf_thin_pass *t = context;

    (void)worker;
    if (t->coverage->swapped[band])
        swap_row(t, band);
}

/* The pool hands out nothing after the run was cancelled: the bands that it left are done here. */
void rf_thin_swap_light_back(const struct rf_thin_pass *t)
{
    rf_pool_run(t->exec->pool, swap_band_back, (void *)t, rf_bands(t->view));
    for (int ty = 0; ty < t->view->tiles_y; ty++)
        if (t->coverage->swapped[ty])
            swap_row(t, ty);
}
