/* test_optics.c: scenes whose answer is known from optics: a point of light out of focus is the
 * image of the aperture, of radius K |d - df|.
 *
 * The point is the one white pixel of a black plane. Plain averaging would leave less than
 * one code of it; the weights of eq. 5 bring it out: a pixel that sees the point through
 * the share a of the aperture becomes 255 a / (a + (1 - a) w), w = exp(-255^2 / 2 sigma^2)
 * the weight of black, over stored values. */
#include "pictures.h"

enum { SIDE = 175, MIDDLE = SIDE / 2 };

/* A view of the point: its disparity, and the lens that it is seen through. */
struct view {
    uint32_t method;
    struct refocus_aperture *aperture;
    float disparity, focus, blur;
};

/* Renders the point; share[y][x] of the aperture that each pixel sees it through. */
static void render_point(const struct view *view, float sigma, double share[SIDE][SIDE])
{
    static uint8_t out[SIDE][SIDE][3];
    const int radius = (int)(view->blur * fabsf(view->disparity - view->focus)) + 8;
    const int side = 2 * radius + 1 < SIDE ? 2 * radius + 1 : SIDE, corner = MIDDLE - side / 2;
    struct picture p = picture_flat(SIDE, SIDE, (uint8_t[3]){0, 0, 0},
                                    (uint16_t)lround((double)view->disparity * 65535));
    struct refocus_settings params = refocus_settings_default(view->focus, view->blur);
    const struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, out[corner][corner], side, side, sizeof out[0]);
    const double w = exp(-255.0 * 255 / (2 * (double)sigma * (double)sigma));
    struct refocus_renderer *renderer;

    memset(p.rgb + 3 * (MIDDLE * SIDE + MIDDLE), 255, 3);
    renderer = prepared(&p, view->blur, 2);
    params.render.method = view->method;
    params.render.rays = REFOCUS_RAYS_FULL;
    params.render.blend = REFOCUS_BLEND_STORED;
    params.render.sigma = sigma;
    params.search.iterations = 1;
    params.render.aperture = view->aperture;
    params.render.region_x = params.render.region_y = corner; /* the rest takes long and is black */
    params.render.region_width = params.render.region_height = side;
    memset(out, 0, sizeof out);
    assert_int_equal(refocus_render_settings(renderer, &params, &image), 0);
    for (int y = 0; y < SIDE; y++) {
        for (int x = 0; x < SIDE; x++) {
            const double odds = out[y][x][1] / (255.0 - fmin(out[y][x][1], 254)) * w;
            share[y][x] = odds / (1 + odds);
        }
    }
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

/* Share of a pixel inside the image, the mean of those around its middle. */
static double inside(const struct view *view, double share[SIDE][SIDE])
{
    const int reach = (int)(view->blur * fabsf(view->disparity - view->focus) / 3);
    double sum = 0;
    int n = 0;

    for (int y = MIDDLE - reach; y <= MIDDLE + reach; y++) {
        for (int x = MIDDLE - reach; x <= MIDDLE + reach; x++) {
            if (hypot(x - MIDDLE, y - MIDDLE) <= reach)
                sum += share[y][x], n++;
        }
    }
    return sum / n;
}

/* Area of the point's image by its second moment, the mean square distance from its
 * middle. A common error of all shares, such as the rounding of the code inside, cancels.
 * @per_moment is area / moment of the shape: 2 pi of a disc. */
static void check_area(const struct view *view, double share[SIDE][SIDE], double area,
                       double per_moment)
{
    double sum = 0, moment = 0, measured;

    for (int y = 0; y < SIDE; y++) {
        for (int x = 0; x < SIDE; x++) {
            const double dx = x - MIDDLE, dy = y - MIDDLE;

            sum += share[y][x];
            moment += share[y][x] * (dx * dx + dy * dy);
        }
    }
    measured = per_moment * moment / sum;
    if (fabs(measured - area) > 0.005 * area)
        fail_msg("%s, d %g, df %g, K %g: area %.1f, should be %.1f",
                 refocus_method_name(view->method), (double)view->disparity, (double)view->focus,
                 (double)view->blur, measured, area);
}

static void check_disc(uint32_t method, float disparity, float focus, float blur)
{
    static double share[SIDE][SIDE];
    const struct view view = {method, NULL, disparity, focus, blur};
    const double radius = (double)blur * fabs((double)disparity - (double)focus);

    render_point(&view, 64, share);
    const double whole = inside(&view, share);
    for (int y = 0; y < SIDE; y++) {
        for (int x = 0; x < SIDE; x++) {
            const double from_middle = hypot(x - MIDDLE, y - MIDDLE);
            const int lit = share[y][x] >= whole / 4;

            if ((from_middle < radius - 0.75 && !lit) || (from_middle > radius + 0.75 && lit))
                fail_msg("%s, d %g, df %g, K %g: (%d, %d) from the middle is %s",
                         refocus_method_name(method), (double)disparity, (double)focus,
                         (double)blur, x - MIDDLE, y - MIDDLE, lit ? "lit" : "dark");
        }
    }
    check_area(&view, share, 3.14159265358979 * radius * radius, 2 * 3.14159265358979);
}

