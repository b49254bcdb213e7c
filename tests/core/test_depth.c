/* test_depth.c: refocus_depth_to_disparity(): samples, meanings, ranges, strides, holes. */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "unit_test.h"
#include <refocus/depth.h>

#include "depth/holes.h"

static struct refocus_depth_map map_of(uint32_t sample, const void *samples, int width, int height)
{
    static const int bytes[] = {0, 1, 2, 4};
    struct refocus_depth_map map;

    map = refocus_depth_map_default();
    map.samples = samples;
    map.width = width;
    map.height = height;
    map.sample = sample;
    map.stride = (ptrdiff_t)width * bytes[sample];
    map.meaning = REFOCUS_DEPTH_DISPARITY;
    map.metres_per_unit = 1;
    return map;
}

static struct refocus_depth_map distances_of(uint32_t sample, const void *samples, int width,
                                             int height)
{
    struct refocus_depth_map map = map_of(sample, samples, width, height);

    map.meaning = REFOCUS_DEPTH_DISTANCE;
    map.flags = REFOCUS_DEPTH_ZERO_IS_UNKNOWN;
    return map;
}

/* Values of any type that stand for none are filled, and are no end of the range. */
TEST(test_unknown_values)
{
    static const uint8_t u8[] = {10, 7, 20, 7, 30, 9};
    static const uint16_t u16[] = {10, 65520, 20, 65520, 30, 9};
    static const float f32[] = {10, -16, 20, -16, 30, 9};
    const struct {
        uint32_t sample;
        const void *samples;
        double code;
    } maps[] = {{REFOCUS_SAMPLE_U8, u8, 7},
                {REFOCUS_SAMPLE_U16, u16, 65520},
                {REFOCUS_SAMPLE_F32, f32, -16}};

    for (int i = 0; i < 3; i++) {
        struct refocus_depth_map map = map_of(maps[i].sample, maps[i].samples, 6, 1);
        struct refocus_depth_report report = refocus_depth_report_default();
        uint16_t out[6];

        map.unknown[0] = 9;
        map.unknown[1] = maps[i].code;
        map.unknown[2] = 10; /* beyond the count */
        map.unknown_count = 2;
        assert_int_equal(refocus_depth_to_disparity(&map, out, 12, &report), REFOCUS_OK);
        assert_int_equal(report.unknown, 3);
        assert_true(report.value_far == 10 && report.value_near == 30);
        assert_true(out[0] == 0 && out[2] == 32768 && out[4] == 65535);
        map.unknown_count = REFOCUS_DEPTH_MOST_UNKNOWN + 1;
        assert_int_equal(refocus_depth_to_disparity(&map, out, 12, &report), REFOCUS_ERR_ARGUMENT);
        map.unknown_count = -1;
        assert_int_equal(refocus_depth_to_disparity(&map, out, 12, &report), REFOCUS_ERR_ARGUMENT);
    }
}

