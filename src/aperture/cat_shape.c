/* cat_shape.c: moves rays of an iris or a figure into what a lens leaves of it away from the axis.
 */
#include "aperture/cat_shape.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

#include "aperture/shape.h"

enum { ONE = 32767, SIDE = 1 << RF_KNOT_BITS, TURN = 4 << 16, PART_BITS = 10 };

static_assert((int64_t)2 * ONE * (1 << PART_BITS) <= INT32_MAX, "a difference of Q15 times bits");

struct point {
    double u, v;
};

static double cross(struct point a, struct point b)
{
    return a.u * b.v - a.v * b.u;
}

/* The direction at a number of quarter turns from (1, 0), 0 to 4. */
static struct point direction(double turns)
{
    const double part = turns - floor(turns), rest = 1 - part;

    switch ((int)turns % 4) {
    case 0:
        return (struct point){rest, part};
    case 1:
        return (struct point){-part, rest};
    case 2:
        return (struct point){-rest, -part};
    default:
        return (struct point){part, -rest};
    }
}

/* Corner i of the outline, with the signs of rays: minus the place on the mask as it is seen. */
static struct point corner(const struct refocus_aperture *a, int i)
{
    const struct rf_corner seen = a->shape->corner(a, i % a->shape->corners(a));

    return (struct point){-seen.x, -seen.y};
}

/* Whether an outline is that of a circle, which cat_eye.h cuts for less. */
static bool is_circle(const struct refocus_aperture *a)
{
    if (a->shape != &rf_shape_outline)
        return false;
    for (int i = 0; i < RF_OUTLINE; i++)
        if (fabs(a->tables->vertex_x[i] * a->tables->vertex_x[i] +
                 a->tables->vertex_y[i] * a->tables->vertex_y[i] - 1) > 1e-9)
            return false;
    return true;
}

/* The point of the outline in a direction from the middle. */
static struct point outline_at(const struct refocus_aperture *a, struct point to)
{
    for (int i = 0; i < a->shape->corners(a); i++) {
        const struct point p = corner(a, i), q = corner(a, i + 1);
        const double way = cross(p, q) < 0 ? -1 : 1; /* it may run either way round */
        const double before = way * cross(p, to), behind = way * cross(to, q);

        if (before >= 0 && behind >= 0 && before + behind > 0) {
            const double t = before / (before + behind);
            const struct point at = {p.u + t * (q.u - p.u), p.v + t * (q.v - p.v)};

            if (at.u * to.u + at.v * to.v > 0)
                return at;
        }
    }
    return to;
}

static double quarter_turns(struct point p)
{
    const double span = fabs(p.u) + fabs(p.v);

    if (p.u > 0 && p.v >= 0)
        return p.v / span;
    if (p.u <= 0 && p.v > 0)
        return 1 - p.u / span;
    return p.u < 0 ? 2 - p.v / span : 3 + p.u / span;
}

/* The sine of the angle by which the outline turns at corner i. */
static double turn_at(const struct refocus_aperture *a, int i)
{
    const int n = a->shape->corners(a);
    const struct point p = corner(a, (i + n - 1) % n), q = corner(a, i), r = corner(a, (i + 1) % n);
    const struct point in = {q.u - p.u, q.v - p.v}, out = {r.u - q.u, r.v - q.v};

    return fabs(cross(in, out)) /
           sqrt((in.u * in.u + in.v * in.v) * (out.u * out.u + out.v * out.v));
}

/* Places the knots: the direction of each in quarter turns. The first may be a little below 0. */
static void place_knots(const struct refocus_aperture *a, double turns[RF_KNOTS + 1])
{
    double sharpest[RF_KNOTS];

    for (int k = 0; k < RF_KNOTS; k++) {
        turns[k] = (double)k / SIDE;
        sharpest[k] = 0.1; /* a smooth outline turns by less at a vertex */
    }
    for (int i = 0; i < a->shape->corners(a); i++) {
        const double at = quarter_turns(corner(a, i)), turn = turn_at(a, i);
        const int k = (int)floor(at * SIDE + 0.5);

        if (turn > sharpest[k % RF_KNOTS]) {
            sharpest[k % RF_KNOTS] = turn;
            turns[k % RF_KNOTS] = k < RF_KNOTS ? at : at - 4;
        }
    }
    turns[RF_KNOTS] = turns[0] + 4;
}

/* Adds up twice the areas of the triangles between the middle and neighbouring knots. */
static double add_up(const double *u, const double *v, double *area)
{
    area[0] = 0;
    for (int k = 0; k < RF_KNOTS; k++)
        area[k + 1] = area[k] + (u[k] * v[k + 1] - v[k] * u[k + 1]);
    return area[RF_KNOTS];
}

