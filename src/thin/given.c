/* given.c: lists the mixtures of the caller's matte, with the two colours that each is made of.
 *
 * Each side of the matte is a push-pull (background/inpaint.h) from the pixels that are sure to be
 * on it. So every pixel has a near and a far disparity, n and f. Where n is nearer than f, it is a
 * mixture C = alpha N + (1 - alpha) F, where F is the push-pull of the light of the far side.
 *
 * N is what is left of C then. So all of the pattern is taken for the subject's, of which hair has
 * more than what is behind it.
 */
#include <stdlib.h>
#include <string.h>

#include "background/inpaint.h"
#include "support/compare.h"
#include "thin/mixture.h"

struct side {
    const struct rf_matte_pass *pass;
    bool is_near;
    struct rf_disparity_q16 disparity; /* n or f of each pixel */
    bool of_light;                     /* light is pushed, not disparities */
};

/* Sums of four of these fit the 16 bits of a push-pull, as those of light do. */
static uint16_t reduced(int disparity)
{
    return (uint16_t)(disparity >> 2);
}

static uint16_t enlarged(int reduced)
{
    return (uint16_t)(reduced << 2 | reduced >> 12);
}

/* Copies what is sure to be on a side into level 0: its light, or its disparities as light. */
static void seed_band(void *context, int band, int worker)
{
    const struct side *side = context;
    const struct rf_matte_pass *pass = side->pass;
    const struct rf_level *level = &pass->pyramid->level[0];
    const int width = pass->view->width;

    (void)worker;
    for (int y = rf_band_start(band); y < rf_band_end(pass->view, band); y++) {
        const uint16_t *alpha = pass->alpha.at + y * pass->alpha.stride;
        const uint16_t *lost = pass->lost.at + y * pass->lost.stride;
        const uint16_t *disparity = pass->disparity.at + y * pass->disparity.stride;
        int16_t *const blur = level->blur.at + y * level->blur.stride;
        const ptrdiff_t at = y * level->light.stride;

        for (int x = 0; x < width; x++)
            blur[x] = rf_is_sure(alpha[x], side->is_near) && (side->of_light || !lost[x])
                          ? 0
                          : RF_NO_BLUR;
        blur[width] = RF_NO_BLUR; /* a column more if the width is odd */
        for (int x = 0; x < width && !side->of_light; x++)
            level->light.channel[0][at + x] = reduced(disparity[x]);
        for (int c = 0; c < 3 && side->of_light; c++)
            memcpy(level->light.channel[c] + at, pass->light.channel[c] + y * pass->light.stride,
                   (size_t)width * 2);
    }
}

/* Keeps the disparities of a side, and gives them to its pixels that had lost theirs. */
static void keep_disparity(void *context, int band, int worker)
{
    const struct side *side = context;
    const struct rf_matte_pass *pass = side->pass;
    const struct rf_light_q12 light = pass->pyramid->level[0].light;

    (void)worker;
    for (int y = rf_band_start(band); y < rf_band_end(pass->view, band); y++)
        for (int x = 0; x < pass->view->width; x++) {
            const uint16_t own = enlarged(light.channel[0][y * light.stride + x]);

            side->disparity.at[y * side->disparity.stride + x] = own;
            if (pass->lost.at[y * pass->lost.stride + x] &&
                rf_is_sure(pass->alpha.at[y * pass->alpha.stride + x], side->is_near))
                pass->disparity.at[y * pass->disparity.stride + x] = own;
        }
}

/* Makes level 0 the side, wherever it can be seen. False: no pixel is sure to be on it. */
static bool push_pull(struct side *side, bool of_light)
{
    const struct rf_matte_pass *pass = side->pass;
    const struct rf_pyramid *pyramid = pass->pyramid;

    side->of_light = of_light;
    rf_pool_run(pass->exec->pool, seed_band, side, rf_bands(pass->view));
    rf_background_push(pass->exec, pyramid, 0, pyramid->levels);
    if (rf_cancelled(pass->exec) || pyramid->level[pyramid->levels].blur.at[0] == RF_NO_BLUR)
        return false;
    rf_background_pull(pass->exec, pass->view, pyramid, 0, pyramid->levels, RF_NEVER_APART);
    return true;
}

static bool spread_disparity(struct side *side)
{
    if (!push_pull(side, false))
        return false;
    rf_pool_run(side->pass->exec->pool, keep_disparity, side, rf_bands(side->pass->view));
    return true;
}

/* Light of a code, which any change of blends and back leaves as it is. */
static uint16_t light_of_code(const struct rf_transfer *transfer, int light)
{
    return transfer->to_light[transfer->to_code[4 * rf_within(light, RF_LIGHT_MAX)]];
}

/* The least alpha, 255 = 1, with which N of a channel is neither below black nor above white. */
static int least_alpha(int light, int mean)
{
    const int room = light < mean ? mean : RF_LIGHT_MAX - mean;

    return light == mean ? 0 : (255 * abs(light - mean) + room - 1) / room;
}

/* Mattes of cameras take dark hair for half of what is behind it: alpha goes towards what all
 * channels ask for, all of the way where it is a half or more. What little is subject stays little,
 * as what is behind it may be other than the mean. */
static uint8_t corrected(int alpha, const uint16_t light[3], const uint16_t mean[3])
{
    int least = alpha;

    for (int c = 0; c < 3; c++)
        least = rf_larger(least, least_alpha(rf_within(light[c], RF_LIGHT_MAX), mean[c]));
    return (uint8_t)(alpha + (rf_smaller(least, 254) - alpha) * rf_smaller(2 * alpha, 255) / 255);
}

