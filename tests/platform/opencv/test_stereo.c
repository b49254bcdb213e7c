/* test_stereo.c: depth of stereo pairs by OpenCV, which the test makes itself. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "unit_test.h"
#include <refocus/platform/opencv.h>

enum { W = 320, H = 200, FAR = 8, NEAR = 26 };

static uint32_t state_of = 1;

static uint8_t noise(void)
{
    state_of = state_of * 1664525u + 1013904223u;
    return (uint8_t)(state_of >> 24);
}

/* Disparities of the square and of the wall. */
static int square = NEAR, wall = FAR;

static int disparity_at(int x, int y)
{
    return x >= 120 && x < 220 && y >= 60 && y < 150 ? square : wall;
}

/* A textured square before a textured wall; the right picture lies @p lower pixels lower. */
static void make_pair(uint8_t *left, uint8_t *right, int lower)
{
    state_of = 7;
    for (int i = 0; i < 3 * W * H; i++)
        left[i] = right[i] = noise();
    for (int pass = 0; pass < 2; pass++) /* the near square covers the wall */
        for (int y = 0; y < H; y++)
            for (int x = 0; x < W; x++) {
                const int d = disparity_at(x, y), to = y + lower;

                if ((d == square) == pass && x - d >= 0 && x - d < W && to >= 0 && to < H)
                    memcpy(right + 3 * (to * W + x - d), left + 3 * (y * W + x), 3);
            }
}

/* The square is bright, and the wall dark, also where one picture alone shows it. */
static void make_colours(uint8_t *left, uint8_t *right)
{
    make_pair(left, right, 0);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++)
            for (int c = 0; c < 3; c++) {
                const int i = 3 * (y * W + x) + c;

                left[i] = (uint8_t)(left[i] / 2 + (disparity_at(x, y) == NEAR ? 128 : 0));
                right[i] = (uint8_t)(right[i] / 2 + (disparity_at(x + NEAR, y) == NEAR ? 128 : 0));
            }
}

static struct refocus_image picture(uint8_t *pixels)
{
    return refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, W, H, 3 * W);
}

/* Seven tenths have a disparity, and of these so many percent the right one. */
static void check_disparities(const float *d, int percent)
{
    int known = 0, good = 0;

    for (int i = 0; i < W * H; i++) {
        known += !isnan(d[i]);
        good += fabsf(d[i] - (float)disparity_at(i % W, i / W)) <= 1;
    }
    assert_in_range(known, W * H * 7 / 10, W * H);
    assert_in_range(good, known * percent / 100, known);
}

TEST(stereo)
{
    static uint8_t left[3 * W * H], right[3 * W * H];
    static float d[W * H];
    const struct refocus_image a = picture(left), b = picture(right);
    const struct refocus_stereo_params params = refocus_stereo_params_default();
    struct refocus_stereo_report report = refocus_stereo_report_default();
    struct refocus_cv_reason reason;

    for (int lower = -3; lower <= 3; lower += 3) {
        make_pair(left, right, lower);
        assert_int_equal(refocus_cv_stereo(&a, &b, &params, d, &report, &reason), REFOCUS_OK);
        assert_true(fabsf(report.vertical_offset - (float)lower) < 0.5f);
        check_disparities(d, 97);
    }
}

/* Pictures are apart by a seventh of their width to either side, or what is near by a third. */
TEST(stereo_spans)
{
    static const int disparities[][2] = {{FAR - 48, NEAR - 48}, {FAR + 48, NEAR + 48}, {FAR, 105}};
    static uint8_t left[3 * W * H], right[3 * W * H];
    static float d[W * H];
    const struct refocus_image a = picture(left), b = picture(right);
    struct refocus_stereo_params params = refocus_stereo_params_default();

    params.order = REFOCUS_STEREO_LEFT_FIRST;
    for (int i = 0; i < 3; i++) {
        wall = disparities[i][0];
        square = disparities[i][1];
        make_pair(left, right, 0);
        assert_int_equal(refocus_cv_stereo(&a, &b, &params, d, NULL, NULL), REFOCUS_OK);
        check_disparities(d, 97);
    }
    wall = FAR;
    square = NEAR;
}

/* Copies a patch of the left picture, at (x, 20), to where it has another disparity. Returns how
 * many samples have about that, and the report of all. */
static int patched(int x, int width, int height, int disparity,
                   struct refocus_stereo_report *report)
{
    static uint8_t left[3 * W * H], right[3 * W * H];
    static float d[W * H];
    const struct refocus_image a = picture(left), b = picture(right);
    const struct refocus_stereo_params params = refocus_stereo_params_default();
    struct refocus_cv_reason reason;
    int count = 0;

