/* test_scatter.c: circles of confusion of Potmesil & Chakravarty 1981: their intensity against
 * the diffraction integral, evaluated numerically, and against the series that the paper prints;
 * their energy; and what `scatter` makes of a point. */
#include <complex.h>

#include "papers/lommel.h"
#include "papers/scatter.h"
#include "pictures.h"

static const double pi = 3.14159265358979323846;

/* J_n(x) = 1/pi integral 0..pi cos(n t - x sin t) dt, periodic: the trapezium rule is exact to
 * rounding. */
static double bessel(int n, double x)
{
    enum { STEPS = 400 };
    double sum = 0;

    for (int i = 0; i < STEPS; i++) {
        const double t = pi * (i + 0.5) / STEPS;
        sum += cos(n * t - x * sin(t));
    }
    return sum / STEPS;
}

/* |2 integral 0..1 J0(v t) exp(-i u t^2 / 2) t dt|^2 by Simpson's rule. */
static double by_integral(double u, double v)
{
    enum { STEPS = 1200 };
    double complex sum = 0;

    for (int i = 0; i <= STEPS; i++) {
        const double t = (double)i / STEPS;
        const int weight = i == 0 || i == STEPS ? 1 : i % 2 ? 4 : 2;
        sum += weight * bessel(0, v * t) * cexp(-I * u * t * t / 2) * t;
    }
    sum *= 2.0 / (3 * STEPS);
    return creal(sum * conj(sum));
}

/* Eq. 13 and 14 as printed: (2/u)^2 (U_1^2 + U_2^2), U_n = sum (-1)^s (u/v)^(n+2s) J_(n+2s)(v). */
static double by_printed_series(double u, double v)
{
    double U[3] = {0};

    for (int n = 1; n <= 2; n++)
        for (int s = 0; s < 16 && fabs(bessel(n + 2 * s, v)) > 1e-13; s++)
            U[n] += (s % 2 ? -1 : 1) * pow(u / v, n + 2 * s) * bessel(n + 2 * s, v);
    return 4 / (u * u) * (U[1] * U[1] + U[2] * U[2]);
}

TEST(lommel)
{
    static const double us[] = {0.5, 1, 3, 4 * pi, 10, 20, 45, 90};

    for (int i = 0; i < 8; i++) {
        const double u = us[i];

        if (left_out(i + 1, 3))
            continue;
        for (int k = 0; k <= 8; k++) {
            const double v = u * k / 8, value = rf_lommel(u, v), expected = by_integral(u, v);

            if (fabs(value - expected) > 1e-9)
                fail_msg("I(%g, %g) is %.12g, by the integral %.12g", u, v, value, expected);
            if (u <= 10 && k >= 4 && fabs(value - by_printed_series(u, v)) > 1e-7)
                fail_msg("I(%g, %g) is %.12g, by the printed series %.12g", u, v, value,
                         by_printed_series(u, v));
        }
        /* eq. 19: the middle of the circle, dark where u = 4 pi */
        assert_true(fabs(rf_lommel(u, 0) - pow(sin(u / 4) / (u / 4), 2)) < 1e-12);
    }
}

/* Eq. 12: in focus, u to 0, it is Airy's pattern (2 J1(v) / v)^2. */
TEST(airy)
{
    for (double v = 0.001; v <= 0.01; v += 0.001)
        assert_true(fabs(rf_lommel(0.01, v) - pow(2 * bessel(1, v) / v, 2)) < 1e-5);
    assert_true(fabs(rf_lommel(0.01, 0.009) - 1) < 1e-4);
}

/* Eq. 17 to 19 by the paper's quantities: lambda = 550 nm, N = F / d = 22, pixels of 2 micrometres.
 * Where V_p lies z beyond the image plane at F, u = k (d / 2F)^2 z and the circle's radius is
 * z / 2N; the middle is dark where u = 4 pi, and bright at half of that. */
