/* given.c: lists the mixtures of the caller's matte, with the two colours that each is made of.
 *
 * Each side of the matte is a push-pull (background/inpaint.h) from the pixels that are sure to be
 * on it. So every pixel has a near and a far disparity, n and f. Where n is nearer than f, it is a
 * mixture C = alpha N + (1 - alpha) F, unless its own disparity is nearer than n: then it is
 * something before the subject.
 *
 * With N_0 and F_0 the push-pulls of the light of both sides, and s_N and s_F the standard
 * deviations of luminance in the tiles of either side, N and F are the likeliest by normal
 * distributions around N_0 and F_0 (Chuang et al. 2001, "A Bayesian approach to digital matting"):
 *
 *     F = F_0 + (1 - share) (C - alpha N_0 - (1 - alpha) F_0) / (1 - alpha)
 *     share = alpha^2 s_N^2 / (alpha^2 s_N^2 + (1 - alpha)^2 s_F^2)
 *
 * and N is what is left of C. Before a wall all of the pattern is the subject's hair, before print
 * most of what little alpha covers is the print.
 */
#include <stdlib.h>
#include <string.h>

#include "background/inpaint.h"
#include "support/compare.h"
#include "thin/mixture.h"

enum {
    ALL = 256,            /* the whole pattern of a pixel */
    LEAST_DEVIATION = 64, /* Q12: that subjects have at least */
};

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
    rf_background_pull(pass->exec, pass->view, pyramid, 0, pyramid->levels);
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
 * channels ask for, all of the way where it is a half or more, as far as the pattern is the
 * subject's. What little is subject stays little, as what is behind it may be other than the mean.
 */
static uint8_t corrected(int alpha, int share, const uint16_t light[3], const uint16_t mean[3])
{
    const int part = rf_smaller(2 * alpha, 255) * share / ALL;
    int least = alpha;

    for (int c = 0; c < 3; c++)
        least = rf_larger(least, least_alpha(rf_within(light[c], RF_LIGHT_MAX), mean[c]));
    return (uint8_t)(alpha + (rf_smaller(least, 254) - alpha) * part / 255);
}

/* The part of the pattern that is the subject's, of ALL. */
static int share_of_subject(const struct rf_matte_pass *pass, int alpha, int x, int y)
{
    int near, far;
    int64_t subject, behind;

    rf_deviations_at(pass, x, y, &near, &far);
    subject = (int64_t)alpha * (near + LEAST_DEVIATION);
    behind = (int64_t)(255 - alpha) * far;
    return (int)(ALL * subject * subject / (subject * subject + behind * behind));
}

/* F of a channel, or as near to it as N in the range of light allows, and what the photo is with
 * the mean background in place of F. */
static void solve(struct rf_thin *thin, const struct rf_transfer *transfer, int c, int share,
                  int light, int near, int mean)
{
    const int a = thin->alpha, b = 255 - a;
    const int rest = 255 * light - a * near - b * mean;
    const int far = rf_within(mean + (ALL - share) * (rest / b) / ALL, RF_LIGHT_MAX);
    const int most = (255 * light + b - 1) / b; /* with these N is black and white */
    const int least = (255 * light - a * RF_LIGHT_MAX) / b;

    thin->light[c] = light_of_code(transfer, far < least ? least : far > most ? most : far);
    thin->whole[c] = light_of_code(transfer, light + b * (mean - thin->light[c]) / 255);
}

/* Whether a pixel is a mixture of both surfaces. */
static bool is_mixture(const struct rf_matte_pass *pass, int x, int y)
{
    const int alpha = pass->alpha.at[y * pass->alpha.stride + x];
    const int near = pass->near.at[y * pass->near.stride + x];

    return !rf_is_sure(alpha, true) && !rf_is_sure(alpha, false) &&
           near - pass->far.at[y * pass->far.stride + x] > RF_SURFACE_JUMP &&
           pass->disparity.at[y * pass->disparity.stride + x] - near <= RF_SURFACE_JUMP;
}

