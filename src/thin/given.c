/* given.c: lists the mixtures of the caller's matte, with the two colours that each is made of.
 *
 * Each side of the matte is a push-pull (background/inpaint.h), of light and disparity, from the
 * pixels that are sure to be on it. So every pixel has a near side, n and N, and a far one, f and
 * F. Where n is nearer than f, the least change of N and F makes C = alpha N + (1 - alpha) F true.
 */
#include <string.h>

#include "background/inpaint.h"
#include "thin/mixture.h"

/* Disparities are halved, to be blurs of the pyramid, and those of the far side turned round: push
 * takes the greatest, which is the nearest n and the farthest f. */
enum { NEAREST = 32767 };

struct side {
    const struct rf_matte_pass *pass;
    bool is_near;
    bool complete; /* lost disparities were replaced */
};

static int halved(bool is_near, int disparity)
{
    return is_near ? disparity / 2 : NEAREST - disparity / 2;
}

static uint16_t doubled(bool is_near, int halved)
{
    return (uint16_t)(2 * (is_near ? halved : NEAREST - halved));
}

/* Copies what is sure to be on a side into level 0. */
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

        for (int x = 0; x < width; x++)
            blur[x] = rf_is_sure(alpha[x], side->is_near) && (side->complete || !lost[x])
                          ? (int16_t)halved(side->is_near, disparity[x])
                          : RF_NO_BLUR;
        blur[width] = RF_NO_BLUR; /* a column more if the width is odd */
        for (int c = 0; c < 3; c++)
            memcpy(level->light.channel[c] + y * level->light.stride,
                   pass->light.channel[c] + y * pass->light.stride, (size_t)width * 2);
    }
}

/* Gives what was lost the disparity of the side. */
static void complete_band(void *context, int band, int worker)
{
    const struct side *side = context;
    const struct rf_matte_pass *pass = side->pass;
    const struct rf_blur_q8 blur = pass->pyramid->level[0].blur;

    (void)worker;
    for (int y = rf_band_start(band); y < rf_band_end(pass->view, band); y++)
        for (int x = 0; x < pass->view->width; x++)
            if (pass->lost.at[y * pass->lost.stride + x] &&
                rf_is_sure(pass->alpha.at[y * pass->alpha.stride + x], side->is_near))
                pass->disparity.at[y * pass->disparity.stride + x] =
                    doubled(side->is_near, blur.at[y * blur.stride + x]);
}

/* Makes level 0 the side, wherever it can be seen: first the disparities, and then with the light
 * of those that were lost. False: no pixel is sure to be on it. */
static bool spread(struct side *side)
{
    const struct rf_matte_pass *pass = side->pass;
    const struct rf_pyramid *pyramid = pass->pyramid;

    for (int i = 0; i < 2; i++) {
        rf_pool_run(pass->exec->pool, seed_band, side, rf_bands(pass->view));
        rf_background_push(pass->exec, pyramid, 0, pyramid->levels);
        if (rf_cancelled(pass->exec) || pyramid->level[pyramid->levels].blur.at[0] == RF_NO_BLUR)
            return false;
        rf_background_pull(pass->exec, pass->view, pyramid, 0, pyramid->levels, RF_NEVER_APART);
        if (i == 0)
            rf_pool_run(pass->exec->pool, complete_band, side, rf_bands(pass->view));
        side->complete = true;
    }
    return true;
}

/* Light of a code, which any change of blends and back leaves as it is. */
static uint16_t light_of_code(const struct rf_transfer *transfer, int light)
{
    return transfer->to_light[transfer->to_code[4 * rf_within(light, RF_LIGHT_MAX)]];
}

/* F of a channel, and what the photo is with the mean of the background, `mean`, in place of F.
 * Until then `whole` is N. */
static void solve(struct rf_thin *thin, const struct rf_transfer *transfer, int c, int light,
                  int mean)
{
    const int a = thin->alpha, b = 255 - a;
    const int off = 255 * light - a * thin->whole[c] - b * mean; /* below 2^21 */
    const int most = (255 * light + b - 1) / b; /* with these N is black and white */
    const int least = (255 * light - a * RF_LIGHT_MAX) / b;
    const int far = mean + b * off / (a * a + b * b);

    thin->light[c] = light_of_code(transfer, far < least ? least : far > most ? most : far);
    thin->whole[c] = light_of_code(transfer, light + b * (mean - thin->light[c]) / 255);
}

