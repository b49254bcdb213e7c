/* test_aperture.c: apertures: rays against the light through the same shape, point by point. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "unit_test.h"
#include <refocus/refocus.h>

#include "aperture/aperture.h"
#include "aperture/cat_shape.h"

enum { RAYS = 1024 };

/* Light of an aperture: mean place, mean squares, and how much of the unit square there is. */
struct light {
    double x, y, xx, yy, all;
};

static struct light of_rays(const struct refocus_ray *rays, int count)
{
    struct light l = {0, 0, 0, 0, 0};

    for (int n = 0; n < count; n++) {
        const double w = rays[n].weight, x = -rays[n].u / 32768.0, y = -rays[n].v / 32768.0;

        l.all += w;
        l.x += w * x;
        l.y += w * y;
        l.xx += w * x * x;
        l.yy += w * y * y;
    }
    l.x /= l.all;
    l.y /= l.all;
    l.xx /= l.all;
    l.yy /= l.all;
    return l;
}

static struct light whole(const struct refocus_aperture *a)
{
    static struct refocus_ray rays[255 * 255];
    const int count = refocus_aperture_full_rays(a, 60, 255 * 255, rays);

    assert_in_range(count, 1, 255 * 255);
    return of_rays(rays, count);
}

static void check_light(const struct refocus_aperture *a, const char *what)
{
    static struct refocus_ray rays[RAYS];
    const struct light wanted = whole(a);
    struct light is;

    assert_int_equal(refocus_aperture_rays(a, RAYS, rays), REFOCUS_OK);
    is = of_rays(rays, RAYS);
    if (fabs(is.x - wanted.x) > 0.006 || fabs(is.y - wanted.y) > 0.006 ||
        fabs(is.xx - wanted.xx) > 0.006 || fabs(is.yy - wanted.yy) > 0.006)
        fail_msg("%s: mean %g %g, squares %g %g, should be %g %g, %g %g", what, is.x, is.y, is.xx,
                 is.yy, wanted.x, wanted.y, wanted.xx, wanted.yy);
}

static struct refocus_aperture *make(const struct refocus_aperture_params *p)
{
    struct refocus_aperture *a;

    assert_int_equal(refocus_aperture_create(&a, p), REFOCUS_OK);
    return a;
}

/* 24 kinds, some with everything. */
static struct refocus_aperture_params kind(int i)
{
    static const uint8_t mask[3][4] = {{255, 0, 90, 0}, {255, 255, 255, 0}, {0, 255, 0, 30}};
    struct refocus_aperture_params p = refocus_aperture_params_default();

    p.figure = i % 4 == 2 ? REFOCUS_FIGURE_HEART : i % 4 == 3 ? REFOCUS_FIGURE_STAR : 0;
    p.blades = i % 4 == 1 ? 3 + i / 2 : i % 8 == 3 ? 6 : 0;
    p.rotation_deg = i * 7;
    p.curvature = i % 8 == 1 ? 0.6 : i == 13 ? 1 : 0;
    p.opening = i == 9 || i == 17 ? 0.8 : 0;
    p.squeeze = i % 3 == 1 ? 0.7 : i % 5 == 1 ? 1.6 : 1;
    p.hole = i > 8 && i % 2 ? 0.5 : 0;
    p.edge_behind = i > 12 ? (i % 3 - 1) * 0.8 : 0;
    p.edge_before = -p.edge_behind;
    if (i >= 20) {
        p.mask = mask[0];
        p.mask_width = p.mask_stride = 4;
        p.mask_height = 3;
        p.figure = 0;
        p.blades = 0;
        p.rotation_deg = p.curvature = p.opening = 0;
        p.hole = 0;
        p.edge_behind = p.edge_before = 0;
    }
    return p;
}

TEST(light)
{
    for (int i = 0; i < 24; i++) {
        const struct refocus_aperture_params p = kind(i);
        struct refocus_aperture *a = make(&p);
        char what[20];

        snprintf(what, sizeof what, "kind %d", i);
        check_light(a, what);
        refocus_aperture_destroy(&a);
    }
    for (uint32_t figure = 0; figure < REFOCUS_FIGURE_COUNT; figure++) {
        struct refocus_aperture_params p = refocus_aperture_params_default();
        struct refocus_aperture *a;
        char what[20];

        p.figure = figure;
        a = make(&p);
        snprintf(what, sizeof what, "figure %d", (int)figure);
        check_light(a, what);
        refocus_aperture_destroy(&a);
    }
}