TEST(test_disparity_samples)
{
    static const uint8_t u8[] = {0, 1, 51, 128, 254, 255};
    static const uint16_t u16[] = {0, 1, 13107, 32768, 65534, 65535};
    static const float f32[] = {-1, -0.5f, 0, 0.5f, 1, 3};
    uint16_t out[6];
    struct refocus_depth_report report = refocus_depth_report_default();

    struct refocus_depth_map map = map_of(REFOCUS_SAMPLE_U8, u8, 6, 1);
    map.value_near = 255;
    assert_int_equal(refocus_depth_to_disparity(&map, out, 12, &report), REFOCUS_OK);
    for (int i = 0; i < 6; i++)
        assert_int_equal(out[i], u8[i] * 257);
    assert_int_equal(report.unknown, 0);
    assert_int_equal(report.clamped, 0);
    assert_true(report.near_m == 0 && report.far_m == 0);

    map = map_of(REFOCUS_SAMPLE_U16, u16, 6, 1);
    map.value_near = 65535;
    assert_int_equal(refocus_depth_to_disparity(&map, out, 12, NULL), REFOCUS_OK);
    assert_memory_equal(out, u16, sizeof u16);

    /* Dark = near. */
    map.value_near = 0;
    map.value_far = 65535;
    assert_int_equal(refocus_depth_to_disparity(&map, out, 12, &report), REFOCUS_OK);
    for (int i = 0; i < 6; i++)
        assert_int_equal(out[i], 65535 - u16[i]);
    assert_int_equal(report.clamped, 0);

    /* Measured: -1 is 0 and 3 is 65535. */
    map = map_of(REFOCUS_SAMPLE_F32, f32, 6, 1);
    assert_int_equal(refocus_depth_to_disparity(&map, out, 12, &report), REFOCUS_OK);
    static const uint16_t quarters[] = {0, 8192, 16384, 24576, 32768, 65535};
    for (int i = 0; i < 6; i++)
        assert_int_equal(out[i], quarters[i]);
    assert_true(report.value_near == 3 && report.value_far == -1);

    /* Given: the rest is clamped and counted; the range in metres is passed on. */
    map.value_far = 0;
    map.value_near = 1;
    map.near_m = 0.5;
    map.far_m = INFINITY;
    assert_int_equal(refocus_depth_to_disparity(&map, out, 12, &report), REFOCUS_OK);
    static const uint16_t clamped[] = {0, 0, 0, 32768, 65535, 65535};
    for (int i = 0; i < 6; i++)
        assert_int_equal(out[i], clamped[i]);
    assert_int_equal(report.clamped, 3);
    assert_true(report.near_m == 0.5 && isinf(report.far_m));
}

TEST(test_distances)
{
    static const uint16_t mm[] = {500, 1000, 2000, 4000};
    static const float metres[] = {0.5f, 1, 2, 4};
    static const uint8_t quarters[] = {1, 3, 7, 15}; /* 0.25 + v / 4 */
    /* d = (1/z - 1/4) / (2 - 1/4) = 4/7 (1/z - 1/4) */
    static const uint16_t expected[] = {65535, 28086, 9362, 0};
    uint16_t out[4];
    struct refocus_depth_report report = refocus_depth_report_default();

    struct refocus_depth_map map = distances_of(REFOCUS_SAMPLE_U16, mm, 4, 1);
    map.metres_per_unit = 0.001;
    assert_int_equal(refocus_depth_to_disparity(&map, out, 8, &report), REFOCUS_OK);
    assert_memory_equal(out, expected, sizeof out);
    assert_true(fabs(report.near_m - 0.5) < 1e-12 && fabs(report.far_m - 4) < 1e-12);

    map = distances_of(REFOCUS_SAMPLE_F32, metres, 4, 1);
    assert_int_equal(refocus_depth_to_disparity(&map, out, 8, &report), REFOCUS_OK);
    assert_memory_equal(out, expected, sizeof out);

    map = distances_of(REFOCUS_SAMPLE_U8, quarters, 4, 1);
    map.metres_at_zero = 0.25;
    map.metres_per_unit = 0.25;
    assert_int_equal(refocus_depth_to_disparity(&map, out, 8, &report), REFOCUS_OK);
    assert_memory_equal(out, expected, sizeof out);

    /* Range beyond the data on both sides: nothing is clamped. */
    map = distances_of(REFOCUS_SAMPLE_F32, metres, 4, 1);
    map.near_m = 0.25;
    map.far_m = INFINITY;
    assert_int_equal(refocus_depth_to_disparity(&map, out, 8, &report), REFOCUS_OK);
    assert_int_equal(report.clamped, 0);
    assert_true(report.near_m == 0.25 && isinf(report.far_m));
    static const uint16_t wide[] = {32768, 16384, 8192, 4096};
    assert_memory_equal(out, wide, sizeof out);

    /* Range within the data. */
    map.near_m = 1;
    map.far_m = 2;
    assert_int_equal(refocus_depth_to_disparity(&map, out, 8, &report), REFOCUS_OK);
    static const uint16_t narrow[] = {65535, 65535, 0, 0};
    assert_memory_equal(out, narrow, sizeof out);
    assert_int_equal(report.clamped, 2);

    /* One end given, beyond all the data: every sample lies on it. */
    map.near_m = 8;
    map.far_m = 0;
    assert_int_equal(refocus_depth_to_disparity(&map, out, 8, &report), REFOCUS_OK);
    static const uint16_t none[4] = {0};
    assert_memory_equal(out, none, sizeof out);
    assert_int_equal(report.clamped, 4);
    map.near_m = 0;
    map.far_m = 0.1;
    assert_int_equal(refocus_depth_to_disparity(&map, out, 8, &report), REFOCUS_OK);
    assert_memory_equal(out, none, sizeof out);
    assert_int_equal(report.clamped, 4);
}