/* Lists the mixtures of a band, tile by tile, with the mean light of the near side as `whole`. */
static void list_band(void *context, int band, int worker)
{
    const struct rf_matte_pass *pass = context;
    const struct rf_light_q12 mean = pass->pyramid->level[0].light;
    const uint64_t capacity = rf_thin_capacity(pass->view->width);
    struct rf_thin *const list = pass->list->pixel + (uint64_t)band * capacity;
    uint32_t count = 0;

    (void)worker;
    for (int tx = 0; tx < pass->view->tiles_x; tx++) {
        struct rf_thin_run *run = &pass->list->run[(size_t)band * pass->view->tiles_x + tx];
        const int right = rf_smaller((tx + 1) * RF_TILE, pass->view->width);
        const uint32_t first = count;

        for (int y = rf_band_start(band); y < rf_band_end(pass->view, band); y++)
            for (int x = tx * RF_TILE; x < right && count < capacity; x++) {
                struct rf_thin *const thin = &list[count];

                if (!is_mixture(pass, x, y))
                    continue;
                *thin = (struct rf_thin){
                    .at = (uint8_t)(y % RF_TILE * RF_TILE + x % RF_TILE),
                    .alpha = (uint8_t)pass->alpha.at[y * pass->alpha.stride + x],
                    .near_disparity = pass->near.at[y * pass->near.stride + x],
                    .far_disparity = pass->far.at[y * pass->far.stride + x],
                    .thick = true,
                };
                for (int c = 0; c < 3; c++)
                    thin->whole[c] = mean.channel[c][y * mean.stride + x];
                count++;
            }
        *run = (struct rf_thin_run){first, (uint16_t)(count - first), count > first};
    }
    pass->list->given[band].count = count;
}

/* Parts a mixture into its two colours, and puts the pixel on its side. */
static void take_apart(const struct rf_matte_pass *pass, int x, int y, struct rf_thin *thin)
{
    const struct rf_light_q12 behind = pass->pyramid->level[0].light;
    const int share = share_of_subject(pass, thin->alpha, x, y);
    uint16_t light[3], mean[3];

    for (int c = 0; c < 3; c++) {
        light[c] = pass->light.channel[c][y * pass->light.stride + x];
        mean[c] = (uint16_t)rf_within(behind.channel[c][y * behind.stride + x], RF_LIGHT_MAX);
    }
    thin->alpha = corrected(thin->alpha, share, light, mean);
    for (int c = 0; c < 3; c++)
        solve(thin, pass->transfer, c, share, light[c], thin->whole[c], mean[c]);
    pass->disparity.at[y * pass->disparity.stride + x] =
        thin->alpha >= 128 ? thin->near_disparity : thin->far_disparity;
}

static void take_band_apart(void *context, int band, int worker)
{
    const struct rf_matte_pass *pass = context;
    struct rf_thin *const list =
        pass->list->pixel + (uint64_t)band * rf_thin_capacity(pass->view->width);

    (void)worker;
    for (int tx = 0; tx < pass->view->tiles_x; tx++) {
        const struct rf_thin_run *run = &pass->list->run[(size_t)band * pass->view->tiles_x + tx];

        for (uint32_t i = run->first; i < run->first + run->count; i++)
            take_apart(pass, tx * RF_TILE + list[i].at % RF_TILE,
                       band * RF_TILE + list[i].at / RF_TILE, &list[i]);
    }
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
    if (!spread_disparity(&near) || !spread_disparity(&far))
        return;
    rf_measure_deviations(pass);
    if (!push_pull(&near, true))
        return;
    rf_pool_run(pass->exec->pool, list_band, (void *)pass, rf_bands(pass->view));
    if (!push_pull(&far, true))
        return;
    rf_pool_run(pass->exec->pool, take_band_apart, (void *)pass, rf_bands(pass->view));
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