    *report = refocus_stereo_report_default();
    make_pair(left, right, 0);
    for (int y = 20; y < 20 + height && disparity > NEAR; y++)
        for (int i = 0; i < 3 * width; i++)
            right[3 * (y * W + x - FAR) + i] = noise(); /* The left picture lacks this noise. */
    for (int y = 20; y < 20 + height; y++)
        memcpy(right + 3 * (y * W + x - disparity), left + 3 * (y * W + x), 3 * (size_t)width);
    assert_int_equal(refocus_cv_stereo(&a, &b, &params, d, report, &reason), REFOCUS_OK);
    for (int i = 0; i < W * H; i++)
        count += fabsf(d[i] - (float)disparity) < 5;
    return count;
}

/* A patch behind all else, a quarter of which matches, is chance if that is less than 1 of 500 of
 * all matches. */
TEST(stereo_far_chance)
{
    struct refocus_stereo_report report;

    assert_int_equal(patched(40, 24, 12, -10, &report), 0);
    assert_true(report.least > -1); /* the noise at the right border is the same in both */
    assert_in_range(patched(40, 26, 20, -10, &report), 130, 260);
    assert_true(report.least < -9);
}

/* So is one before all else which takes half of the range; a post is longer. */
TEST(stereo_near_chance)
{
    struct refocus_stereo_report report;

    assert_int_equal(patched(240, 17, 8, 56, &report), 0);
    assert_true(report.greatest < NEAR + 1);
    assert_int_equal(patched(240, 8, 14, 56, &report), 0);
    assert_in_range(patched(240, 11, 14, 56, &report), 111, 154); /* 1 of 500 */
    assert_in_range(patched(240, 5, 32, 56, &report), 80, 160);
    assert_true(report.greatest > 55);
    /* This patch would take less than half of the range. */
    assert_in_range(patched(240, 17, 8, 42, &report), 80, 136);
}

/* The disparity of the square in the first picture, nearly all of which has it, and of the wall. */
static void two_disparities(const float *d, int square_left, float *near, float *far)
{
    int more = 0, below = 0;

    *near = d[100 * W + square_left + 50];
    *far = d[20 * W + 200];
    for (int y = 65; y < 145; y++)
        for (int x = square_left + 5; x < square_left + 95; x++) {
            more += d[y * W + x] > *near + 1;
            below += d[y * W + x] < *near - 1;
        }
    assert_in_range(more + below, 0, 72); /* 1 of 100 */
}

TEST(stereo_order)
{
    static uint8_t left[3 * W * H], right[3 * W * H];
    static float d[W * H];
    const struct refocus_image a = picture(left), b = picture(right);
    struct refocus_stereo_params params = refocus_stereo_params_default();
    struct refocus_stereo_report report = refocus_stereo_report_default();
    struct refocus_cv_reason reason;
    float near, far;

    make_colours(left, right);
    for (params.order = 0; params.order <= REFOCUS_STEREO_ORDER_SEEN; params.order++) {
        const int turned = params.order == REFOCUS_STEREO_RIGHT_FIRST;

        assert_int_equal(refocus_cv_stereo(&a, &b, &params, d, &report, &reason), REFOCUS_OK);
        two_disparities(d, 120, &near, &far);
        assert_true(fabsf(near - (float)(turned ? -NEAR : NEAR)) <= 1);
        assert_true(fabsf(far - (float)(turned ? -FAR : FAR)) <= 1);
        assert_true(report.order > 0.5f);
    }
    for (params.order = 0; params.order <= REFOCUS_STEREO_ORDER_SEEN; params.order++) {
        const int turned = params.order == REFOCUS_STEREO_LEFT_FIRST;

        assert_int_equal(refocus_cv_stereo(&b, &a, &params, d, &report, &reason), REFOCUS_OK);
        two_disparities(d, 120 - NEAR, &near, &far);
        assert_true(fabsf(near - (float)(turned ? -NEAR : NEAR)) <= 1);
        assert_true(fabsf(far - (float)(turned ? -FAR : FAR)) <= 1);
        assert_true(report.order < -0.5f);
    }
    /* All of one colour: nothing tells. */
    params.order = REFOCUS_STEREO_ORDER_SEEN;
    make_pair(left, right, 0);
    for (int i = 0; i < 3 * W * H; i++) {
        left[i] = (uint8_t)(112 + left[i] / 8);
        right[i] = (uint8_t)(112 + right[i] / 8);
    }
    assert_int_equal(refocus_cv_stereo(&a, &b, &params, d, &report, &reason), REFOCUS_OK);
    assert_true(fabsf(report.order) < 0.15f);
    two_disparities(d, 120, &near, &far);
    assert_true(fabsf(near - NEAR) <= 1);
}

