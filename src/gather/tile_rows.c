/* tile_rows.c: decides which rows of a tile are computed and how much its means are softened. */
#include "gather/tile_rows.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

#include "support/compare.h"

enum {
    /* Rows may lie a pixel apart from a blur of ROW_BLUR sqrt(rays) on, Q7.8: 1.25 pixels for 64
     * rays; no less than one pixel. */
    ROW_BLUR = 40,
    LEAST_ROW_BLUR = 256,
    SOFT_BLUR = 640, /* 2.5 pixels, Q7.8 */
};
static_assert(ROW_BLUR * 8 <= INT32_MAX >> 15 && 8 * 8 == RF_LIVE_RAYS,
              "the gap of the most rays, over a height in Q15");

int rf_row_gap(const struct rf_frame *f)
{
    const struct rf_settings *p = f->params;
    const struct rf_ray_set *set = &f->ray_sets->set[f->ray_sets->preset];
    int gap, height = 1; /* half the aperture's, Q15 */

    if (p->rays == REFOCUS_RAYS_FULL || p->rays > RF_LIVE_RAYS || p->cat_eye > 0 ||
        p->fringe != 0 || f->fine)
        return 0;
    for (int n = 0; n < set->count; n++)
        height = abs(set->ray[n].v) > height ? abs(set->ray[n].v) : height;
    gap = (int)(ROW_BLUR * sqrt(p->rays));
    return ((gap > LEAST_ROW_BLUR ? gap : LEAST_ROW_BLUR) << 15) / height;
}

int rf_least_blur(const struct rf_frame *f, const struct rf_tile_plan *plan, int background_blur)
{
    return rf_smaller(plan->least, rf_in_pixels(abs(background_blur), f->blur.unit));
}

/* Rises from 0 at `from` to 65535 at 5/4 of that. */
static int64_t ramp(int from, int blur)
{
    const int64_t part = INT64_C(65535) * 4 * (blur - from) / from;

    return part < 0 ? 0 : part < 65535 ? part : 65535;
}

uint16_t rf_softness(const struct rf_frame *f, const struct rf_tile_plan *plan, int background_blur)
{
    const int64_t far_apart = ramp(rf_in_pixels(f->prefilter_above[0], f->blur.unit), plan->reach);
    const int64_t blurred = ramp(SOFT_BLUR, rf_least_blur(f, plan, background_blur));

    return (uint16_t)(f->fine ? 0 : far_apart < blurred ? far_apart : blurred);
}

struct rf_tile_rows rf_tile_rows(const struct rf_frame *f, const struct rf_tile_plan *plan,
                                 int background_blur)
{
    static const struct rf_tile_rows sparse[] = {{5, 4}, {3, 6}, {2, 8}};
    const int least = rf_least_blur(f, plan, background_blur);

    for (int i = 0; f->row_gap && (f->splats || !plan->highlight) && i < 3; i++)
        if (least / sparse[i].step >= f->row_gap)
            return sparse[i];
    return (struct rf_tile_rows){1, RF_TILE};
}

struct rf_tile_rows rf_chroma_rows(const struct rf_frame *f, const struct rf_tile_plan *plan,
                                   int background_blur)
{
    const int least = rf_least_blur(f, plan, background_blur);

    if (f->row_gap && (f->splats || !plan->highlight) && least / 4 >= f->row_gap)
        return (struct rf_tile_rows){2, 4};
    return (struct rf_tile_rows){1, RF_TILE / 2};
}