TEST(test_unknown_samples)
{
    const float f32[] = {1, NAN, INFINITY, -INFINITY, 0, -2, 4};
    uint16_t out[7];
    struct refocus_depth_report report = refocus_depth_report_default();

    struct refocus_depth_map map = distances_of(REFOCUS_SAMPLE_F32, f32, 7, 1);
    for (int zero_flag = 0; zero_flag <= 1; zero_flag++) { /* a distance <= 0 is none anyway */
        map.flags = zero_flag ? REFOCUS_DEPTH_ZERO_IS_UNKNOWN : 0;
        assert_int_equal(refocus_depth_to_disparity(&map, out, 14, &report), REFOCUS_OK);
        assert_int_equal(report.unknown, 5);
        assert_true(report.near_m == 1 && report.far_m == 4);
        assert_int_equal(out[0], 65535);
        for (int i = 1; i < 7; i++)
            assert_int_equal(out[i], 0); /* the farther side */
    }

    /* Disparities 0 and -2 do hold values, unless 0 is said not to. */
    map = map_of(REFOCUS_SAMPLE_F32, f32, 7, 1);
    assert_int_equal(refocus_depth_to_disparity(&map, out, 14, &report), REFOCUS_OK);
    assert_int_equal(report.unknown, 3);
    assert_true(report.value_near == 4 && report.value_far == -2);
    map.flags = REFOCUS_DEPTH_ZERO_IS_UNKNOWN;
    assert_int_equal(refocus_depth_to_disparity(&map, out, 14, &report), REFOCUS_OK);
    assert_int_equal(report.unknown, 4);

    /* Nothing but holes. */
    static const uint8_t zeros[12] = {0};
    map = distances_of(REFOCUS_SAMPLE_U8, zeros, 4, 3);
    assert_int_equal(refocus_depth_to_disparity(&map, out, 8, &report), REFOCUS_ERR_NO_DEPTH);
}

/* 65535 of distances is a hole where less than a hundredth of the samples has it, and far away
 * where more have it; of disparities it is the nearest. */
TEST(the_greatest_distance)
{
    enum { W = 200, MOST = 350 * W };
    static uint16_t samples[MOST], out[MOST];

    for (int size = W; size <= MOST; size += MOST - W) {
        for (int greatest = size / 100 - 1; greatest <= size / 100; greatest++) {
            struct refocus_depth_report report = refocus_depth_report_default();
            struct refocus_depth_map map = distances_of(REFOCUS_SAMPLE_U16, samples, W, size / W);
            const bool hole = greatest < size / 100;

            for (int i = 0; i < size; i++)
                samples[i] = i >= 50 && i < 50 + greatest ? 65535 : i < size / 2 ? 2000 : 1000;
            map.metres_per_unit = 0.001;
            assert_int_equal(refocus_depth_to_disparity(&map, out, 2 * W, &report), REFOCUS_OK);
            assert_int_equal(report.unknown, hole ? greatest : 0);
            assert_true(fabs(report.far_m - (hole ? 2 : 65.535)) < 1e-9);
            assert_int_equal(out[50], 0);
            assert_true((out[49] == 0) == hole);
            map.meaning = REFOCUS_DEPTH_DISPARITY;
            map.flags = 0;
            assert_int_equal(refocus_depth_to_disparity(&map, out, 2 * W, &report), REFOCUS_OK);
            assert_int_equal(report.unknown, 0);
            assert_int_equal(out[50], 65535);
        }
    }
}

