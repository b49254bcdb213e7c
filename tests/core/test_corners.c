/* test_corners.c: the hidden background of a tile is looked for with the blur of each of its
 * corners where they differ, and its means lie between those of the corners. */
#include <stdint.h>
#include "unit_test.h"
#include <stdlib.h>

#include "gather/corners.h"

enum { SIDE = 3, LANES = RF_TILE * RF_TILE };

/* A frame of 3 x 3 tiles. */
struct scene {
    struct rf_viewport view;
    struct rf_settings params;
    struct rf_bins bins[SIDE * SIDE];
    struct rf_frame frame;
};

static void make_scene(struct scene *scene, const int pixels[SIDE * SIDE])
{
    *scene = (struct scene){.view = {.tiles_x = SIDE, .tiles_y = SIDE}};
    scene->params.max_blur_radius = 40;
    for (int i = 0; i < SIDE * SIDE; i++)
        scene->bins[i].background_blur = (int16_t)(256 * pixels[i]);
    scene->frame.view = &scene->view;
    scene->frame.params = &scene->params;
    scene->frame.bins = scene->bins;
}

TEST(blurs)
{
    static const int step[] = {20, 20, 12, 20, 20, 12, 20, 20, 12};
    static const int subject[] = {-5, -5, 20, -5, -5, 20, -5, -5, 20}; /* more than 10 apart */
    static const int corner[] = {8, 8, 8, 8, 8, 8, 8, 8, 17};
    static const int slope[] = {40, 40, 40, 40, 40, 40, 36, 36, 36}; /* less than an eighth */
    struct rf_corners corners;
    struct scene scene;

    make_scene(&scene, step);
    rf_find_corners(&corners, &scene.frame, 1, 1);
    assert_true(corners.across && !corners.down && corners.count == 2);
    assert_int_equal(corners.blur[0], 20 * 256);
    assert_int_equal(corners.blur[1], 16 * 256);
    make_scene(&scene, subject);
    rf_find_corners(&corners, &scene.frame, 1, 1);
    assert_int_equal(corners.blur[0], -5 * 256);
    assert_int_equal(corners.blur[1], 20 * 256);
    make_scene(&scene, corner);
    rf_find_corners(&corners, &scene.frame, 1, 1);
    assert_int_equal(corners.count, 4);
    assert_int_equal(corners.blur[0], 8 * 256);
    assert_int_equal(corners.blur[3], (3 * 8 + 17) * 64);
    rf_find_corners(&corners, &scene.frame, 2, 2); /* beyond the last tile it goes on */
    assert_int_equal(corners.blur[3], 17 * 256);
    make_scene(&scene, slope);
    rf_find_corners(&corners, &scene.frame, 1, 1);
    assert_int_equal(corners.count, 1);
    assert_int_equal(corners.blur[0], 39 * 256);
}

/* Means of a corner are those of the one before only if rays see the same, and in the same rows. */
TEST(repeats)
{
    static const int any[SIDE * SIDE];
    const struct rf_corners corners = {.count = 4, .blur = {8 * 256, -12 * 256, 3 * 256, -3 * 256}};
    const struct rf_tile_plan plan = {.least = 5 * 256};
    struct scene scene;

    make_scene(&scene, any);
    assert_false(rf_corner_repeats(&corners, 0, &scene.frame, &plan, false));
    assert_true(rf_corner_repeats(&corners, 1, &scene.frame, &plan, false));
    assert_false(rf_corner_repeats(&corners, 1, &scene.frame, &plan, true));
    assert_false(rf_corner_repeats(&corners, 2, &scene.frame, &plan, false));
    assert_true(rf_corner_repeats(&corners, 3, &scene.frame, &plan, false));
}

/* How much a corner counts at a sample of 16 / n, from its first side on or the other: 1/32. */
static int weight(bool differs, bool farther, int sample, int n)
{
    const int part = (2 * sample + 1) * n;

    return !differs ? 32 : farther ? part : 32 - part;
}

TEST(between)
{
    static const struct rf_corner_layout layouts[] = {{1, 1}, {2, 1}, {2, 2}};
    static uint16_t mean[4][LANES], out[LANES];
    static uint32_t sum[LANES];

    for (int k = 0; k < 4; k++)
        for (int i = 0; i < LANES; i++)
            mean[k][i] = (uint16_t)(i % 7 == 0 ? 65535 : rand() % 65536);
    for (int n = 0; n < 4 * 3; n++) {
        const struct rf_corner_layout layout = layouts[n / 4];
        struct rf_corners c = {.across = n % 2, .down = n / 2 % 2};

        c.count = (1 + c.across) * (1 + c.down);
        for (int k = 0; k < c.count; k++)
            rf_add_corner(sum, mean[k], &c, k, layout);
        rf_corner_means(out, sum, layout);
        for (int i = 0; i < LANES / layout.down; i++) {
            uint64_t expected = 512;

            for (int k = 0; k < c.count; k++)
                expected +=
                    (uint64_t)mean[k][i] *
                    (uint64_t)weight(c.across, k % 2, i % RF_TILE / layout.across, layout.across) *
                    (uint64_t)weight(c.down, k / (1 + c.across), i / RF_TILE, layout.down);
            assert_int_equal(out[i], expected / 1024);
        }
    }
}
