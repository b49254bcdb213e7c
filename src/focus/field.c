/* field.c: computes blur from its place in space, Kosloff & Barsky 2007, section 5. */
#include "focus/focus.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

/* Offsets from the centre are clamped to this, as a photo may be 65535 times as high as it is wide.
 * Anything so far off is beyond a radius and a falloff of 4 picture widths each. */
enum { FARTHEST = 1 << 20 };
static_assert((4 + 4) * RF_ONE < FARTHEST, "what is clamped is wholly blurred");

/* The length of a vector, rounded half up. sqrt is exact to the last bit wherever doubles are
 * IEEE's, and the sum has 53 bits at most. */
static_assert(INT64_C(3) * FARTHEST * FARTHEST < INT64_C(1) << 53, "a double holds the sum");
static int32_t length(int64_t a, int64_t b, int64_t c)
{
    return (int32_t)floor(sqrt((double)(a * a + b * b + c * c)) + 0.5);
}

/* The offset of the middle of pixel `at` from `centre`, in picture widths. */
static int32_t offset(int at, int width, int64_t centre)
{
    const int64_t away = ((int64_t)(2 * at + 1) * RF_ONE + width) / (2 * width) - centre;

    return (int32_t)(away < -FARTHEST ? -FARTHEST : away > FARTHEST ? FARTHEST : away);
}

/* The blur at a distance: 0 within the radius, RF_ONE from a falloff beyond it on. */
static int32_t beyond(const struct rf_field *field, int32_t distance)
{
    const int64_t over = distance - field->radius;
    const int64_t e = (over * RF_ONE + field->falloff / 2) / field->falloff;

    return over <= 0 ? 0 : e > RF_ONE ? RF_ONE : (int32_t)e;
}

int32_t rf_field_at(const struct rf_focus_plan *plan, int x, int y, int d)
{
    const struct rf_field *field = &plan->field;
    const int32_t fx = offset(x, plan->width, field->x);
    const int32_t fy = offset(y, plan->width, field->y);
    const int32_t fd = d - field->disparity;
    int32_t e;

    switch (field->shape) {
    case REFOCUS_FIELD_PLANE: {
        const int64_t v = (int64_t)fx * field->normal_x + (int64_t)fd * field->normal_d;
        const int32_t side = (int32_t)((llabs(v) + (1 << 29)) >> 30);

        e = beyond(field, side);
        return (v > 0) == (field->normal_d >= 0) ? -e : e;
    }
    case REFOCUS_FIELD_CYLINDER:
        e = beyond(field, length(fx, 0, fd));
        break;
    case REFOCUS_FIELD_PLUS:
        e = beyond(field, abs(fx) < abs(fd) ? abs(fx) : abs(fd));
        break;
    case REFOCUS_FIELD_SPHERE:
        e = beyond(field, length(fx, fy, fd));
        break;
    default: /* REFOCUS_FIELD_PICTURE */
        e = rf_map_at(plan->picture, plan->width, plan->height, x, y);
        return d > plan->focus.disparity ? -e : e;
    }
    return fd > 0 ? -e : e;
}