/* In a video 65535 changes its meaning where its share is another one by far, not at each map. */
TEST(the_greatest_distance_in_video)
{
    enum { W = 100, H = 50, PERCENT = W * H / 100 };
    static const struct {
        int count;
        bool hole;
    } maps[] = {
        {PERCENT, false},      {PERCENT - 1, true}, {PERCENT, true}, {10 * PERCENT - 1, true},
        {10 * PERCENT, false}, {PERCENT, false},    {0, true},       {W * H, false}};
    static uint16_t samples[W * H];
    struct refocus_depth_map map = distances_of(REFOCUS_SAMPLE_U16, samples, W, H);
    uint32_t flags = 0;

    for (size_t i = 0; i < sizeof maps / sizeof *maps; i++) {
        for (int k = 0; k < W * H; k++)
            samples[k] = k < maps[i].count ? 65535 : 1000;
        assert_int_equal(refocus_depth_follow_flags(&map, &flags), REFOCUS_OK);
        assert_int_equal(flags, maps[i].hole ? REFOCUS_DEPTH_MAX_IS_UNKNOWN : 0);
    }
    samples[0] = 1000;
    flags = REFOCUS_DEPTH_MAX_IS_UNKNOWN;
    map.meaning = REFOCUS_DEPTH_DISPARITY;
    map.flags = 0;
    assert_int_equal(refocus_depth_follow_flags(&map, &flags), REFOCUS_OK);
    assert_int_equal(flags, 0);
}

/* A round hole in a slope is filled from its sides and smoothed: what lies farthest off the slope
 * is a seventh of what it rises by from the hole's middle to its side. */
TEST(holes_in_slopes)
{
    enum { W = 140, H = 110, X = 70, Y = 55, SLOPE = 30 };
    static uint16_t map[W * H];
    static uint8_t known[W * H];

    for (int radius = 10; radius <= 40; radius += 10) {
        int most = 0;

        for (int i = 0; i < W * H; i++) {
            const double off = hypot(i % W - X, (double)(i / W) - Y);

            map[i] = (uint16_t)(off < radius ? 0 : 20000 + SLOPE * (i % W));
            known[i] = off < radius ? RF_SAMPLE_UNKNOWN : RF_SAMPLE_KNOWN;
        }
        rf_fill_holes(map, 2 * W, W, H, known, NULL);
        for (int i = 0; i < W * H; i++) {
            const int off = abs(map[i] - 20000 - SLOPE * (i % W));

            most = off > most ? off : most;
        }
        assert_in_range(most, 1, SLOPE * radius / 7);
    }
}

