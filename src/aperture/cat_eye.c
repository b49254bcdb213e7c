/* cat_eye.c: moves rays of a circle into the lens shape that is left of it away from the axis. */
#include "aperture/cat_eye.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

enum { STEPS = 2048, ONE = 32767 };
static_assert(STEPS % RF_CAT_KNOTS == 0, "knots are steps");
static_assert(ONE >> 10 == RF_CAT_KNOTS - 1, "a ray lies before the last knot, with 10 bits left");
static_assert(2 * ONE * (1 << 10) <= INT32_MAX, "a difference of Q15 times 10 bits");

static double height_at(double x, double pushed)
{
    const double a = x + pushed;

    return a < 1 ? sqrt(1 - a * a) : 0;
}

static int16_t to_q15(double v)
{
    return (int16_t)floor((v > 1 ? 1 : v) * ONE + 0.5);
}

/* Adds up areas: area[i] is that of a quarter of the aperture up to i / STEPS of its half width. */
static void add_up(double pushed, double area[STEPS + 1])
{
    area[0] = 0;
    for (int i = 0; i < STEPS; i++)
        area[i + 1] =
            area[i] + height_at((i + 0.5) / STEPS * (1 - pushed), pushed) * (1 - pushed) / STEPS;
}

void rf_cat_eye_make(struct rf_cat_eye *eye)
{
    double whole[STEPS + 1], cut[STEPS + 1];

    if (eye->ready)
        return;
    add_up(0, whole);
    for (int level = 0; level < RF_CAT_LEVELS; level++) {
        const double pushed = (double)level / RF_CAT_LEVELS;
        int at = 0;

        add_up(pushed, cut);
        for (int k = 0; k <= RF_CAT_KNOTS; k++) {
            /* Heights vanish at the very end, so look just before it. */
            const int knot = k < RF_CAT_KNOTS ? k * (STEPS / RF_CAT_KNOTS) : STEPS - 1;
            const double share = whole[knot] / whole[STEPS] * cut[STEPS];
            double x;

            while (at < STEPS - 1 && cut[at + 1] <= share)
                at++;
            x = (at + (share - cut[at]) / (cut[at + 1] - cut[at])) / STEPS * (1 - pushed);
            eye->to[level][k] = to_q15(k < RF_CAT_KNOTS ? x : 1 - pushed);
            eye->height[level][k] =
                to_q15(height_at(x, pushed) / height_at((double)knot / STEPS, 0));
        }
    }
    eye->ready = true;
}

static int mix(int a, int b, int part, int bits)
{
    return a + (((b - a) * part + (1 << (bits - 1))) >> bits);
}

void rf_cat_eye_at(const struct rf_cat_eye *eye, int64_t x, int64_t y, int64_t corner, int amount,
                   struct rf_cat_eye_here *here)
{
    const int64_t square = x * x + y * y;
    const double length = sqrt((double)square); /* exact to the last bit */
    /* Levels in Q8. */
    const int pushed = (int)(square * amount / corner * RF_CAT_LEVELS >> 8);
    int level = pushed >> 8, part = pushed & 255;

    here->is_round = pushed == 0;
    if (here->is_round)
        return;
    if (level > RF_CAT_LEVELS - 2) {
        level = RF_CAT_LEVELS - 2;
        part = 255;
    }
    here->axis_x = (int)floor((double)x / length * ONE + 0.5);
    here->axis_y = (int)floor((double)y / length * ONE + 0.5);
    for (int k = 0; k <= RF_CAT_KNOTS; k++) {
        here->to[k] = (int16_t)mix(eye->to[level][k], eye->to[level + 1][k], part, 8);
        here->height[k] = (int16_t)mix(eye->height[level][k], eye->height[level + 1][k], part, 8);
    }
}

static int half_up(int64_t q30)
{
    return (int)((q30 + (1 << 14)) >> 15);
}

static int16_t clamp(int v)
{
    return (int16_t)(v > ONE ? ONE : v < -ONE ? -ONE : v);
}

struct refocus_ray rf_cat_eye_ray(const struct rf_cat_eye_here *here, const struct refocus_ray *ray)
{
    const int64_t ax = here->axis_x, ay = here->axis_y;
    const int along = half_up(ray->u * ax + ray->v * ay);
    const int across = half_up(ray->v * ax - ray->u * ay);
    const int x = abs(along) > ONE ? ONE : abs(along);
    const int knot = x >> 10, part = x & 1023;
    const int to = mix(here->to[knot], here->to[knot + 1], part, 10);
    const int height = mix(here->height[knot], here->height[knot + 1], part, 10);
    const int64_t new_along = along < 0 ? -to : to;
    const int64_t new_across = half_up((int64_t)across * height);

    return (struct refocus_ray){clamp(half_up(new_along * ax - new_across * ay)),
                                clamp(half_up(new_along * ay + new_across * ax)), ray->weight};
}