TEST(quantities)
{
    enum { REACH = 25 };
    const double lambda = 0.55, N = 22, pixel = 2, k = 2 * pi / lambda;
    const double airy_radius = 1.2197 * lambda * N / pixel; /* J1(3.8317) = 0 in eq. 12 */
    double middle[2], around;

    for (int i = 0; i < 2; i++) {
        const double z = (i ? 2 : 4) * pi / (k / (4 * N * N));
        uint32_t share[(2 * REACH + 1) * (REACH + 1)];
        struct rf_spread_table table = {z / (2 * N) / pixel, REACH, share};

        assert_true(table.radius > 10 && table.radius < REACH);
        rf_spread_fill(&table, REFOCUS_SPREAD_LOMMEL, airy_radius, NULL);
        middle[i] = share[REACH];
        around = share[REACH + (int)(airy_radius + 0.5)];
        /* eq. 18: v = k rho / 2N is 3.8317 a ring of Airy's from the middle */
        if (i == 0)
            assert_true(middle[0] < 0.1 * around);
    }
    assert_true(middle[1] > 10 * middle[0]);
    for (int i = 1; i < 4; i++)
        assert_true(fabs(k * i / (2 * N) / (3.8317 * i / (airy_radius * pixel)) - 1) < 1e-3);
}

/* The light of a circle that lands in pixels, of all of it: 1, for every table. */
TEST(energy)
{
    static const double radii[] = {5, 20, 40, 127};

    for (int r = 0; r < 4; r++) {
        const int tables = rf_spread_tables(radii[r]);
        uint32_t *share = malloc(sizeof *share * 256 * 129);

        assert_non_null(share);
        assert_true(tables >= 73);
        for (int i = 0; i < tables; i += left_out(1, 2) ? 17 : 1 + tables / 90) {
            for (uint32_t spread = 0; spread < 2; spread++) {
                struct rf_spread_table table = {radii[r] * i / (tables - 1),
                                                rf_spread_reach(radii[r], i), share};
                double sum = 0, outside = 0;

                rf_spread_fill(&table, spread, 1, NULL);
                for (int y = 0; y <= table.reach; y++) {
                    for (int x = -table.reach; x <= table.reach; x++) {
                        const double value =
                            (y ? 2.0 : 1.0) *
                            table.share[y * (2 * table.reach + 1) + table.reach + x];
                        sum += value;
                        if (hypot(x, y) > table.radius + 0.75)
                            outside += value;
                    }
                }
                if (fabs(sum / RF_SPREAD_ONE - 1) > 0.005 || outside > 0)
                    fail_msg("radius %g: energy %g, %g outside", table.radius, sum / RF_SPREAD_ONE,
                             outside / RF_SPREAD_ONE);
            }
        }
        free(share);
    }
}

/* A uniform circle: each pixel gets its own area of it. */
TEST(uniform_shares)
{
    uint32_t share[31 * 16];
    struct rf_spread_table table = {12.3, 15, share};
    const double each = RF_SPREAD_ONE / (pi * 12.3 * 12.3);

    rf_spread_fill(&table, REFOCUS_SPREAD_UNIFORM, 1, NULL);
    for (int y = 0; y < 16; y++) {
        for (int x = -15; x <= 15; x++) {
            const double r = hypot(x, y), value = share[y * 31 + 15 + x] / each;

            if (r < 12.3 - 0.75)
                assert_true(fabs(value - 1) < 0.01);
            if (r > 12.3 + 0.75)
                assert_true(value <= 0);
        }
    }
}

/* One white pixel on black, out of focus: the sum of light over the picture is what it was. */
TEST(point)
{
    enum { SIDE = 61 };
    struct picture p = picture_flat(SIDE, SIDE, (uint8_t[3]){0, 0, 0}, 0);
    struct refocus_settings params = refocus_settings_default(1, 6);
    struct refocus_renderer *renderer;
    uint8_t out[SIDE * SIDE * 3];
    const struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, out, SIDE, SIDE, 3 * SIDE);
    double sum = 0;

    memset(p.rgb + 3 * (30 * SIDE + 30), 255, 3);
    renderer = prepared(&p, 6, 2);
    params.render.method = REFOCUS_METHOD_SCATTER;
    params.render.blend = REFOCUS_BLEND_STORED;
    assert_int_equal(refocus_render_settings(renderer, &params, &image), 0);
    for (int i = 0; i < SIDE * SIDE; i++)
        sum += out[3 * i];
    /* 113 pixels of 2.25 codes each, rounded: 2 for the inner ones */
    assert_true(sum > 113 * 1.8 && sum < 113 * 2.6);
    params.look.star_spikes = 4; /* light beyond the circle now, on the axes alone */
    params.look.star_strength = 1;
    params.render.sigma = 20;
    assert_int_equal(refocus_render_settings(renderer, &params, &image), 0);
    assert_true(out[3 * (30 * SIDE + 47)] > 100 && out[3 * (13 * SIDE + 30)] > 100);
    assert_true(out[3 * (42 * SIDE + 42)] < 20);
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}