/* Large maps of whole numbers go by a table: the same as their rows by themselves. */
static void large_like_rows(uint32_t sample, uint32_t meaning)
{
    enum { W = 331, H = 260 };
    static uint16_t samples[W * H], out[W * H], row[W];
    static uint8_t bytes[W * H], confidence[W * H], row_confidence[W];
    const bool u8 = sample == REFOCUS_SAMPLE_U8;
    struct refocus_repair_params params = refocus_repair_params_default();
    struct refocus_depth_report all = refocus_depth_report_default(), one = all;
    uint64_t unknown = 0, clamped = 0;
    struct refocus_depth_map map;

    for (int i = 0; i < W * H; i++) {
        samples[i] = (uint16_t)((uint32_t)i * 2654435761u >> 16);
        if (i / W % 3) /* two rows of three have no extremes */
            samples[i] = (uint16_t)(20000 + samples[i] % 9000);
        if (i % 89 == 0)
            samples[i] = (uint16_t)(i % 2 ? 0 : 65535);
        bytes[i] = (uint8_t)(samples[i] >> 8);
    }
    map = map_of(sample, u8 ? (const void *)bytes : samples, W, H);
    map.meaning = meaning;
    map.flags = REFOCUS_DEPTH_ZERO_IS_UNKNOWN | REFOCUS_DEPTH_MAX_IS_UNKNOWN;
    map.metres_per_unit = 0.001;
    map.near_m = u8 ? 0.02 : 8;
    map.far_m = u8 ? 0.2 : 60;
    map.value_near = u8 ? 250 : 60000;
    map.value_far = 5;
    params.confidence = confidence;
    params.confidence_stride = W;
    assert_int_equal(refocus_depth_repair(&map, &params, out, 2 * W, &all), REFOCUS_OK);
    params.confidence = row_confidence;
    for (int y = 0; y < H; y++) {
        struct refocus_depth_map part = map;

        part.height = 1;
        part.samples = (const char *)map.samples + y * map.stride;
        assert_int_equal(refocus_depth_repair(&part, &params, row, 2 * W, &one), REFOCUS_OK);
        unknown += one.unknown;
        clamped += one.clamped;
        assert_memory_equal(row_confidence, confidence + y * W, W);
        for (int x = 0; x < W; x++)
            if (row_confidence[x])
                assert_int_equal(row[x], out[y * W + x]);
    }
    assert_true(unknown > W && unknown == all.unknown);
    assert_true(clamped > W && clamped == all.clamped);
}

TEST(test_large_maps)
{
    large_like_rows(REFOCUS_SAMPLE_U16, REFOCUS_DEPTH_DISPARITY);
    large_like_rows(REFOCUS_SAMPLE_U16, REFOCUS_DEPTH_DISTANCE);
    large_like_rows(REFOCUS_SAMPLE_U8, REFOCUS_DEPTH_DISPARITY);
    large_like_rows(REFOCUS_SAMPLE_U8, REFOCUS_DEPTH_DISTANCE);
}

TEST(test_one_depth)
{
    static const uint8_t same[6] = {77, 77, 0, 77, 77, 77};
    static const uint8_t one = 200;
    uint16_t out[6];
    static const uint16_t none[6] = {0};
    struct refocus_depth_report report = refocus_depth_report_default();

    struct refocus_depth_map map = distances_of(REFOCUS_SAMPLE_U8, same, 3, 2);
    memset(out, 0xff, sizeof out);
    assert_int_equal(refocus_depth_to_disparity(&map, out, 6, &report), REFOCUS_OK);
    assert_memory_equal(out, none, sizeof out);
    assert_int_equal(report.unknown, 1);
    assert_int_equal(report.clamped, 0);

    map = map_of(REFOCUS_SAMPLE_U8, &one, 1, 1);
    assert_int_equal(refocus_depth_to_disparity(&map, out, 2, &report), REFOCUS_OK);
    assert_int_equal(out[0], 0);
    map.value_near = 255;
    assert_int_equal(refocus_depth_to_disparity(&map, out, 2, &report), REFOCUS_OK);
    assert_int_equal(out[0], 200 * 257);
}