/* Calls work for the pixels of a band that are mixtures, tile by tile; it says whether they stay in
 * the list, or are added to it. */
struct visit {
    const struct side *side;
    struct rf_thin *thin; /* NULL: the row is full */
    int x, y, alpha;
};
typedef bool visit_fn(const struct visit *visit);

static void visit_band(const struct side *side, int band, visit_fn *work)
{
    const struct rf_matte_pass *pass = side->pass;
    const uint64_t capacity = rf_thin_capacity(pass->view->width);
    struct rf_thin *const thin = pass->list->pixel + (uint64_t)band * capacity;
    uint32_t from = 0, to = 0;

    for (int tx = 0; tx < pass->view->tiles_x; tx++) {
        struct rf_thin_run *run = &pass->list->run[(size_t)band * pass->view->tiles_x + tx];
        const int right = (tx + 1) * RF_TILE;
        const uint32_t first = to;

        for (int y = rf_band_start(band); y < rf_band_end(pass->view, band); y++)
            for (int x = tx * RF_TILE; x < right && x < pass->view->width; x++) {
                const int alpha = pass->alpha.at[y * pass->alpha.stride + x];
                struct visit visit = {side, from < capacity ? &thin[from] : NULL, x, y, alpha};

                if (rf_is_sure(alpha, true) || rf_is_sure(alpha, false))
                    continue;
                from += from < capacity;
                if (work(&visit) && visit.thin)
                    thin[to++] = *visit.thin;
            }
        *run = (struct rf_thin_run){first, (uint16_t)(to - first), to > first};
    }
    pass->list->given[band].count = to;
}

static bool add(const struct visit *visit)
{
    const struct rf_level *level = &visit->side->pass->pyramid->level[0];
    const ptrdiff_t at = visit->y * level->light.stride + visit->x;

    if (!visit->thin)
        return true;
    *visit->thin = (struct rf_thin){
        .at = (uint8_t)(visit->y % RF_TILE * RF_TILE + visit->x % RF_TILE),
        .alpha = (uint8_t)visit->alpha,
    };
    for (int c = 0; c < 3; c++)
        visit->thin->whole[c] = level->light.channel[c][at];
    return true;
}

/* Solves a mixture, and puts its pixel on its side. */
static bool finish(const struct visit *visit)
{
    const struct rf_matte_pass *pass = visit->side->pass;
    const struct rf_level *level = &pass->pyramid->level[0];
    const ptrdiff_t at = visit->y * level->light.stride + visit->x;
    const int near = pass->near.at[visit->y * pass->near.stride + visit->x];
    const int far = doubled(false, level->blur.at[at]);

    if (near - far <= RF_SURFACE_JUMP)
        return false;
    pass->disparity.at[visit->y * pass->disparity.stride + visit->x] =
        (uint16_t)(visit->alpha >= 128 ? near : far);
    if (!visit->thin)
        return false;
    visit->thin->near_disparity = (uint16_t)near;
    visit->thin->far_disparity = (uint16_t)far;
    for (int c = 0; c < 3; c++)
        solve(visit->thin, pass->transfer, c,
              pass->light.channel[c][visit->y * pass->light.stride + visit->x],
              level->light.channel[c][at]);
    return true;
}

/* Keeps n, and lists the mixtures with N. */
static void list_band(void *context, int band, int worker)
{
    const struct side *side = context;
    const struct rf_matte_pass *pass = side->pass;
    const struct rf_blur_q8 blur = pass->pyramid->level[0].blur;

    (void)worker;
    for (int y = rf_band_start(band); y < rf_band_end(pass->view, band); y++)
        for (int x = 0; x < pass->view->width; x++)
            pass->near.at[y * pass->near.stride + x] = doubled(true, blur.at[y * blur.stride + x]);
    visit_band(side, band, add);
}

static void solve_band(void *context, int band, int worker)
{
    (void)worker;
    visit_band(context, band, finish);
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
    struct side near = {pass, true, false}, far = {pass, false, false};

    rf_settle_sides(pass);
    if (!spread(&near))
        return;
    rf_pool_run(pass->exec->pool, list_band, &near, rf_bands(pass->view));
    if (!spread(&far)) {
        rf_matte_forget(pass->list, pass->view);
        return;
    }
    rf_pool_run(pass->exec->pool, solve_band, &far, rf_bands(pass->view));
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