/* The older functions still make equal apertures. */
TEST(simple)
{
    struct refocus_aperture_params p = refocus_aperture_params_default();
    struct refocus_aperture *a = make(&p), *b;
    struct refocus_ray is[64], wanted[64];

    assert_int_equal(refocus_aperture_rays(a, 64, is), REFOCUS_OK);
    assert_int_equal(refocus_aperture_rays(NULL, 64, wanted), REFOCUS_OK);
    assert_memory_equal(is, wanted, sizeof is);
    refocus_aperture_destroy(&a);
    p.blades = 7;
    p.rotation_deg = 33;
    a = make(&p);
    assert_int_equal(refocus_aperture_create_polygon(&b, 7, 33), REFOCUS_OK);
    assert_int_equal(refocus_aperture_rays(a, 64, is), REFOCUS_OK);
    assert_int_equal(refocus_aperture_rays(b, 64, wanted), REFOCUS_OK);
    assert_memory_equal(is, wanted, sizeof is);
    refocus_aperture_destroy(&a);
    refocus_aperture_destroy(&b);
    p.opening = 1; /* the barrel hides the blades */
    a = make(&p);
    assert_int_equal(refocus_aperture_rays(a, 64, is), REFOCUS_OK);
    assert_int_equal(refocus_aperture_rays(NULL, 64, wanted), REFOCUS_OK);
    assert_memory_equal(is, wanted, sizeof is);
    refocus_aperture_destroy(&a);
}

/* Open at a place in polar form, degrees counter-clockwise from the right. */
static bool open_at(const struct refocus_aperture *a, double radius, double degrees)
{
    const double t = degrees * 3.14159265358979 / 180;

    return rf_aperture_open(a, radius * cos(t), -radius * sin(t)) > 0;
}

TEST(blades)
{
    struct refocus_aperture_params p = refocus_aperture_params_default();
    struct refocus_aperture *a;

    p.blades = 6;
    p.rotation_deg = 10;
    for (int i = 0; i <= 4; i++) { /* the middle of a side bulges with its curvature */
        const double apothem = cos(3.14159265358979 / 6);
        const double middle = apothem + 0.25 * i * (1 - apothem);

        p.curvature = 0.25 * i;
        p.squeeze = i == 0 ? 0.999999 : 1; /* an outline, not a polygon */
        a = make(&p);
        for (int k = 0; k < 6; k++) {
            assert_true(open_at(a, 0.99, 10 + 60 * k));
            assert_true(open_at(a, middle - 0.005, 40 + 60 * k));
            assert_true(i == 4 || !open_at(a, middle + 0.005, 40 + 60 * k));
        }
        refocus_aperture_destroy(&a);
    }
    /* closed a little: round at the corners, straight between them */
    p.curvature = 0;
    p.opening = 0.95;
    a = make(&p);
    assert_true(open_at(a, 0.99, 10 + 5) && open_at(a, 0.99, 10 - 5));
    assert_true(open_at(a, 0.945, 40) && !open_at(a, 0.955, 40));
    refocus_aperture_destroy(&a);
    /* closed far: the polygon, as large as ever */
    p.opening = 0.2;
    a = make(&p);
    assert_true(open_at(a, 0.99, 10) && !open_at(a, 0.9, 15 + 10));
    assert_true(open_at(a, 0.86, 40) && !open_at(a, 0.875, 40));
    refocus_aperture_destroy(&a);
}

TEST(figures)
{
    struct refocus_aperture_params p = refocus_aperture_params_default();
    struct refocus_aperture *a;

    p.figure = REFOCUS_FIGURE_HEART; /* pointed below, notched above, two lobes */
    a = make(&p);
    assert_true(open_at(a, 0.85, 270) && !open_at(a, 0.85, 90));
    assert_true(open_at(a, 0.85, 45) && open_at(a, 0.85, 135));
    assert_true(!open_at(a, 0.85, 315) && !open_at(a, 0.85, 225));
    refocus_aperture_destroy(&a);
    p.figure = REFOCUS_FIGURE_STAR; /* one point up */
    a = make(&p);
    for (int k = 0; k < 5; k++)
        assert_true(open_at(a, 0.9, 90 + 72 * k) && !open_at(a, 0.5, 90 + 36 + 72 * k));
    refocus_aperture_destroy(&a);
}

static double mean_square(const struct refocus_aperture *a, bool before)
{
    struct refocus_ray rays[256];
    struct light l;

    rf_aperture_rays(a, 256, before, rays, NULL);
    l = of_rays(rays, 256);
    return l.xx + l.yy;
}

