/* plan.c: turns the parameters of the focus into fixed point. */
#include "focus/focus.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "aperture/aperture.h"
#include "image/planes.h"
#include "support/compare.h"

struct rf_focus rf_focus_of(float focus_disparity, float max_blur_radius)
{
    const int unit = rf_unit_of(max_blur_radius);

    return (struct rf_focus){
        .disparity = (uint16_t)floor((double)focus_disparity * 65535 + 0.5),
        .radius =
            (uint16_t)floor((double)max_blur_radius / (1 << unit) * 256 * 65536 / 65535 + 0.5),
        .unit = (uint16_t)unit,
    };
}

static int32_t to_fixed(double v, double one)
{
    return (int32_t)floor(v * one + 0.5);
}

/* Plans the tilt, which at the middle of pixel (x, y) is tilt + x tilt_x + y tilt_y. */
static_assert(INT64_C(2) * REFOCUS_MAX_TILT * RF_ONE * (1 << 24) < INT64_C(1) << 47,
              "both tilts together fit 64 bits, in Q24, and 32 bits without these");
static void plan_tilt(struct rf_focus_plan *plan, const struct rf_settings *p)
{
    const double q24 = 16777216.0, one = RF_ONE;
    const double across = p->tilt_across * one * q24, down = p->tilt_down * one * q24;

    plan->tilt_x = (int64_t)floor(across / plan->width + 0.5);
    plan->tilt_y = (int64_t)floor(down / plan->height + 0.5);
    plan->tilt = (int64_t)floor(across * (0.5 / plan->width - p->tilt_x) +
                                down * (0.5 / plan->height - p->tilt_y) + 0.5);
}

/* Makes a band. Its offset is that of its middle from the focus: added to e, it counts e from
 * there. */
static struct rf_band band_of(const struct rf_focus_plan *plan, int disparity, float half_width,
                              float transition)
{
    const int64_t away = (int64_t)(disparity - plan->focus.disparity) * plan->share;
    const int32_t sharp = to_fixed(half_width, RF_ONE);

    return (struct rf_band){(int32_t)((away + (1 << 15)) >> 16), sharp,
                            sharp + to_fixed(transition, RF_ONE)};
}

static void plan_bands(struct rf_focus_plan *plan, const struct rf_settings *p)
{
    if (p->bands == 0 && p->focus_half_width <= 0)
        return;
    plan->band[plan->bands++] =
        band_of(plan, plan->focus.disparity, p->focus_half_width, p->focus_transition);
    for (int i = 0; i < p->bands; i++)
        plan->band[plan->bands++] = band_of(plan, to_fixed(p->band[i].disparity, RF_ONE),
                                            p->band[i].half_width, p->band[i].transition);
}

static void plan_field(struct rf_focus_plan *plan, const struct rf_settings *p)
{
    double sine, cosine;

    rf_sincos_turns(p->field_angle / 360.0, &sine, &cosine);
    plan->picture = p->field_map;
    plan->field = (struct rf_field){
        .shape = p->field,
        .x = to_fixed(p->field_x, RF_ONE),
        .y = (uint32_t)floor((double)p->field_y * plan->height / plan->width * RF_ONE + 0.5),
        .disparity = to_fixed(p->field_disparity, RF_ONE),
        .radius = to_fixed(p->field_radius, RF_ONE),
        .falloff = to_fixed(p->field_falloff, RF_ONE),
        .normal_x = to_fixed(cosine, 1 << 30),
        .normal_d = to_fixed(sine, 1 << 30),
    };
}

void rf_focus_plan_make(struct rf_focus_plan *plan, const struct rf_settings *p,
                        struct rf_focus focus, int width, int height)
{
    memset(plan, 0, sizeof *plan);
    plan->focus = focus;
    plan->width = width;
    plan->height = height;
    plan->least = (uint16_t)to_fixed(p->least_disparity, RF_ONE);
    plan->most = (uint16_t)to_fixed(p->most_disparity, RF_ONE);
    plan->limit =
        (uint16_t)rf_smaller(to_fixed(p->blur_limit, 256.0 / (1 << focus.unit)), UINT16_MAX);
    plan->share = to_fixed(p->depth_share, 65536);
    plan->surface = p->focus_map;
    plan->sharp = p->sharp_map;
    plan_tilt(plan, p);
    plan_bands(plan, p);
    plan_field(plan, p);
    plan->plain = p->field == REFOCUS_FIELD_LENS && plan->least == 0 && plan->most == RF_ONE &&
                  plan->limit >= focus.radius && plan->share == 65536 && !plan->tilt_x &&
                  !plan->tilt_y && !plan->tilt && !plan->bands && !plan->surface && !plan->sharp;
}

float rf_focus_largest(const struct rf_focus_plan *plan, float max_blur_radius)
{
    const int df = plan->focus.disparity, farther = rf_larger(df, UINT16_MAX - df);

    return plan->plain ? ((float)farther * plan->focus.radius / 65536 + 1) / 256 *
                             (float)(1 << plan->focus.unit)
                       : max_blur_radius;
}