TEST(disc)
{
    for (uint32_t method = 0; method < REFOCUS_METHOD_RAYTRACE; method++) {
        check_disc(method, 0, 1, 20);          /* behind the plane in focus */
        check_disc(method, 1, 0, 20);          /* before it */
        check_disc(method, 0.25f, 1, 40);      /* 30 pixels */
        check_disc(method, 0.625f, 0.25f, 64); /* 24 pixels */
    }
    /* The nearer surface wins where two pixels lie at exactly half a pixel, so K / r = 2 would
     * pull every second ray inwards. */
    check_disc(REFOCUS_METHOD_RAYTRACE, 0, 1, 20);
    check_disc(REFOCUS_METHOD_RAYTRACE, 0.3f, 0.85f, 27);
}

/* All the light of the point is there: shares add up to the whole aperture. */
TEST(energy)
{
    static double share[SIDE][SIDE];

    for (uint32_t method = 0; method < REFOCUS_METHOD_RAYTRACE; method++) {
        double sum = 0;

        render_point(&(struct view){method, NULL, 0.25f, 0.75f, 24}, 80, share);
        for (int i = 0; i < SIDE * SIDE; i++)
            sum += share[i / SIDE][i % SIDE];
        if (fabs(sum - 1) > 0.02)
            fail_msg("%s: light of the point adds up to %.4f", refocus_method_name(method), sum);
    }
}

static int lit_at(double share[SIDE][SIDE], double x, double y)
{
    return share[MIDDLE + (int)lround(y)][MIDDLE + (int)lround(x)] >= share[MIDDLE][MIDDLE] / 4;
}

/* A triangle, one corner up: drawn so behind the plane in focus, turned before it. */
TEST(polygon)
{
    static double share[SIDE][SIDE];
    const double r = 20, area = 3 * sqrt(3) / 4 * r * r;
    struct refocus_aperture *aperture;

    assert_int_equal(refocus_aperture_create_polygon(&aperture, 3, 90), 0);
    for (uint32_t method = 0; method <= REFOCUS_METHOD_BLUR; method++) {
        if (method == REFOCUS_METHOD_JITTERED)
            continue; /* grain */
        for (int front = 0; front < 2; front++) {
            const double up = front ? 1 : -1; /* y of the corner, y down */
            const struct view view = {method, aperture, front ? 1 : 0, front ? 0 : 1, (float)r};

            render_point(&view, 64, share);
            assert_true(lit_at(share, 0, 0));
            assert_true(lit_at(share, 0, 0.85 * r * up));
            assert_false(lit_at(share, 0, -0.6 * r * up));
            assert_true(lit_at(share, 0.6 * r, -0.42 * r * up));
            assert_true(lit_at(share, -0.6 * r, -0.42 * r * up));
            assert_false(lit_at(share, 0.5 * r, 0.4 * r * up));
            check_area(&view, share, area, 3 * sqrt(3)); /* moment r^2 / 4 */
        }
    }
    refocus_aperture_destroy(&aperture);
}

/* A mask with nothing symmetric about it. */
TEST(mask)
{
    static const uint8_t letter[5][5] = {{255, 0, 0, 0, 0},
                                         {255, 0, 0, 0, 0},
                                         {255, 255, 255, 0, 0},
                                         {255, 0, 0, 0, 0},
                                         {255, 255, 255, 255, 0}};
    static double share[SIDE][SIDE];
    const double cell = 2 * 25.0 / 5;
    struct refocus_aperture *aperture;

    assert_int_equal(refocus_aperture_create_mask(&aperture, letter[4], 5, 5, -5), 0);
    refocus_aperture_destroy(&aperture);
    assert_int_equal(refocus_aperture_create_mask(&aperture, letter[0], 5, 5, 5), 0);
    for (uint32_t method = 0; method < REFOCUS_METHOD_RAYTRACE; method++) {
        for (int front = 0; front < 2; front++) {
            const double turn = front ? -1 : 1;

            render_point(&(struct view){method, aperture, front ? 1 : 0, front ? 0 : 1, 25}, 64,
                         share);
            for (int y = 0; y < 5; y++) {
                for (int x = 0; x < 5; x++) {
                    const int lit = lit_at(share, turn * (x - 2) * cell, turn * (y - 2) * cell);
                    if (lit != (letter[y][x] == 255))
                        fail_msg("%s, %s the focus: (%d, %d) of the mask is %s",
                                 refocus_method_name(method), front ? "before" : "behind", x, y,
                                 lit ? "lit" : "dark");
                }
            }
        }
    }
    refocus_aperture_destroy(&aperture);
}