/* Mean squares of the profiles, which have closed forms: v is spread by its density. */
TEST(profiles)
{
    static const double edges[] = {-1, -0.5, 0, 0.3, 1};

    for (int i = 0; i < 5; i++) {
        struct refocus_aperture_params p = refocus_aperture_params_default();
        const double e = edges[i], bright = 0.5 + e / 3, faint = 0.5 + e / 6;
        struct refocus_aperture *a;

        p.edge_behind = e;
        p.edge_before = -e;
        p.hole = 0.3;
        a = make(&p);
        assert_true(rf_aperture_has_sides(a) == (e != 0));
        for (int before = 0; before < 2; before++) {
            const double s = before ? -e : e;
            const double v =
                s >= 0 ? (before ? 0.5 - e / 3 : bright) : (before ? 0.5 - e / 6 : faint);
            const double wanted = 0.09 + 0.91 * v;

            if (fabs(mean_square(a, before) - wanted) > 0.005)
                fail_msg("edge %g: %g, should be %g", s, mean_square(a, before), wanted);
        }
        refocus_aperture_destroy(&a);
    }
}

TEST(refused)
{
    static const uint8_t mask = 255;
    struct refocus_aperture *a;

    for (int i = 0; i < 24; i++) {
        struct refocus_aperture_params p = refocus_aperture_params_default();

        p.blades = i == 0 ? 2 : i == 1 ? 17 : i == 2 ? -1 : 0;
        p.rotation_deg = i == 3 ? (double)NAN : i == 4 ? 3601 : 0;
        p.curvature = i == 5 ? 1.1 : i == 6 ? -0.1 : i == 7 ? (double)NAN : 0;
        p.opening = i == 8 ? 1.1 : i == 9 ? (double)NAN : 0;
        p.squeeze = i == 10 ? 0.49 : i == 11 ? 2.1 : i == 12 ? (double)NAN : 1;
        p.hole = i == 13 ? 0.91 : i == 14 ? -0.1 : 0;
        p.edge_behind = i == 15 ? 1.1 : i == 16 ? (double)NAN : 0;
        p.edge_before = i == 17 ? -1.1 : 0;
        p.figure = i == 18 ? REFOCUS_FIGURE_COUNT : 0;
        if (i == 19)
            p.struct_size = 8;
        if (i == 20) {
            p.figure = REFOCUS_FIGURE_HEART;
            p.curvature = 0.5;
        }
        if (i >= 21) {
            p.mask = &mask;
            p.mask_width = i == 21 ? 0 : 1;
            p.mask_height = p.mask_stride = 1;
            p.blades = i == 22 ? 5 : 0;
            p.figure = i == 23 ? REFOCUS_FIGURE_STAR : 0;
        }
        a = (struct refocus_aperture *)&p;
        if (refocus_aperture_create(&a, &p) != REFOCUS_ERR_ARGUMENT || a)
            fail_msg("%d is not refused", i);
    }
    a = (struct refocus_aperture *)&mask;
    assert_int_equal(refocus_aperture_create(&a, NULL), REFOCUS_ERR_ARGUMENT);
    assert_null(a);
    const struct refocus_aperture_params good = refocus_aperture_params_default();
    assert_int_equal(refocus_aperture_create(NULL, &good), REFOCUS_ERR_ARGUMENT);
}

/* Whether a place lies within both circles, in the coordinates before the squeeze. */
static bool in_lens(const struct refocus_aperture *a, double x, double y, double d, double ex,
                    double ey, double slack)
{
    x /= a->squeeze_x;
    y /= a->squeeze_y;
    return hypot(x - d * ex, y - d * ey) <= 1 + slack && hypot(x + d * ex, y + d * ey) <= 1 + slack;
}

/* Returns the light that is common to the aperture and the two circles. */
static struct light of_common(const struct refocus_aperture *a, double d, double ex, double ey)
{
    enum { STEPS = 150 };
    struct light l = {0, 0, 0, 0, 0};

    for (int j = 0; j < 2 * STEPS; j++) {
        for (int i = 0; i < 2 * STEPS; i++) {
            const double x = (i + 0.5) / STEPS - 1, y = (j + 0.5) / STEPS - 1;

            if (!rf_aperture_open(a, x, y) || !in_lens(a, x, y, d, ex, ey, 0))
                continue;
            l.all++;
            l.x += x;
            l.y += y;
            l.xx += x * x;
            l.yy += y * y;
        }
    }
    l.x /= l.all;
    l.y /= l.all;
    l.xx /= l.all;
    l.yy /= l.all;
    return l;
}

