/* find.c: finds the mixtures of a photo (kernels/thin.h has the rule) and lists them by tiles. */
#include "colour/transfer.h"
#include "thin/mixture.h"

void rf_lay_out_thin(struct rf_thin_list *list, struct rf_arena *arena, int max_width,
                     int max_height)
{
    const uint64_t across = (uint64_t)(max_width + RF_TILE - 1) / RF_TILE;
    const uint64_t down = (uint64_t)(max_height + RF_TILE - 1) / RF_TILE;

    list->pixel = rf_arena_take(arena, rf_thin_capacity(max_width) * down, sizeof *list->pixel);
    list->run = rf_arena_take(arena, across * down, sizeof *list->run);
    list->given = rf_arena_take(arena, down, sizeof *list->given);
}

/* F is what the caller knows to be behind, where the map has the pixel near; else it is seen. */
static void take_behind(const struct rf_thin_pass *t, struct rf_thin *thin, int tx, int ty)
{
    const int x = tx * RF_TILE + thin->at % RF_TILE, y = ty * RF_TILE + thin->at / RF_TILE;
    const size_t at = (size_t)y * (size_t)t->behind->width + (size_t)x;
    const uint16_t own = t->disparity.at[y * t->disparity.stride + x];

    if (own != thin->near_disparity || !rf_is_behind(t->behind, x, y, own))
        return;
    for (int c = 0; c < 3; c++)
        thin->light[c] = t->transfer->to_light[t->behind->code[4 * at + (size_t)c]];
    thin->far_disparity = t->behind->disparity[at];
}

static void find_band(void *context, int band, int worker)
{
    const struct rf_thin_pass *t = context;
    struct rf_thin_list *list = t->list;
    const uint64_t capacity = rf_thin_capacity(t->view->width);
    struct rf_thin *thin = list->pixel + (uint64_t)band * capacity;
    const int y = rf_band_start(band);
    void *const share = rf_share(&t->exec->shares, worker);
    uint32_t count = list->given[band].count;

    for (int tx = 0; tx < t->view->tiles_x; tx++) {
        const int x = tx * RF_TILE;
        const ptrdiff_t at = y * t->view->stride + x;
        const struct rf_thin_tile tile = {
            .disparity = t->disparity.at + at,
            .light = {t->light.channel[0] + at, t->light.channel[1] + at, t->light.channel[2] + at},
            .stride = t->view->stride,
            .left = x,
            .above = y,
            .right = t->view->width - x,
            .below = t->view->height - y,
        };
        const uint64_t room = capacity - count;
        int found;

        if (list->run[(size_t)band * t->view->tiles_x + tx].given)
            continue;
        found =
            t->exec->kernels->find_thin(thin + count, &tile, (int)(room < 256 ? room : 256), share);

        for (int i = 0; i < found; i++)
            rf_fit_coverage(t, &thin[count + (uint32_t)i], tx, band);
        for (int i = 0; i < found && t->behind; i++)
            take_behind(t, &thin[count + (uint32_t)i], tx, band);
        list->run[(size_t)band * t->view->tiles_x + tx] =
            (struct rf_thin_run){.first = count, .count = (uint16_t)found};
        count += (uint32_t)found;
    }
}

void rf_thin_find(const struct rf_thin_pass *t, uint32_t blend)
{
    struct rf_thin_list *list = t->list;

    list->blend = RF_NO_BLEND;
    rf_pool_run(t->exec->pool, find_band, (void *)t, rf_bands(t->view));
    if (!rf_cancelled(t->exec))
        list->blend = blend;
}