/* Rows anywhere: odd addresses, odd and negative strides; nothing is written between rows. */
TEST(test_strides)
{
    enum { W = 5, H = 4, STRIDE = 2 * W + 3 };
    unsigned char bytes[1 + H * STRIDE];
    uint16_t plain[W * H], out[H][W + 2], straight[W * H];

    for (int i = 0; i < W * H; i++)
        plain[i] = (uint16_t)((i * 7919 + 1) % 65521);
    plain[7] = 0;
    for (int y = 0; y < H; y++)
        memcpy(bytes + 1 + y * STRIDE, plain + y * W, 2 * W);

    struct refocus_depth_map map = map_of(REFOCUS_SAMPLE_U16, plain, W, H);
    map.flags = REFOCUS_DEPTH_ZERO_IS_UNKNOWN;
    assert_int_equal(refocus_depth_to_disparity(&map, straight, 2 * W, NULL), REFOCUS_OK);

    for (int turned = 0; turned <= 1; turned++) {
        map.samples = turned ? bytes + 1 + (H - 1) * STRIDE : bytes + 1;
        map.stride = turned ? -STRIDE : STRIDE;
        memset(out, 0xa5, sizeof out);
        assert_int_equal(
            turned ? refocus_depth_to_disparity(&map, out[H - 1], -(ptrdiff_t)sizeof *out, NULL)
                   : refocus_depth_to_disparity(&map, out[0], sizeof *out, NULL),
            REFOCUS_OK);
        for (int y = 0; y < H; y++) { /* turned twice is straight */
            assert_int_equal(out[y][W], 0xa5a5);
            assert_int_equal(out[y][W + 1], 0xa5a5);
            for (int x = 0; x < W; x++)
                if (y != 1 || x != 2) /* the hole may be inpainted from another side */
                    assert_int_equal(out[y][x], straight[y * W + x]);
        }
    }
}

TEST(test_bad_arguments)
{
    static const uint16_t samples[6] = {1, 2, 3, 4, 5, 6};
    const struct refocus_depth_map good = distances_of(REFOCUS_SAMPLE_U16, samples, 3, 2);
    struct refocus_depth_map bad[26];
    uint16_t out[6];
    int n = 0;

    assert_int_equal(refocus_depth_to_disparity(&good, out, 6, NULL), REFOCUS_OK);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        bad[i] = good;
    bad[n++].samples = NULL;
    bad[n++].width = 0;
    bad[n++].width = -1;
    bad[n++].height = 0;
    bad[n++].width = 65536;
    bad[n++].height = 65536;
    bad[n++].stride = 5;
    bad[n++].stride = -5;
    bad[n++].stride = PTRDIFF_MIN;
    bad[n++].sample = 0;
    bad[n++].sample = 4;
    bad[n++].meaning = 0;
    bad[n++].meaning = 3;
    bad[n++].flags = 8;
    bad[n++].metres_per_unit = 0;
    bad[n++].metres_per_unit = NAN;
    bad[n++].metres_at_zero = INFINITY;
    bad[n++].near_m = -1;
    bad[n++].near_m = NAN;
    bad[n++].near_m = INFINITY;
    bad[n++].far_m = -1;
    bad[n++].far_m = NAN;
    bad[n].near_m = 2;
    bad[n++].far_m = 2;
    bad[n].meaning = REFOCUS_DEPTH_DISPARITY;
    bad[n++].value_near = NAN;
    bad[n].meaning = REFOCUS_DEPTH_DISPARITY;
    bad[n++].value_far = INFINITY;
    bad[n].meaning = REFOCUS_DEPTH_DISPARITY;
    bad[n].value_near = 1e308;
    bad[n++].value_far = -1e308;
    assert_int_equal(n, sizeof bad / sizeof *bad);
    for (int i = 0; i < n; i++)
        if (refocus_depth_to_disparity(bad + i, out, 6, NULL) != REFOCUS_ERR_ARGUMENT)
            fail_msg("bad map %d is taken", i);
    assert_int_equal(refocus_depth_to_disparity(NULL, out, 6, NULL), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_depth_to_disparity(&good, NULL, 6, NULL), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_depth_to_disparity(&good, out, 4, NULL), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_depth_to_disparity(&good, out, 7, NULL), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_depth_to_disparity(&good, out, PTRDIFF_MIN, NULL),
                     REFOCUS_ERR_ARGUMENT);
}