/* The light of a wall or a square at any place: sums of sines. */
static uint8_t sines_at(double x, double y, int near)
{
    double sum = near ? 150 : 100;

    for (int i = 1; i <= 6; i++)
        sum += 14 * sin((0.13 * i + 0.2 * near) * x + 0.4 * i * i) * sin(0.21 * i * y + 0.9 * i) +
               6 * sin(0.37 * i * x - 0.29 * i * y + near);
    return (uint8_t)(sum < 0 ? 0 : sum > 255 ? 255 : sum);
}

/* A pair of cameras of which the second one is lower, turned about its axis and of another focal
 * length. */
static void make_sines(uint8_t *left, uint8_t *right, const double apart[3])
{
    const double down = apart[0], turn = apart[1], grow = apart[2];

    for (int i = 0; i < W * H; i++) {
        const double u = i % W - (W - 1) / 2.0, v = i / W - (H - 1) / 2.0 - down;
        const double size = (1 + grow) * (1 + grow) + turn * turn;
        const double x = ((1 + grow) * u + turn * v) / size + (W - 1) / 2.0;
        const double y = ((1 + grow) * v - turn * u) / size + (H - 1) / 2.0;
        const int near = x + NEAR >= 120 && x + NEAR < 220 && y >= 60 && y < 150;

        memset(left + 3 * i, sines_at(i % W, i / W, disparity_at(i % W, i / W) == NEAR), 3);
        memset(right + 3 * i, sines_at(x + (near ? NEAR : FAR), y, near), 3);
    }
}

/* Cameras that are turned about their axes and of other focal lengths. */
TEST(stereo_unrectified)
{
    static const double apart[][3] = {{0, 0, 0}, {2, 0.012, 0}, {-1, 0, -0.01}, {1, -0.01, 0.008}};
    static uint8_t left[3 * W * H], right[3 * W * H];
    static float d[W * H];
    const struct refocus_image a = picture(left), b = picture(right);
    struct refocus_stereo_params params = refocus_stereo_params_default();
    struct refocus_stereo_report report = refocus_stereo_report_default();
    struct refocus_cv_reason reason;

    for (size_t n = 0; n < sizeof apart / sizeof *apart; n++) {
        const double down = apart[n][0], turn = apart[n][1], grow = apart[n][2];
        make_sines(left, right, apart[n]);
        assert_int_equal(refocus_cv_stereo(&a, &b, &params, d, &report, &reason), REFOCUS_OK);
        assert_true(fabs((double)report.vertical_offset - down) < 0.15);
        assert_true(fabs((double)report.turn - turn) < 0.001);
        assert_true(fabs((double)report.grow - grow) < 0.001);
        assert_true(n || (report.vertical_offset == 0 && report.turn == 0 && report.grow == 0));
        check_disparities(d, 96);
    }
    /* The first camera as the second one sees it. */
    params.order = REFOCUS_STEREO_RIGHT_FIRST;
    make_sines(left, right, apart[1]);
    assert_int_equal(refocus_cv_stereo(&b, &a, &params, d, &report, &reason), REFOCUS_OK);
    assert_true(fabs((double)report.vertical_offset + 2) < 0.15);
    assert_true(fabs((double)report.turn + 0.012) < 0.001);
}

/* The second picture has so much of the codes of the first one. */
TEST(stereo_exposures)
{
    static const double gain[] = {0.4, 0.7, 1.4}, apart[3] = {0, 0, 0};
    static uint8_t left[3 * W * H], right[3 * W * H];
    static float d[W * H];
    const struct refocus_image a = picture(left), b = picture(right);
    const struct refocus_stereo_params params = refocus_stereo_params_default();

    for (size_t n = 0; n < sizeof gain / sizeof *gain; n++) {
        make_sines(left, right, apart);
        for (int i = 0; i < 3 * W * H; i++)
            right[i] = (uint8_t)fmin(255, gain[n] * right[i]);
        assert_int_equal(refocus_cv_stereo(&a, &b, &params, d, NULL, NULL), REFOCUS_OK);
        check_disparities(d, 96);
    }
}

/* A pair that is taller than wide, four of them one below the other, is matched at half its size
 * where its height is twice the largest side: two rows have the same disparities. */
