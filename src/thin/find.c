/* find.c: which pixels of the photo are mixtures, and of what: kernels/thin.h. */
#include "thin/thin.h"

#include "image/viewport.h"
#include "renderer/renderer.h"

static struct rf_thin_run run_of(const struct rf_thin *thin, uint32_t first, int count)
{
    struct rf_thin_run run = {.first = first, .count = (uint16_t)count, .least = 65535};

    for (int i = 0; i < count; i++) {
        const uint16_t d = thin[i].near_disparity;

        run.least = d < run.least ? d : run.least;
        run.most = d > run.most ? d : run.most;
    }
    return run;
}

static void find_band(void *context, int band, int worker)
{
    struct refocus_renderer *r = context;
    struct rf_thin_list *list = &r->photo.thin;
    const uint64_t capacity = rf_thin_capacity(r->view.width);
    struct rf_thin *thin = list->pixel + (uint64_t)band * capacity;
    const int y = rf_band_start(band);
    uint32_t count = 0;

    (void)worker;
    for (int tx = 0; tx < r->view.tiles_x; tx++) {
        const int x = tx * RF_TILE;
        const ptrdiff_t at = y * r->view.stride + x;
        const struct rf_thin_tile tile = {
            .disparity = r->disparity.at + at,
            .light = {r->light.channel[0] + at, r->light.channel[1] + at, r->light.channel[2] + at},
            .stride = r->view.stride,
            .left = x,
            .above = y,
            .right = r->view.width - x,
            .below = r->view.height - y,
        };
        const uint64_t room = capacity - count;
        const int found =
            r->exec.kernels->find_thin(thin + count, &tile, (int)(room < 256 ? room : 256));

        for (int i = 0; i < found; i++)
            rf_tell_strand(r, &thin[count + (uint32_t)i], tx, band);
        list->run[(size_t)band * r->view.tiles_x + tx] = run_of(thin + count, count, found);
        count += (uint32_t)found;
    }
}

void rf_find_thin(struct refocus_renderer *r)
{
    struct rf_thin_list *list = &r->photo.thin;

    list->blend = RF_NO_BLEND;
    rf_pool_run(&r->pool, find_band, r, rf_bands(&r->view));
    if (!rf_cancelled(&r->exec))
        list->blend = r->blend;
}
