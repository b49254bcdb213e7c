/* row.c: computes the signed blur of a row from places and disparities. */
#include "focus/focus.h"
#include "support/compare.h"

#include <stdlib.h>

/* How much a band leaves of a distance from its middle: nothing where it is sharp, then more and
 * more up to all of it. */
static int32_t shorten(const struct rf_band *band, int32_t distance)
{
    if (distance <= band->sharp)
        return 0;
    if (distance >= band->whole)
        return distance;
    return (int32_t)((int64_t)(distance - band->sharp) * band->whole / (band->whole - band->sharp));
}

/*
 * The least that any band leaves of e. For the first band e is counted from the focus at this
 * place; for the further bands it is `flat`, counted from the focus disparity. Before the nearest
 * band a pixel is foreground, beyond it background, so that a surface between two bands, which is
 * blurred, does not spread over the near one.
 */
static int32_t shorten_by_bands(const struct rf_focus_plan *plan, int32_t e, int32_t flat)
{
    int32_t least = INT32_MAX;
    bool before = true;

    for (int i = 0; i < plan->bands; i++) {
        const int64_t own = (int64_t)(i ? flat : e) + plan->band[i].offset;
        const int32_t left = shorten(&plan->band[i], (int32_t)llabs(own));

        before = before && own < 0;
        least = left < least ? left : least;
    }
    return before ? -least : least;
}

/* The part of a difference of disparities that counts. */
static int32_t depth_of(const struct rf_focus_plan *plan, int difference)
{
    return (int32_t)(((int64_t)difference * plan->share + (1 << 15)) >> 16);
}

static int32_t lens_at(const struct rf_focus_plan *plan, int x, int y, int d)
{
    const int64_t tilt = plan->tilt + plan->tilt_x * x + plan->tilt_y * y;
    const int32_t rise = (int32_t)((tilt + (1 << 23)) >> 24);
    const int32_t flat = depth_of(plan, plan->focus.disparity - d) + rise;
    int32_t e = flat;

    if (plan->surface)
        e = depth_of(plan, rf_map_at(plan->surface, plan->width, plan->height, x, y) - d) + rise;
    return plan->bands ? shorten_by_bands(plan, e, flat) : e;
}

void rf_focus_row(const struct rf_focus_plan *plan, int16_t *blur, const uint16_t *disparity, int x,
                  int y, int n)
{
    for (int i = 0; i < n; i++) {
        const int d = rf_clamp(disparity[i], plan->least, plan->most);
        const int32_t e = plan->field.shape == REFOCUS_FIELD_LENS ? lens_at(plan, x + i, y, d)
                                                                  : rf_field_at(plan, x + i, y, d);
        const uint32_t distance = (uint32_t)rf_clamp(abs(e), 0, RF_ONE);
        /* The kernel signed_blur computes this for a plain lens, with the same bits. */
        uint32_t s = (distance * plan->focus.radius + (1 << 15)) >> 16;

        s = s > plan->limit ? plan->limit : s;
        if (plan->sharp) {
            const int sharp = rf_map_at(plan->sharp, plan->width, plan->height, x + i, y);

            s = (s * (uint32_t)(RF_ONE - sharp) + RF_ONE / 2) / RF_ONE;
        }
        blur[i] = (int16_t)(e < 0 ? -(int)s : (int)s);
    }
}
