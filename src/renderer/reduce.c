#include "renderer/reduce.h"

#include <stdlib.h>

#include "planes/planes.h"
#include "renderer/bands.h"

enum { SURFACE = 65535 / 32 };

struct job {
    struct refocus_renderer *r;
    const struct rf_photo *from;
    struct rf_photo *to;
};

/* The second greatest of four. */
static int second(const int d[4])
{
    const int a = d[0] > d[1] ? d[0] : d[1], b = d[0] > d[1] ? d[1] : d[0];
    const int e = d[2] > d[3] ? d[2] : d[3], f = d[2] > d[3] ? d[3] : d[2];

    return a > e ? (e > b ? e : b) : (a > f ? a : f);
}

/* Row y of the smaller photo. */
static void reduce_row(const struct job *job, int y)
{
    const struct rf_photo *from = job->from, *to = job->to;
    const struct rf_transfer *linear = &job->r->transfer[REFOCUS_BLEND_LINEAR];
    const int y0 = 2 * y, y1 = 2 * y + 1 < from->height ? y0 + 1 : y0;
    const uint32_t blend = from->band_blend[y0 / RF_TILE]; /* of both: bands are even */
    const uint8_t *to_code = job->r->transfer[blend].to_code;

    for (int x = 0; x < to->width; x++) {
        const int x0 = 2 * x, x1 = x0 + 1 < from->width ? x0 + 1 : x0;
        const ptrdiff_t at[4] = {y0 * from->stride + x0, y0 * from->stride + x1,
                                 y1 * from->stride + x0, y1 * from->stride + x1};
        const int d[4] = {from->disparity[at[0]], from->disparity[at[1]], from->disparity[at[2]],
                          from->disparity[at[3]]};
        const ptrdiff_t out = y * to->stride + x;
        const int own = second(d);
        uint32_t light[3] = {0, 0, 0}, disparity = 0, n = 0;

        for (int i = 0; i < 4; i++) {
            if (abs(d[i] - own) > SURFACE)
                continue;
            n++;
            disparity += (uint32_t)d[i];
            for (int c = 0; c < 3; c++) {
                const uint16_t v = from->light[c][at[i]];

                light[c] += blend == REFOCUS_BLEND_LINEAR ? v : linear->to_light[to_code[4 * v]];
            }
        }
        to->disparity[out] = (uint16_t)((2 * disparity + n) / (2 * n));
        for (int c = 0; c < 3; c++)
            to->light[c][out] = linear->to_light[linear->to_code[(8 * light[c] + n) / (2 * n)]];
        to->alpha[(ptrdiff_t)y * to->width + x] =
            (uint8_t)((from->alpha[(ptrdiff_t)y0 * from->width + x0] +
                       from->alpha[(ptrdiff_t)y0 * from->width + x1] +
                       from->alpha[(ptrdiff_t)y1 * from->width + x0] +
                       from->alpha[(ptrdiff_t)y1 * from->width + x1] + 2) /
                      4);
    }
}

/* A band of the window, which is the smaller photo. */
static void reduce_band(void *context, int band, int worker)
{
    const struct job *job = context;
    const int y0 = rf_band_start(band), y1 = rf_band_end(job->r, band);

    (void)worker;
    for (int y = y0; y < y1; y++)
        reduce_row(job, y);
    job->to->band_blend[band] = REFOCUS_BLEND_LINEAR;
    for (int c = 0; c < 3; c++)
        rf_extend_rows(job->r, job->to->light[c], y0, y1);
}

static void reduce(struct refocus_renderer *r, int to)
{
    struct job job = {r, &r->photo[to - 1], &r->photo[to]};

    job.to->width = rf_reduced(job.from->width, 1);
    job.to->height = rf_reduced(job.from->height, 1);
    job.to->highlights_blend = job.to->thin.blend = RF_NO_BLEND;
    rf_use(r, to, rf_whole(r, to));
    rf_pool_run(&r->pool, reduce_band, &job, rf_bands(r));
    job.to->rims = 0;
    if (!rf_cancelled(r))
        rf_find_rims(r, rf_whole(r, to));
}

void rf_reduce_once(struct refocus_renderer *r)
{
    r->made = (struct rf_made){0}; /* it lies where the background layer does */
    reduce(r, 1);
    r->made.half = !rf_cancelled(r);
}

void rf_reduce_all(struct refocus_renderer *r)
{
    rf_reduce_once(r);
    for (int i = 2; i < RF_PHOTOS; i++)
        reduce(r, i);
}