TEST(stereo_tall)
{
    enum { TALL = 4 * H };
    static uint8_t left[3 * W * TALL], right[3 * W * TALL], one[3 * W * H], other[3 * W * H];
    static float d[W * TALL];
    const struct refocus_image a = refocus_image_packed(REFOCUS_FORMAT_RGB8, left, W, TALL, 3 * W);
    const struct refocus_image b = refocus_image_packed(REFOCUS_FORMAT_RGB8, right, W, TALL, 3 * W);
    struct refocus_stereo_params params = refocus_stereo_params_default();

    make_pair(one, other, 0);
    for (int y = 0; y < TALL; y++) {
        memcpy(left + 3 * y * W, one + 3 * (y % H) * W, 3 * W);
        memcpy(right + 3 * y * W, other + 3 * (y % H) * W, 3 * W);
    }
    params.max_side = TALL / 2;
    assert_int_equal(refocus_cv_stereo(&a, &b, &params, d, NULL, NULL), REFOCUS_OK);
    for (int y = 0; y < TALL; y += 2)
        assert_memory_equal(d + y * W, d + (y + 1) * W, W * sizeof *d);
}

TEST(stereo_refuses)
{
    static uint8_t left[3 * W * H], right[3 * W * H];
    static float d[W * H];
    const struct refocus_image a = picture(left);
    struct refocus_image b = picture(right);
    const struct refocus_stereo_params params = refocus_stereo_params_default();
    struct refocus_cv_reason reason;

    for (int i = 0; i < 3 * W * H; i++) {
        left[i] = noise();
        right[i] = noise();
    }
    assert_int_equal(refocus_cv_stereo(&a, &b, &params, d, NULL, &reason), REFOCUS_ERR_NO_DEPTH);
    assert_non_null(strstr(reason.text, "match"));
    make_pair(left, right, W / 30);
    assert_int_equal(refocus_cv_stereo(&a, &b, &params, d, NULL, &reason), REFOCUS_ERR_NO_DEPTH);
    assert_non_null(strstr(reason.text, "rows may lie a fiftieth of the width apart, and "
                                        "disparities from -10 to 20 % of it;"));
    assert_int_equal(refocus_cv_stereo(&a, &a, &params, d, NULL, &reason), REFOCUS_ERR_NO_DEPTH);
    assert_non_null(strstr(reason.text, "one shift"));
    b.width--;
    assert_int_equal(refocus_cv_stereo(&a, &b, &params, d, NULL, &reason), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_cv_stereo(&a, NULL, &params, d, NULL, NULL), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_cv_stereo(&a, &a, NULL, d, NULL, NULL), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_cv_stereo(&a, &a, &params, NULL, NULL, NULL), REFOCUS_ERR_ARGUMENT);
}

/* Structs as an older program has them, of the first layout, and as a newer one does. */
static const uint32_t no_sizes[] = {0, 4, REFOCUS_MAX_STRUCT_SIZE + 1, UINT32_MAX};
enum { NO_SIZES = sizeof no_sizes / sizeof *no_sizes };

TEST(reports_of_any_size)
{
    static uint8_t left[3 * W * H], right[3 * W * H];
    static float d[W * H];
    struct newer {
        struct refocus_stereo_report known;
        uint32_t added, behind;
    } older, newer, untouched;
    const struct refocus_image a = picture(left), b = picture(right);
    const struct refocus_stereo_params params = refocus_stereo_params_default();

    memset(&older, 0xa5, sizeof older);
    newer = older;
    older.known.struct_size = REFOCUS_SIZE_TO(struct refocus_stereo_report, matched);
    newer.known.struct_size = offsetof(struct newer, behind);
    make_pair(left, right, 3);
    for (int i = 0; i < 2; i++) {
        struct newer got = i ? newer : older;

        assert_int_equal(refocus_cv_stereo(&a, &b, &params, d, &got.known, NULL), REFOCUS_OK);
        assert_int_equal(got.known.struct_size, (i ? newer : older).known.struct_size);
        assert_true(fabsf(got.known.vertical_offset - 3) < 0.5f && got.known.matched > 0.5f);
        assert_true(got.added == (i ? 0 : older.added) && got.behind == older.behind);
    }
    for (int i = 0; i < NO_SIZES; i++) {
        newer.known.struct_size = no_sizes[i];
        untouched = newer;
        assert_int_equal(refocus_cv_stereo(&a, &b, &params, d, &newer.known, NULL),
                         REFOCUS_ERR_ARGUMENT);
        assert_memory_equal(&newer, &untouched, sizeof newer);
    }
}
