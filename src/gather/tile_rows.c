#include "gather/tile_rows.h"

#include <math.h>
#include <stdlib.h>

enum {
    ROW_BLUR = 40, /* times the root of the rays: 1.25 pixels of blur, Q7.8, of 64 of them, */
    LEAST_ROW_BLUR = 256, /* for rows a pixel apart */
    SOFT_BLUR = 640,      /* 2.5 pixels */
};

int rf_row_gap(const struct rf_frame *f)
{
    const struct rf_settings *p = f->params;
    const struct rf_ray_set *set = &f->ray_sets->set[f->ray_sets->preset];
    int gap, height = 1; /* half the opening's, Q15 */

    if (p->rays == REFOCUS_RAYS_FULL || p->rays > RF_LIVE_RAYS || p->cat_eye > 0 ||
        p->fringe != 0 || f->fine)
        return 0;
    for (int n = 0; n < set->count; n++)
        height = abs(set->ray[n].v) > height ? abs(set->ray[n].v) : height;
    gap = (int)(ROW_BLUR * sqrt(p->rays));
    return ((gap > LEAST_ROW_BLUR ? gap : LEAST_ROW_BLUR) << 15) / height;
}

/* The least blur of all that is seen from a tile. */
static int least_blur(const struct rf_tile_plan *plan, int behind)
{
    return plan->least < abs(behind) ? plan->least : abs(behind);
}

/* From 0 at `from` to 65535 at 5/4 of that. */
static int64_t share_above(int from, int blur)
{
    const int64_t share = INT64_C(65535) * 4 * (blur - from) / from;

    return share < 0 ? 0 : share < 65535 ? share : 65535;
}

uint16_t rf_softness(const struct rf_frame *f, const struct rf_tile_plan *plan, int behind)
{
    const int64_t far_apart = share_above(f->prefilter_above[0], plan->reach);
    const int64_t blurred = share_above(SOFT_BLUR, least_blur(plan, behind));

    return (uint16_t)(f->fine ? 0 : far_apart < blurred ? far_apart : blurred);
}

struct rf_tile_rows rf_tile_rows(const struct rf_frame *f, const struct rf_tile_plan *plan,
                                 int behind)
{
    static const struct rf_tile_rows sparse[] = {{5, 4}, {3, 6}, {2, 8}};
    const int least = least_blur(plan, behind);

    for (int i = 0; f->row_gap && (f->splats || !plan->lamp) && i < 3; i++)
        if (least / sparse[i].step >= f->row_gap)
            return sparse[i];
    return (struct rf_tile_rows){1, RF_TILE};
}

struct rf_tile_rows rf_chroma_rows(const struct rf_frame *f, const struct rf_tile_plan *plan,
                                   int behind)
{
    const int least = least_blur(plan, behind);

    if (f->row_gap && (f->splats || !plan->lamp) && least / 4 >= f->row_gap)
        return (struct rf_tile_rows){2, 4};
    return (struct rf_tile_rows){1, RF_TILE / 2};
}
