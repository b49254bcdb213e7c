/* test_noise.c: how much noise, of either kind, a map of disparities is found to have, and what is
 * left of it. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "unit_test.h"

#include "depth/impulses.h"
#include "depth/noise.h"

enum { WIDTH = 203, HEIGHT = 151, PIXELS = WIDTH * HEIGHT };

static uint16_t exact[PIXELS], map[PIXELS], spare[2][PIXELS];
static uint32_t random_state = 1;

static double evenly(void)
{
    random_state = random_state * 1664525 + 1013904223;
    return (random_state >> 8) / 16777216.0;
}

/* A number of mean 0 and standard deviation 1, near enough. */
static double normally(void)
{
    double sum = -6;

    for (int i = 0; i < 12; i++)
        sum += evenly();
    return sum;
}

/* A slanted plane with a ball before it. */
static double surface(int x, int y)
{
    const double dx = x - 120, dy = y - 70, in = 45 * 45 - dx * dx - dy * dy;

    return in > 0 ? 42000 + 220 * sqrt(in) : 12000 + 61.3 * x + 37.7 * y;
}

static void draw(double noise)
{
    for (int i = 0; i < PIXELS; i++) {
        exact[i] = (uint16_t)surface(i % WIDTH, i / WIDTH);
        map[i] = (uint16_t)fmin(fmax(exact[i] + noise * normally(), 0), 65535);
    }
}

static struct rf_disparity_q16 plane(uint16_t *at)
{
    return (struct rf_disparity_q16){at, WIDTH};
}

static int noise_found(void)
{
    return rf_noise_of(plane(map), WIDTH, HEIGHT, 0);
}

TEST(is_measured)
{
    static const double noises[] = {400, 655, 1311, 3277};

    for (size_t i = 0; i < sizeof noises / sizeof *noises; i++) {
        draw(noises[i]);
        assert_in_range(noise_found(), 0.8 * noises[i], 1.2 * noises[i]);
    }
}

/* Exact maps, those of 8 bits, little noise, and depths that change at every few pixels. */
TEST(is_none)
{
    draw(0);
    assert_int_equal(noise_found(), 0);
    for (int i = 0; i < PIXELS; i++)
        map[i] = (uint16_t)(exact[i] / 257 * 257);
    assert_int_equal(noise_found(), 0);
    draw(120);
    assert_int_equal(noise_found(), 0);
    for (int i = 0; i < PIXELS; i++) { /* leaves of 4 x 3 pixels */
        const uint32_t leaf = (uint32_t)(i % WIDTH / 4 + i / WIDTH / 3 * 64) * 2654435761u;

        map[i] = (uint16_t)(leaf >> 16);
    }
    assert_int_equal(noise_found(), 0);
    assert_int_equal(rf_noise_of(plane(map), 1, 1, 0), 0);
    assert_int_equal(rf_noise_of(plane(map), 2, HEIGHT, 0), 0);
}

/* Where a plane rises by 0.4 codes of 8 bits to the right and down, four of five pixels lie off
 * their line, by a code; with noise, by more. */
TEST(is_more_than_codes)
{
    static const double noises[] = {655, 1311, 3277};

    for (int i = 0; i < PIXELS; i++)
        map[i] = (uint16_t)(lrint(10 + 0.4 * (i % WIDTH) + 0.4 * (i / WIDTH)) * 257);
    assert_true(noise_found() > 600);
    assert_int_equal(rf_noise_of(plane(map), WIDTH, HEIGHT, 257), 0);
    for (size_t k = 0; k < sizeof noises / sizeof *noises; k++) {
        draw(noises[k]);
        for (int i = 0; i < PIXELS; i++)
            map[i] = (uint16_t)(map[i] / 257 * 257);
        assert_in_range(rf_noise_of(plane(map), WIDTH, HEIGHT, 257), 0.7 * noises[k],
                        1.4 * noises[k]);
    }
}

/* Between surfaces nothing is averaged, and no pixel goes farther than two deviations. */
TEST(is_smoothed_within_surfaces)
{
    static const double noises[] = {655, 1311, 3277};
    static uint16_t noisy[PIXELS];
    const struct rf_disparity_q16 spares[2] = {plane(spare[0]), plane(spare[1])};
    struct rf_pool pool;
    struct rf_run run = {.looked_at = NULL};
    struct rf_kernels kernels;
    uint32_t cpu = 0;

    assert_true(rf_kernels_select(&kernels, &cpu));
    atomic_init(&run.state, RF_RUN_RUNNING);
    assert_int_equal(rf_pool_start(&pool, 2, NULL, &run), 0);
    for (size_t i = 0; i < sizeof noises / sizeof *noises; i++) {
        double before = 0, after = 0;
        int far_off = 0;

        draw(noises[i]);
        memcpy(noisy, map, sizeof noisy);
        rf_denoise(&kernels, plane(map), spares, WIDTH, HEIGHT, (int)noises[i], &pool);
        for (int k = 0; k < PIXELS; k++) {
            before += pow(noisy[k] - exact[k], 2);
            after += pow(map[k] - exact[k], 2);
            far_off += abs(map[k] - exact[k]) > 14000;
            assert_true(abs(map[k] - noisy[k]) <= 2 * noises[i] + 8);
        }
        assert_true(after < before / 9);
        assert_int_equal(far_off, 0);
    }
    rf_pool_end(&pool);
}

static int impulses_found(void)
{
    return rf_impulses_of(plane(map), WIDTH, HEIGHT);
}

/* One in `every` samples becomes any disparity. */
static void add_impulses(int every)
{
    draw(0);
    for (int i = 0; i < PIXELS; i++)
        if ((int)(evenly() * every) == 0)
            map[i] = (uint16_t)(evenly() * 65536);
}

/* Exact maps, few impulses, surfaces with noise, wires of a pixel. */
TEST(no_impulses)
{
    draw(0);
    assert_int_equal(impulses_found(), 0);
    draw(1311);
    assert_int_equal(impulses_found(), 0);
    add_impulses(500);
    assert_int_equal(impulses_found(), 0);
    draw(0);
    for (int i = 0; i < PIXELS; i++)
        if (i % WIDTH % 9 == 0 || i / WIDTH % 7 == 0)
            map[i] = 65000;
    assert_int_equal(impulses_found(), 0);
    assert_int_equal(rf_impulses_of(plane(map), 1, 1), 0);
    assert_int_equal(rf_impulses_of(plane(map), 2, HEIGHT), 0);
}

/* Impulses are 4 % of the samples, and 3 % so far off all around them that they are told. After, a
 * thousandth of all samples is off, and a thousandth that was right has moved: at the silhouette of
 * the ball. */
TEST(impulses_go)
{
    static uint16_t hit[PIXELS];
    struct rf_pool pool;
    struct rf_run run = {.looked_at = NULL};
    int left = 0, moved = 0;

    add_impulses(25);
    memcpy(hit, map, sizeof hit);
    assert_in_range(impulses_found(), 0.02 * 65536, 0.04 * 65536);
    atomic_init(&run.state, RF_RUN_RUNNING);
    assert_int_equal(rf_pool_start(&pool, 2, NULL, &run), 0);
    rf_remove_impulses(plane(map), plane(spare[0]), WIDTH, HEIGHT, &pool);
    rf_pool_end(&pool);
    for (int i = 0; i < PIXELS; i++) {
        left += abs(map[i] - exact[i]) > 1966;
        moved += hit[i] == exact[i] && map[i] != exact[i];
    }
    assert_in_range(left, 0, PIXELS / 1000);
    assert_in_range(moved, 0, PIXELS / 1000);
    assert_int_equal(impulses_found(), 0);
}
