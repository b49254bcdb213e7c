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

/* The area of a quarter of the aperture up to (i + 1) / STEPS of its half width, from that up to i
 * / STEPS. */
static double area_after(double area, int i, double pushed)
{
    return area + height_at((i + 0.5) / STEPS * (1 - pushed), pushed) * (1 - pushed) / STEPS;
}

/* Heights vanish at the very end, so the last knot is just before it. */
static int step_of(int knot)
{
    return knot < RF_CAT_KNOTS ? knot * (STEPS / RF_CAT_KNOTS) : STEPS - 1;
}

/* The whole area; part[k] is that up to knot k. */
static double area_of(double pushed, double part[RF_CAT_KNOTS + 1])
{
    double area = 0;

    for (int i = 0, k = 0; i < STEPS; i++) {
        if (i == step_of(k))
            part[k++] = area;
        area = area_after(area, i, pushed);
    }
    return area;
}

void rf_cat_eye_make(struct rf_cat_eye *eye)
{
    double whole[RF_CAT_KNOTS + 1], parts[RF_CAT_KNOTS + 1];
    double all;

    if (eye->ready)
        return;
    all = area_of(0, whole);
    for (int level = 0; level < RF_CAT_LEVELS; level++) {
        const double pushed = (double)level / RF_CAT_LEVELS, cut = area_of(pushed, parts);
        double area = 0, next = area_after(0, 0, pushed);
        int at = 0;

        for (int k = 0; k <= RF_CAT_KNOTS; k++) {
            const int knot = step_of(k);
            const double share = whole[k] / all * cut;
            double x;

            while (at < STEPS - 1 && next <= share) {
                area = next;
                next = area_after(next, ++at, pushed);
            }
            x = (at + (share - area) / (next - area)) / STEPS * (1 - pushed);
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
