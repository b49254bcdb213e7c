/* test_focus.c: the focus that a tap, a rectangle, three points or a line mean. */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "unit_test.h"
#include <refocus/refocus.h>

enum { W = 60, H = 40 };

static uint16_t samples[W * H];
static const struct refocus_disparity map = {sizeof map, 16, W, H, samples, 2 * W};

static void halves(uint16_t left, uint16_t right)
{
    for (int i = 0; i < W * H; i++)
        samples[i] = i % W < W / 2 ? left : right;
}

static int tap(int x, int y, int radius)
{
    float focus = -1;

    assert_int_equal(refocus_focus_at_point(&map, x, y, radius, &focus), REFOCUS_OK);
    return (int)floor((double)focus * 65535 + 0.5);
}

TEST(taps)
{
    halves(12345, 54321);
    assert_int_equal(tap(5, 5, 0), 12345);
    assert_int_equal(tap(55, 5, 0), 54321);
    assert_int_equal(tap(0, 0, 9), 12345);
    assert_int_equal(tap(W - 1, H - 1, 256), 54321);
    /* the nearer one at an edge, as long as it has a quarter */
    assert_int_equal(tap(29, 20, 4), 54321);
    assert_int_equal(tap(28, 20, 4), 54321);
    assert_int_equal(tap(26, 20, 4), 12345);
    /* wrong samples, up to a fifth of them, do not matter */
    for (int i = 0; i < W * H; i += 5)
        samples[i] = 65535;
    assert_int_equal(tap(10, 20, 4), 12345);
    /* a slope is one surface: what is tapped is its middle */
    for (int i = 0; i < W * H; i++)
        samples[i] = (uint16_t)(20000 + i % W * 300);
    assert_in_range(tap(30, 20, 5), 29000 - 150, 29000 + 150);
    memset(samples, 0, sizeof samples);
    assert_int_equal(tap(3, 3, 1), 0);
    memset(samples, 0xff, sizeof samples);
    assert_int_equal(tap(3, 3, 1), 65535);
}

TEST(eight_bits)
{
    static uint8_t bytes[W * H];
    const struct refocus_disparity small = refocus_disparity8(bytes + (H - 1) * W, W, H, -W);
    float focus;

    for (int i = 0; i < W * H; i++)
        bytes[i] = i / W < 10 ? 77 : 200; /* bottom-up */
    assert_int_equal(refocus_focus_at_point(&small, 30, H - 5, 2, &focus), REFOCUS_OK);
    assert_true(fabs(focus - 77 / 255.0) < 1e-6);
}

TEST(rectangles)
{
    float focus;

    halves(10000, 40000);
    assert_int_equal(refocus_focus_in_rectangle(&map, 0, 0, W, H, &focus), REFOCUS_OK);
    assert_true(fabs(focus - 40000 / 65535.0) < 1e-6);
    assert_int_equal(refocus_focus_in_rectangle(&map, 0, 0, W * 5 / 8, H, &focus), REFOCUS_OK);
    assert_true(fabs(focus - 10000 / 65535.0) < 1e-6);
    assert_int_equal(refocus_focus_in_rectangle(&map, W - 1, H - 1, 1, 1, &focus), REFOCUS_OK);
    assert_true(fabs(focus - 40000 / 65535.0) < 1e-6);
}

TEST(bad_picks)
{
    const struct refocus_disparity bad[] = {{0},
                                            {sizeof map, 16, W, H, NULL, 2 * W},
                                            {sizeof map, 12, W, H, samples, 2 * W},
                                            {sizeof map, 16, 0, H, samples, 2 * W},
                                            {sizeof map, 16, W, H, samples, 2 * W - 2}};
    static const int outside[][4] = {{-1, 0, 1, 1}, {0, -1, 1, 1}, {W, 0, 1, 1}, {0, H, 1, 1}};
    float focus = 0.25f;

    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_int_equal(refocus_focus_at_point(&bad[i], 1, 1, 1, &focus), REFOCUS_ERR_ARGUMENT);
        assert_int_equal(refocus_focus_in_rectangle(&bad[i], 1, 1, 1, 1, &focus),
                         REFOCUS_ERR_ARGUMENT);
    }
    for (size_t i = 0; i < 4; i++) {
        const int *o = outside[i];

        assert_int_equal(refocus_focus_at_point(&map, o[0], o[1], 1, &focus), REFOCUS_ERR_ARGUMENT);
        assert_int_equal(refocus_focus_in_rectangle(&map, o[0], o[1], o[2], o[3], &focus),
                         REFOCUS_ERR_ARGUMENT);
    }
    assert_int_equal(refocus_focus_at_point(NULL, 1, 1, 1, &focus), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_focus_at_point(&map, 1, 1, 1, NULL), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_focus_at_point(&map, 1, 1, -1, &focus), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_focus_at_point(&map, 1, 1, 257, &focus), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_focus_in_rectangle(&map, 0, 0, 0, 1, &focus), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_focus_in_rectangle(&map, 0, 0, 1, H + 1, &focus),
                     REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_focus_in_rectangle(&map, 1, 1, INT32_MAX, 1, &focus),
                     REFOCUS_ERR_ARGUMENT);
    assert_true(focus == 0.25f);
}

