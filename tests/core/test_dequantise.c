/* test_dequantise.c: which maps are taken for maps of few codes, and what becomes of them. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "unit_test.h"

#include "depth/dequantise.h"
#include "support/pool.h"

enum { WIDTH = 203, HEIGHT = 151, PIXELS = WIDTH * HEIGHT };

/* A slanted plane with a ball before it: 8000 to 52000. */
static double surface(int x, int y)
{
    const double dx = x - 120, dy = y - 70, in = 45 * 45 - dx * dx - dy * dy;
    const double plane = 8000 + 61.3 * x + 37.7 * y;

    return in > 0 ? 42000 + 220 * sqrt(in) : plane;
}

static void draw(uint16_t *map, int step)
{
    for (int i = 0; i < PIXELS; i++)
        map[i] = (uint16_t)(floor(surface(i % WIDTH, i / WIDTH) / step + 0.5) * step);
}

static struct refocus_disparity map_of(const uint16_t *map)
{
    return refocus_disparity16(map, WIDTH, HEIGHT, 2 * WIDTH);
}

TEST(steps_of_maps)
{
    static uint16_t map[PIXELS];
    static uint8_t bytes[PIXELS];
    struct refocus_disparity d = map_of(map);

    draw(map, 1);
    assert_int_equal(rf_code_step(&d), 0);
    draw(map, 257);
    assert_int_equal(rf_code_step(&d), 257);
    for (int y = 0; y < HEIGHT; y++) /* samples behind its rows are not of the map */
        map[y * WIDTH + WIDTH - 1] = (uint16_t)(53000 + 500 * (y % 25));
    d.width = WIDTH - 1;
    assert_int_equal(rf_code_step(&d), 257);
    d.width = WIDTH;
    draw(map, 700);
    assert_int_equal(rf_code_step(&d), 700);
    draw(map, 1500); /* coarser than 6 bits */
    assert_int_equal(rf_code_step(&d), 0);
    for (int i = 0; i < PIXELS; i++)
        bytes[i] = (uint8_t)(map[i] / 1500 * 3);
    d.bits = 8;
    d.samples = bytes;
    d.stride = WIDTH;
    assert_int_equal(rf_code_step(&d), 0); /* 30 codes, drawn by hand perhaps */
    for (int i = 0; i < PIXELS; i++)
        bytes[i] = (uint8_t)(surface(i % WIDTH, i / WIDTH) / 257);
    assert_int_equal(rf_code_step(&d), 257);
    d.width = d.height = 60; /* a few thousand pixels: not so many of each code */
    assert_int_equal(rf_code_step(&d), 0);
}

/* 40 boards one behind the other, 1600 apart: each edge is real. */
TEST(boards_stay)
{
    static uint16_t map[PIXELS];
    const struct refocus_disparity d = map_of(map);

    for (int i = 0; i < PIXELS; i++)
        map[i] = (uint16_t)(i % WIDTH / 5 * 1600);
    assert_int_equal(rf_code_step(&d), 0);
}

static double greatest_error(const uint16_t *map)
{
    double most = 0;

    for (int i = 0; i < PIXELS; i++)
        most = fmax(most, fabs(map[i] - surface(i % WIDTH, i / WIDTH)));
    return most;
}

/* Steps that two neighbours inside one surface make, in the mean and the greatest. */
static void steps_between(const uint16_t *map, double *mean, int *most)
{
    double sum = 0;
    int count = 0;

    *most = 0;
    for (int i = 0; i < PIXELS - WIDTH; i++) {
        const int real =
            abs((int)surface(i % WIDTH, i / WIDTH) - (int)surface(i % WIDTH, i / WIDTH + 1));
        const int step = abs(map[i] - map[i + WIDTH]);

        if (real > 60)
            continue;
        *most = step > *most ? step : *most;
        sum += step * step;
        count++;
    }
    *mean = sqrt(sum / count);
}

static void run(uint16_t *map, int step, uint32_t cpu, int threads)
{
    static uint16_t spare[2][PIXELS];
    struct rf_kernels kernels;
    struct rf_pool pool;
    struct rf_run state = {.looked_at = NULL};
    struct rf_dequantiser d = {.kernels = &kernels,
                               .code = {map, WIDTH},
                               .spare = {{spare[0], WIDTH}, {spare[1], WIDTH}},
                               .width = WIDTH,
                               .height = HEIGHT,
                               .step = step};

    assert_true(rf_kernels_select(&kernels, &cpu));
    atomic_init(&state.state, RF_RUN_RUNNING);
    assert_int_equal(rf_pool_start(&pool, threads, NULL, &state), REFOCUS_OK);
    rf_dequantise(&d, &pool);
    rf_pool_end(&pool);
}