/* Whether the aperture is open within a distance of a place. */
static bool is_open_about(const struct refocus_aperture *a, double x, double y, double within)
{
    for (int turn = 0; turn < 16; turn++)
        for (int part = 0; part <= 4; part++)
            if (rf_aperture_open(a, x + within * part / 4 * cos(turn * 0.3927),
                                 y + within * part / 4 * sin(turn * 0.3927)))
                return true;
    return false;
}

static void near_to(const char *what, double is, double should, double by)
{
    if (fabs(is - should) > by)
        fail_msg("%s: %g instead of %g", what, is, should);
}

/* Rays of irises and figures that two circles cut off: within all three, evenly. */
TEST(cut_off)
{
    enum { CORNER = 100 * 100, AMOUNT = 58982 }; /* 0.9 */
    static const struct {
        int x, y;
    } places[] = {{30, 0}, {-60, 25}, {0, -80}, {70, 70}, {-55, 60}, {13, -97}};
    static struct cat_case {
        const char *name;
        int blades;
        double curvature, squeeze;
        uint32_t figure;
    } cases[] = {{"triangle", 3, 0, 1, 0},
                 {"hexagon", 6, 0, 1, 0},
                 {"curved", 5, 0.5, 1, 0},
                 {"squeezed", 7, 0.2, 0.6, 0},
                 {"star", 5, 0, 1, REFOCUS_FIGURE_STAR},
                 {"heart", 0, 0, 1, REFOCUS_FIGURE_HEART}};
    static struct refocus_ray rays[RAYS], left[RAYS];
    static struct rf_cat_shape shape;

    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct refocus_aperture_params p = refocus_aperture_params_default();
        struct refocus_aperture *a;

        p.blades = cases[i].blades;
        p.rotation_deg = 11;
        p.curvature = cases[i].curvature;
        p.squeeze = cases[i].squeeze;
        p.figure = cases[i].figure;
        if (p.figure)
            p.rotation_deg = 0;
        assert_int_equal(refocus_aperture_create(&a, &p), REFOCUS_OK);
        assert_int_equal(refocus_aperture_rays(a, RAYS, rays), REFOCUS_OK);
        rf_cat_shape_make(&shape, a);
        assert_true(shape.is_there);
        for (size_t j = 0; j < sizeof places / sizeof *places; j++) {
            const int x = places[j].x, y = places[j].y;
            const double r = hypot(x, y), d = 0.9 * r * r / CORNER;
            struct rf_cat_shape_here here;
            struct light is, should;

            rf_cat_shape_at(&shape, x, y, CORNER, AMOUNT, &here);
            for (int n = 0; n < RAYS; n++) {
                const struct refocus_ray *const to = &left[n];
                double u, v;

                left[n] = rf_cat_shape_ray(&shape, &here, &rays[n]);
                u = -to->u / 32768.0;
                v = -to->v / 32768.0;
                assert_int_equal(to->weight, rays[n].weight);
                if (!is_open_about(a, u, v, 0.004) || !in_lens(a, u, v, d, x / r, y / r, 0.002))
                    fail_msg("%s at %d,%d: ray %d is outside, at %g,%g", cases[i].name, x, y, n, u,
                             v);
            }
            is = of_rays(left, RAYS);
            should = of_common(a, d, x / r, y / r);
            near_to(cases[i].name, is.x, should.x, 0.006);
            near_to(cases[i].name, is.y, should.y, 0.006);
            near_to(cases[i].name, sqrt(is.xx), sqrt(should.xx), 0.004);
            near_to(cases[i].name, sqrt(is.yy), sqrt(should.yy), 0.004);
        }
        /* nothing pushed: nothing moves by more than steps of the outline are long */
        struct rf_cat_shape_here whole;
        rf_cat_shape_at(&shape, 1, 0, CORNER, 0, &whole);
        for (int n = 0; n < RAYS; n++) {
            const struct refocus_ray to = rf_cat_shape_ray(&shape, &whole, &rays[n]);

            if (abs(to.u - rays[n].u) > 100 || abs(to.v - rays[n].v) > 100)
                fail_msg("%s: ray %d moves from %d,%d to %d,%d", cases[i].name, n, rays[n].u,
                         rays[n].v, to.u, to.v);
        }
        refocus_aperture_destroy(&a);
    }
    rf_cat_shape_make(&shape, &rf_disc);
    assert_false(shape.is_there);
}