void rf_cat_shape_make(struct rf_cat_shape *shape, const struct refocus_aperture *a)
{
    double turns[RF_KNOTS + 1], all;

    if (shape->id == a->id)
        return;
    shape->id = a->id;
    shape->is_there = a->shape->corner && !is_circle(a);
    if (!shape->is_there)
        return;
    place_knots(a, turns);
    for (int k = 0; k <= RF_KNOTS; k++) {
        const double turn = turns[k] < 0 ? turns[k] + 4 : turns[k];
        const struct point at = outline_at(a, direction(turn));
        const double u = at.u / a->squeeze_x, v = at.v / a->squeeze_y;

        shape->place[k] = (int32_t)floor(turns[k] * 65536 + 0.5);
        shape->u[k] = at.u;
        shape->v[k] = at.v;
        shape->span[k] = (int32_t)floor((fabs(at.u) + fabs(at.v)) * 32768 + 0.5);
        if (k < RF_KNOTS) {
            shape->length[k] = sqrt(u * u + v * v);
            shape->along_u[k] = u / shape->length[k];
            shape->along_v[k] = v / shape->length[k];
        }
    }
    all = add_up(shape->u, shape->v, shape->area);
    for (int k = 0; k <= RF_KNOTS; k++)
        shape->area[k] /= all;
}

static int16_t to_q15(double x)
{
    const double q = floor(x * 32768 + 0.5);

    return (int16_t)(q > ONE ? ONE : q < -ONE ? -ONE : q);
}

void rf_cat_shape_at(const struct rf_cat_shape *shape, int64_t x, int64_t y, int64_t corner,
                     int amount, struct rf_cat_shape_here *here)
{
    double u[RF_KNOTS + 1], v[RF_KNOTS + 1], area[RF_KNOTS + 1];
    const int64_t square = x * x + y * y;
    const double distance = sqrt((double)square),
                 d = (double)(square * amount) / ((double)corner * 65536);
    const double axis_u = (double)x / distance, axis_v = (double)y / distance;
    double all;
    int at = 0;

    for (int k = 0; k < RF_KNOTS; k++) {
        /* A ray whose direction has the cosine c to the axis leaves the two circles at
         * sqrt(1 - d^2 (1 - c^2)) -+ d |c|: the nearer one counts. */
        const double c = fabs(shape->along_u[k] * axis_u + shape->along_v[k] * axis_v);
        const double most = sqrt(1 - d * d * (1 - c * c)) - d * c;
        const double part = most < shape->length[k] ? most / shape->length[k] : 1;

        u[k] = shape->u[k] * part;
        v[k] = shape->v[k] * part;
    }
    u[RF_KNOTS] = u[0];
    v[RF_KNOTS] = v[0];
    all = add_up(u, v, area);
    for (int k = 0; k < RF_KNOTS; k++) {
        const double share = shape->area[k] * all;
        double part;

        while (at < RF_KNOTS - 1 && area[at + 1] <= share)
            at++;
        part = (share - area[at]) / (area[at + 1] - area[at]);
        here->u[k] = to_q15(u[at] + part * (u[at + 1] - u[at]));
        here->v[k] = to_q15(v[at] + part * (v[at + 1] - v[at]));
    }
    here->u[RF_KNOTS] = here->u[0];
    here->v[RF_KNOTS] = here->v[0];
}

/* The direction of (u, v) in quarter turns, Q16. */
static int32_t place_of(int u, int v, int32_t span)
{
    const int32_t quarter = u > 0 && v >= 0 ? 0 : u <= 0 && v > 0 ? 1 : u < 0 && v <= 0 ? 2 : 3;
    const int32_t past = quarter % 2 ? abs(u) : abs(v);

    return (quarter << 16) + (int32_t)(((int64_t)past << 16) / span);
}

/* Finds the knot before a place, and brings the place between the first knot and the last. Knots
 * are at most half a step from where equal steps would have them. */
static int find_knot(const struct rf_cat_shape *shape, int32_t *place)
{
    int k;

    if (*place < shape->place[0])
        *place += TURN;
    if (*place >= shape->place[RF_KNOTS])
        *place -= TURN;
    k = *place < 0 ? 0 : *place >> (16 - RF_KNOT_BITS);
    k = k < RF_KNOTS ? k : RF_KNOTS - 1;
    if (k > 0 && *place < shape->place[k])
        return k - 1;
    return *place >= shape->place[k + 1] ? k + 1 : k;
}

static int mix(int a, int b, int part)
{
    return a + (((b - a) * part + (1 << (PART_BITS - 1))) >> PART_BITS);
}

static int16_t scaled(int outline, int32_t share)
{
    const int64_t q = ((int64_t)outline * share + (1 << 14)) >> 15;

    return (int16_t)(q > ONE ? ONE : q < -ONE ? -ONE : q);
}

struct refocus_ray rf_cat_shape_ray(const struct rf_cat_shape *shape,
                                    const struct rf_cat_shape_here *here,
                                    const struct refocus_ray *ray)
{
    const int32_t span = abs(ray->u) + abs(ray->v);
    int32_t place, share;
    int k, part;

    if (span == 0)
        return *ray;
    place = place_of(ray->u, ray->v, span);
    k = find_knot(shape, &place);
    part = (int)((int64_t)(place - shape->place[k]) * (1 << PART_BITS) /
                 (shape->place[k + 1] - shape->place[k]));
    share = (int32_t)(((int64_t)span << 15) / mix(shape->span[k], shape->span[k + 1], part));
    share = share < 1 << 15 ? share : 1 << 15; /* the outline is straight between knots */
    return (struct refocus_ray){scaled(mix(here->u[k], here->u[k + 1], part), share),
                                scaled(mix(here->v[k], here->v[k + 1], part), share), ray->weight};
}