/* F of a channel, which is the mean of the background or as near to it as N in the range of light
 * allows, and what the photo is with that mean in place of F. */
static void solve(struct rf_thin *thin, const struct rf_transfer *transfer, int c, int light,
                  int mean)
{
    const int a = thin->alpha, b = 255 - a;
    const int most = (255 * light + b - 1) / b; /* with these N is black and white */
    const int least = (255 * light - a * RF_LIGHT_MAX) / b;

    thin->light[c] = light_of_code(transfer, mean < least ? least : mean > most ? most : mean);
    thin->whole[c] = light_of_code(transfer, light + b * (mean - thin->light[c]) / 255);
}

/* Puts a pixel on its side, and makes it a mixture. False: there is one surface. */
static bool take_apart(const struct rf_matte_pass *pass, int x, int y, struct rf_thin *thin)
{
    const struct rf_light_q12 behind = pass->pyramid->level[0].light;
    const ptrdiff_t at = y * pass->light.stride + x, at_behind = y * behind.stride + x;
    const int near = pass->near.at[y * pass->near.stride + x];
    const int far = pass->far.at[y * pass->far.stride + x];
    uint16_t light[3], mean[3];

    if (near - far <= RF_SURFACE_JUMP)
        return false;
    for (int c = 0; c < 3; c++) {
        light[c] = pass->light.channel[c][at];
        mean[c] = (uint16_t)rf_within(behind.channel[c][at_behind], RF_LIGHT_MAX);
    }
    *thin = (struct rf_thin){
        .at = (uint8_t)(y % RF_TILE * RF_TILE + x % RF_TILE),
        .alpha = corrected(pass->alpha.at[y * pass->alpha.stride + x], light, mean),
        .near_disparity = (uint16_t)near,
        .far_disparity = (uint16_t)far,
    };
    pass->disparity.at[y * pass->disparity.stride + x] =
        thin->alpha >= 128 ? thin->near_disparity : thin->far_disparity;
    for (int c = 0; c < 3; c++)
        solve(thin, pass->transfer, c, light[c], mean[c]);
    return true;
}

/* Lists the mixtures of a band, tile by tile. */
static void list_band(void *context, int band, int worker)
{
    const struct rf_matte_pass *pass = context;
    const uint64_t capacity = rf_thin_capacity(pass->view->width);
    struct rf_thin *const list = pass->list->pixel + (uint64_t)band * capacity;
    uint32_t count = 0;

    (void)worker;
    for (int tx = 0; tx < pass->view->tiles_x; tx++) {
        struct rf_thin_run *run = &pass->list->run[(size_t)band * pass->view->tiles_x + tx];
        const int right = (tx + 1) * RF_TILE;
        const uint32_t first = count;

        for (int y = rf_band_start(band); y < rf_band_end(pass->view, band); y++)
            for (int x = tx * RF_TILE; x < right && x < pass->view->width; x++) {
                const int alpha = pass->alpha.at[y * pass->alpha.stride + x];
                struct rf_thin thin;

                if (!rf_is_sure(alpha, true) && !rf_is_sure(alpha, false) &&
                    take_apart(pass, x, y, &thin) && count < capacity)
                    list[count++] = thin;
            }
        *run = (struct rf_thin_run){first, (uint16_t)(count - first), count > first};
    }
    pass->list->given[band].count = count;
}

void rf_matte_forget(struct rf_thin_list *list, const struct rf_viewport *view)
{
    for (int i = 0; i < view->tiles_x * view->tiles_y; i++)
        list->run[i] = (struct rf_thin_run){.count = 0};
    for (int band = 0; band < rf_bands(view); band++)
        list->given[band] = (struct rf_given_row){.blend = REFOCUS_BLEND_LINEAR};
    list->has_matte = false;
}

void rf_matte_take_in(const struct rf_matte_pass *pass)
{
    struct side near = {pass, true, pass->near, false}, far = {pass, false, pass->far, false};

    rf_settle_sides(pass);
    if (!spread_disparity(&near) || !spread_disparity(&far) || !push_pull(&far, true))
        return;
    rf_pool_run(pass->exec->pool, list_band, (void *)pass, rf_bands(pass->view));
    pass->list->has_matte = true;
}

struct reblend {
    const struct rf_thin_pass *t;
    const struct rf_transfer *transfer;
    uint32_t blend;
};

static void reblend_band(void *context, int band, int worker)
{
    const struct reblend *reblend = context;
    const struct rf_thin_list *list = reblend->t->list;
    struct rf_given_row *row = &list->given[band];
    const uint8_t *to_code = reblend->transfer[row->blend].to_code;
    const uint16_t *to_light = reblend->transfer[reblend->blend].to_light;
    struct rf_thin *thin =
        list->pixel + (uint64_t)band * rf_thin_capacity(reblend->t->view->photo_width);

    (void)worker;
    for (uint32_t i = 0; i < row->count && row->blend != reblend->blend; i++)
        for (int c = 0; c < 3; c++) {
            thin[i].light[c] = to_light[to_code[4 * thin[i].light[c]]];
            thin[i].whole[c] = to_light[to_code[4 * thin[i].whole[c]]];
        }
    row->blend = reblend->blend;
}

void rf_matte_reblend(const struct rf_thin_pass *t, const struct rf_transfer *transfer,
                      uint32_t blend)
{
    struct reblend reblend = {t, transfer, blend};

    rf_pool_run(t->exec->pool, reblend_band, &reblend, rf_bands(t->view));
}