/* The two ends of the sizes, with one sample known. */
TEST(test_long_rows)
{
    enum { N = 65535 };
    uint16_t *samples = calloc(N, sizeof *samples);
    uint16_t *out = malloc(N * sizeof *out);

    assert_non_null(samples);
    assert_non_null(out);
    samples[0] = 1000;
    samples[N - 1] = 4000;
    for (int upright = 0; upright <= 1; upright++) {
        struct refocus_depth_report report = refocus_depth_report_default();
        struct refocus_depth_map map =
            distances_of(REFOCUS_SAMPLE_U16, samples, upright ? 1 : N, upright ? N : 1);
        assert_int_equal(refocus_depth_to_disparity(&map, out, upright ? 2 : 2 * N, &report),
                         REFOCUS_OK);
        assert_int_equal(report.unknown, N - 2);
        assert_int_equal(out[0], 65535);
        for (int i = N / 2; i < N; i++)
            assert_int_equal(out[i], 0);
        for (int i = 1; i < N; i++) /* one step from the near to the far side */
            assert_true(out[i] <= out[i - 1]);
    }
    free(samples);
    free(out);
}

/* A near post before a far wall with the shadow beside it that a depth sensor leaves. */
TEST(test_fill_takes_the_farther_side)
{
    enum { W = 64, H = 48 };
    float z[H][W];
    uint16_t out[H][W], again[H][W];
    struct refocus_depth_report report = refocus_depth_report_default();

    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++)
            z[y][x] = x >= 20 && x < 32 ? 1.0f : x >= 32 && x < 40 ? 0 : 4.0f;
    struct refocus_depth_map map = distances_of(REFOCUS_SAMPLE_F32, z, W, H);
    assert_int_equal(refocus_depth_to_disparity(&map, out[0], sizeof *out, &report), REFOCUS_OK);
    assert_int_equal(report.unknown, 8 * H);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++)
            assert_int_equal(out[y][x], x >= 20 && x < 32 ? 65535 : 0);
    assert_int_equal(refocus_depth_to_disparity(&map, again[0], sizeof *again, &report),
                     REFOCUS_OK);
    assert_memory_equal(out, again, sizeof out);

    /* A hole within the post is the post's. */
    for (int y = 20; y < 24; y++)
        for (int x = 24; x < 27; x++)
            z[y][x] = 0;
    assert_int_equal(refocus_depth_to_disparity(&map, again[0], sizeof *again, &report),
                     REFOCUS_OK);
    assert_int_equal(report.unknown, 8 * H + 12);
    assert_memory_equal(out, again, sizeof out);
}

/* Maps and reports of an older and a newer program. */
TEST(other_sizes)
{
    struct newer_map {
        struct refocus_depth_map known;
        uint64_t added;
    } map;
    struct newer_report {
        struct refocus_depth_report known;
        uint64_t added, behind;
    } report;
    static const uint16_t mm[4] = {1000, 2000, 3000, 4000};
    uint16_t plain[4], out[4];

    memset(&map, 0, sizeof map);
    memset(&report, 0xa5, sizeof report);
    map.known = distances_of(REFOCUS_SAMPLE_U16, mm, 4, 1);
    map.known.struct_size = sizeof map;
    report.known.struct_size = offsetof(struct newer_report, behind);
    assert_int_equal(refocus_depth_to_disparity(&map.known, plain, 8, &report.known), REFOCUS_OK);
    assert_true(report.known.near_m == 1000);
    assert_true(report.added == 0 && report.behind == 0xa5a5a5a5a5a5a5a5);
    map.added = 1;
    assert_int_equal(refocus_depth_to_disparity(&map.known, out, 8, NULL), REFOCUS_ERR_UNSUPPORTED);
    map.known.struct_size = REFOCUS_SIZE_TO(struct refocus_depth_map, far_m);
    report.known.struct_size = REFOCUS_SIZE_TO(struct refocus_depth_report, specks);
    report.added = 9;
    assert_int_equal(refocus_depth_to_disparity(&map.known, out, 8, &report.known), REFOCUS_OK);
    assert_memory_equal(plain, out, sizeof out);
    assert_true(report.added == 9 && report.known.unknown == 0);
}