TEST(slopes_come_back)
{
    static uint16_t map[PIXELS], coarse[PIXELS], other[PIXELS];
    double before, after;
    int most_before, most_after, edges = 0;

    draw(coarse, 257);
    memcpy(map, coarse, sizeof map);
    run(map, 257, REFOCUS_CPU_C, 1);
    steps_between(coarse, &before, &most_before);
    steps_between(map, &after, &most_after);
    assert_int_equal(most_before, 257);
    assert_in_range(most_after, 1, 230); /* less than a step everywhere */
    assert_true(after < 0.55 * before);
    assert_true(greatest_error(map) <= 257);
    for (int i = 0; i < PIXELS; i++)
        assert_in_range(abs(map[i] - coarse[i]), 0, 128);
    for (int i = 1; i < PIXELS;
         i++) /* edges of the ball are as high as they were, within two halves */
        if (i % WIDTH && abs(coarse[i] - coarse[i - 1]) > 3000) {
            assert_in_range(abs(map[i] - map[i - 1]), abs(coarse[i] - coarse[i - 1]) - 256,
                            abs(coarse[i] - coarse[i - 1]) + 256);
            edges++;
        }
    assert_true(edges > 50);
    memcpy(other, coarse, sizeof other);
    run(other, 257, REFOCUS_CPU_AUTO, 3);
    assert_memory_equal(other, map, sizeof map);
}

/* Codes at both ends of the range, and pictures smaller than the reach. */
TEST(ends_and_small_maps)
{
    for (int width = 1; width <= 20; width++)
        for (int height = 1; height <= 20; height++) {
            uint16_t map[400], spare[2][400];
            struct rf_kernels kernels;
            struct rf_pool pool;
            struct rf_run run_state = {.looked_at = NULL};
            uint32_t cpu = REFOCUS_CPU_AUTO;
            struct rf_dequantiser d = {.kernels = &kernels,
                                       .code = {map, width},
                                       .spare = {{spare[0], width}, {spare[1], width}},
                                       .width = width,
                                       .height = height,
                                       .step = 257};

            for (int i = 0; i < width * height; i++)
                map[i] = i / 2 % 2 ? 65535 : 65535 - 257;
            map[0] = 0;
            assert_true(rf_kernels_select(&kernels, &cpu));
            atomic_init(&run_state.state, RF_RUN_RUNNING);
            assert_int_equal(rf_pool_start(&pool, 1, NULL, &run_state), REFOCUS_OK);
            rf_dequantise(&d, &pool);
            rf_pool_end(&pool);
            assert_int_equal(map[0], 0);
            for (int i = 1; i < width * height; i++)
                assert_in_range(map[i], 65535 - 257 - 128, 65535);
        }
}

/* A few pixels by themselves are as in the whole map: at its corners, sides and within, and without
 * a step as they came. */
TEST(patches)
{
    enum { SIDE = RF_DEQUANTISE_PATCH };
    static const int at[][4] = {
        {0, 0, SIDE, SIDE}, {8, 24, SIDE, SIDE},           {96, 64, SIDE, SIDE},
        {101, 3, 5, 1},     {WIDTH - 3, HEIGHT - 7, 3, 7}, {WIDTH - SIDE, 0, SIDE, SIDE}};
    static uint16_t map[PIXELS], whole[PIXELS];
    const struct refocus_disparity d = map_of(map);
    struct rf_kernels kernels;
    uint32_t cpu = REFOCUS_CPU_AUTO;
    uint16_t patch[SIDE * SIDE];

    assert_true(rf_kernels_select(&kernels, &cpu));
    draw(map, 257);
    memcpy(whole, map, sizeof whole);
    run(whole, 257, cpu, 1);
    for (size_t i = 0; i < sizeof at / sizeof *at; i++)
        for (int step = 0; step <= 257; step += 257) {
            const uint16_t *from = (step ? whole : map) + at[i][1] * WIDTH + at[i][0];

            rf_dequantised_patch(&kernels, &d, step, at[i][0], at[i][1], at[i][2], at[i][3], patch);
            for (int y = 0; y < at[i][3]; y++)
                assert_memory_equal(patch + y * at[i][2], from + y * WIDTH,
                                    (size_t)at[i][2] * sizeof *patch);
        }
}
