/* test_strays.c: samples that are far nearer than all others do not decide the range of distances.
 */
#include <stdint.h>
#include <stdlib.h>
#include "unit_test.h"
#include <refocus/depth.h>

/* 70,000 samples: whole numbers go by a table, and fewer than 70 may be strays. */
enum { W = 280, H = 250, SAMPLES = W * H, FEWEST = 70 };

static struct refocus_depth_map distances_of(uint32_t sample, const void *samples)
{
    struct refocus_depth_map map = refocus_depth_map_default();

    map.samples = samples;
    map.width = W;
    map.height = H;
    map.sample = sample;
    map.stride = W * (sample == REFOCUS_SAMPLE_U16 ? 2 : 4);
    map.meaning = REFOCUS_DEPTH_DISTANCE;
    map.metres_per_unit = sample == REFOCUS_SAMPLE_U16 ? 0.001 : 1;
    return map;
}

static struct refocus_depth_report convert(uint32_t sample, const uint16_t *mm, double near_m,
                                           uint16_t *out)
{
    static float metres[SAMPLES];
    struct refocus_depth_report report = refocus_depth_report_default();
    struct refocus_depth_map map =
        distances_of(sample, sample == REFOCUS_SAMPLE_U16 ? (const void *)mm : metres);

    for (int i = 0; i < SAMPLES; i++)
        metres[i] = (float)mm[i] / 1000;
    map.near_m = near_m;
    assert_int_equal(refocus_depth_to_disparity(&map, out, 2 * W, &report), REFOCUS_OK);
    return report;
}

/* A slope from 0.5 to 2 m with so many samples that are 3 and 28 mm away, `step` samples apart;
 * or with as many that hold no value. */
static void slope(uint16_t *mm, int count, int step, int without)
{
    for (int i = 0; i < SAMPLES; i++)
        mm[i] = (uint16_t)(500 + i * 1500LL / (SAMPLES - 1));
    for (int i = 0; i < count; i++)
        mm[5 + i * step] = (uint16_t)(without ? 0 : 3 + 25 * (i % 2));
}

static uint16_t mm[SAMPLES], out[SAMPLES], expected[SAMPLES];

/* Samples by themselves and fewer than a thousandth are as if they held no value. */
TEST(strays_are_filled)
{
    static const struct {
        int count, step;
    } some[] = {{1, 1}, {2, 1}, {2, 800}, {33, 1}, {FEWEST - 1, 997}};

    for (uint32_t sample = REFOCUS_SAMPLE_U16; sample <= REFOCUS_SAMPLE_F32; sample++) {
        for (size_t i = 0; i < sizeof some / sizeof *some; i++) {
            struct refocus_depth_report report, without;

            slope(mm, some[i].count, some[i].step, 1);
            without = convert(sample, mm, 0, expected);
            slope(mm, some[i].count, some[i].step, 0);
            report = convert(sample, mm, 0, out);
            assert_int_equal(report.strays, some[i].count);
            assert_int_equal(without.strays + report.unknown + report.clamped, 0);
            assert_true(report.near_m == without.near_m && report.far_m == without.far_m);
            assert_memory_equal(out, expected, sizeof out);
        }
    }
}

/* A thousandth is a thing, and so is what a caller's range reaches to. */
TEST(many_and_given_ones_stay)
{
    for (uint32_t sample = REFOCUS_SAMPLE_U16; sample <= REFOCUS_SAMPLE_F32; sample++) {
        struct refocus_depth_report report;

        slope(mm, FEWEST, 997, 0);
        for (int i = 0; i < FEWEST; i++)
            mm[5 + i * 997] = 3;
        report = convert(sample, mm, 0, out);
        assert_true(report.strays == 0 && report.near_m < 0.0031 && out[5] == 65535);
        slope(mm, 2, 800, 0);
        report = convert(sample, mm, 0.003, out);
        assert_true(report.strays == 0 && report.near_m == 0.003 && out[5] == 65535);
    }
}

/* Nine samples in a square are a thing, at any border; eight of them are none. */
TEST(small_things_stay)
{
    static const int left[] = {0, 100, W - 3}, top[] = {0, 120, H - 3};

    for (int at = 0; at < 9; at++) {
        const int corner = top[at / 3] * W + left[at % 3];
        struct refocus_depth_report report;

        slope(mm, 0, 0, 0);
        for (int i = 0; i < 9; i++)
            mm[corner + i / 3 * W + i % 3] = 100;
        report = convert(REFOCUS_SAMPLE_U16, mm, 0, out);
        assert_true(report.strays == 0 && report.near_m == 1 / (1 / (100 * 0.001)));
        assert_int_equal(out[corner + W + 1], 65535);
        mm[corner + W + 1] = 0;
        report = convert(REFOCUS_SAMPLE_U16, mm, 0, out);
        assert_int_equal(report.strays, 8);
    }
}

/* Ranks from 0.5 to 2 of 1/m: a single one counts that leaves them more than half of the range. */
TEST(less_than_half_the_range_stays)
{
    struct refocus_depth_report report;

    slope(mm, 1, 1, 0);
    mm[5] = 286; /* 3.497: all others lie below 2.0, the middle of .5 and this */
    report = convert(REFOCUS_SAMPLE_U16, mm, 0, out);
    assert_int_equal(report.strays, 0);
    mm[5] = 285; /* 3.509 */
    report = convert(REFOCUS_SAMPLE_U16, mm, 0, out);
    assert_int_equal(report.strays, 1);
}

/* The rest may be of one depth: then all is 0. */
TEST(one_depth_is_left)
{
    static uint8_t confidence[SAMPLES];
    struct refocus_repair_params params = refocus_repair_params_default();
    struct refocus_depth_report report = refocus_depth_report_default();
    const struct refocus_depth_map map = distances_of(REFOCUS_SAMPLE_U16, mm);

    for (int i = 0; i < SAMPLES; i++)
        mm[i] = i == 9 ? 3 : 700;
    params.confidence = confidence;
    params.confidence_stride = W;
    params.speckle = 5;
    assert_int_equal(refocus_depth_repair(&map, &params, out, 2 * W, &report), REFOCUS_OK);
    assert_true(report.strays == 1 && report.specks == 0);
    for (int i = 0; i < SAMPLES; i++)
        assert_true(out[i] == 0 && confidence[i] == (i == 9 ? 0 : 255));
}