/* The rays of a set lie as the shape does: centre of gravity, second moments, coverage. */
TEST(ray_sets)
{
    static struct refocus_ray rays[REFOCUS_MAX_RAYS];
    static const int counts[] = {24, 32, 48, 64, 96, 128, 1024};
    struct refocus_aperture *aperture;

    assert_int_equal(refocus_aperture_create_disc(&aperture), 0);
    for (int i = 0; i < 7; i++) {
        const int n = counts[i];
        double u = 0, v = 0, uu = 0, vv = 0, uv = 0, inner = 0;

        assert_int_equal(refocus_aperture_rays(aperture, n, rays), 0);
        for (int k = 0; k < n; k++) {
            const double a = rays[k].u / 32768.0, b = rays[k].v / 32768.0;

            assert_int_equal(rays[k].weight, 255);
            assert_true(a * a + b * b <= 1.0001);
            u += a / n, v += b / n;
            uu += a * a / n, vv += b * b / n, uv += a * b / n;
            inner += (a * a + b * b < 0.5) / (double)n;
        }
        /* A full disc has 0, 0, 1/4, 1/4, 0, 1/2. */
        if (hypot(u, v) > 0.03 || fabs(uu - 0.25) > 0.02 || fabs(vv - 0.25) > 0.02 ||
            fabs(uv) > 0.02 || fabs(inner - 0.5) > 0.06)
            fail_msg("%d rays: mean %.3f %.3f, moments %.3f %.3f %.3f, inner half %.3f", n, u, v,
                     uu, vv, uv, inner);
    }
    refocus_aperture_destroy(&aperture);
}

/* Every number of rays: the same each time, inside the unit circle, no two alike, and in each
 * of eight wedges and of eight rings of equal area as many as its share, give or take a few. */
TEST(every_ray_set)
{
    static struct refocus_ray rays[REFOCUS_MAX_RAYS], again[REFOCUS_MAX_RAYS];

    for (int n = 1; n <= REFOCUS_MAX_RAYS; n++) {
        const double share = n / 8.0, most = 3;
        int wedge[8] = {0}, ring[8] = {0};

        if (left_out(n, 7))
            continue;
        memset(again, 0xff, sizeof again);
        assert_int_equal(refocus_aperture_rays(NULL, n, rays), REFOCUS_OK);
        assert_int_equal(refocus_aperture_rays(NULL, n, again), REFOCUS_OK);
        assert_memory_equal(rays, again, (size_t)n * sizeof rays[0]);
        for (int i = 0; i < n; i++) {
            const double u = rays[i].u / 32768.0, v = rays[i].v / 32768.0;
            const int square = (int)(8 * (u * u + v * v));

            assert_true(u * u + v * v <= 1.0001);
            wedge[(int)floor((atan2(v, u) / 6.283185307179586 + 0.5) * 8) & 7]++;
            ring[square < 8 ? square : 7]++;
            for (int k = 0; k < i; k++)
                assert_true(rays[k].u != rays[i].u || rays[k].v != rays[i].v);
        }
        for (int i = 0; i < 8; i++)
            if (fabs(wedge[i] - share) > most || fabs(ring[i] - share) > 1.5)
                fail_msg("%d rays: %d in wedge %d, %d in ring %d, should be %.1f", n, wedge[i], i,
                         ring[i], i, share);
    }
}

/* Sum of the weights of the full set: the area of the shape, antialiased. */
TEST(full_ray_area)
{
    static struct refocus_ray rays[REFOCUS_MAX_APERTURE_SIDE * REFOCUS_MAX_APERTURE_SIDE];
    const int room = sizeof rays / sizeof rays[0];

    for (int blades = 0; blades < 9; blades += blades ? 2 : 3) {
        const double pi = 3.14159265358979;
        const double unit = blades ? blades * sin(2 * pi / blades) / 2 : pi;
        struct refocus_aperture *aperture;

        if (blades)
            assert_int_equal(refocus_aperture_create_polygon(&aperture, blades, 10), 0);
        else
            assert_int_equal(refocus_aperture_create_disc(&aperture), 0);
        for (double k = 7; k <= 127; k *= left_out(1, 2) ? 4 : 1.7) {
            const int n = refocus_aperture_full_rays(aperture, k, room, rays);
            double sum = 0;
            int part = 0;

            assert_true(n > 0 && n <= room);
            assert_int_equal(refocus_aperture_full_rays(aperture, k, 0, NULL), n);
            for (int i = 0; i < n; i++) {
                assert_true(rays[i].weight >= 1 && rays[i].weight <= 255);
                part |= rays[i].weight < 255;
                assert_false(part && rays[i].weight == 255); /* whole ones first */
                sum += rays[i].weight / 255.0;
            }
            if (fabs(sum - unit * k * k) > 0.005 * unit * k * k)
                fail_msg("%d blades, K %g: area %.2f, should be %.2f", blades, k, sum,
                         unit * k * k);
        }
        refocus_aperture_destroy(&aperture);
    }
}