/* Disparity in focus of a plane at a place. */
static double at(const struct refocus_focus_plane *p, double x, double y)
{
    return p->focus_disparity + p->across * (x - p->x) + p->down * (y - p->y);
}

TEST(planes)
{
    const struct refocus_focus_point p[3] = {
        {0.1f, 0.9f, 0.8f}, {0.8f, 0.7f, 0.6f}, {0.4f, 0.2f, 0.1f}};
    struct refocus_focus_plane plane;

    assert_int_equal(refocus_focus_plane_of_points(&plane, p), REFOCUS_OK);
    for (int i = 0; i < 3; i++)
        assert_true(fabs(at(&plane, p[i].x, p[i].y) - p[i].disparity) < 1e-6);

    /* a level line from left to right: its right is below, 45 degrees are 1 a width */
    assert_int_equal(
        refocus_focus_plane_of_line(&plane, &(struct refocus_focus_point){0, 0.5f, 0.3f},
                                    &(struct refocus_focus_point){1, 0.5f, 0}, 0.75, 45),
        REFOCUS_OK);
    assert_true(fabs(at(&plane, 0.7, 0.5) - 0.3) < 1e-6);
    assert_true(fabs(at(&plane, 0.7, 1) - 0.3 - 0.375) < 1e-6);
    /* downwards: its right is on the left of the photo */
    assert_int_equal(
        refocus_focus_plane_of_line(&plane, &(struct refocus_focus_point){0.5f, 0, 0.3f},
                                    &(struct refocus_focus_point){0.5f, 1, 0}, 0.75, -45),
        REFOCUS_OK);
    assert_true(fabs(at(&plane, 0.25, 0.9) - 0.3 + 0.25) < 1e-6);
    /* a slanted one holds its disparity */
    assert_int_equal(refocus_focus_plane_of_line(&plane, &p[0], &p[1], 0.5, 60), REFOCUS_OK);
    assert_true(fabs(at(&plane, p[1].x, p[1].y) - p[0].disparity) < 1e-6);
}

TEST(bad_planes)
{
    const struct refocus_focus_point a = {0.2f, 0.2f, 0.5f}, b = {0.4f, 0.4f, 0.1f},
                                     c = {0.8f, 0.8f, 0.2f}, out = {1.2f, 0, 0};
    struct refocus_focus_plane plane;

    assert_int_equal(
        refocus_focus_plane_of_points(&plane, (struct refocus_focus_point[3]){a, b, c}),
        REFOCUS_ERR_ARGUMENT);
    assert_int_equal(
        refocus_focus_plane_of_points(&plane, (struct refocus_focus_point[3]){a, b, out}),
        REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_focus_plane_of_points(
                         &plane, (struct refocus_focus_point[3]){{0, 0, 0}, {0.001f, 0, 1}, c}),
                     REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_focus_plane_of_points(NULL, (struct refocus_focus_point[3]){a, b, c}),
                     REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_focus_plane_of_points(&plane, NULL), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_focus_plane_of_line(&plane, &a, &a, 1, 0), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_focus_plane_of_line(&plane, &a, &b, 0, 0), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_focus_plane_of_line(&plane, &a, &b, NAN, 0), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_focus_plane_of_line(&plane, &a, &b, 1, 90), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_focus_plane_of_line(&plane, &a, &b, 1, NAN), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_focus_plane_of_line(&plane, &a, &b, 1, 89.9), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_focus_plane_of_line(&plane, &a, NULL, 1, 0), REFOCUS_ERR_ARGUMENT);
}
