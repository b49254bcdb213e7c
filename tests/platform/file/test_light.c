/* test_light.c: codes by the curves of HDR become light, in the primaries of BT.709, as the
 * recommendations have it; the codes' memory is given back. Linked with --wrap=malloc and so on. */
#include "check.h"
#include "light.h"
#include "failing.h"

#include <math.h>

static struct rf_read reading(void)
{
    static struct refocus_reason reason;

    return (struct rf_read){
        .limits = {.max_side = 64, .max_pixels = 4096, .max_memory = 1 << 20, .max_bytes = 1 << 20},
        .reason = &reason};
}

/* Light of n samples, three to a pixel, that are codes of `max_value` or, if that is 0, floats. */
static void light_of(const float *samples, int n, uint32_t max_value, int curve, int primaries,
                     float *light)
{
    struct rf_read read = reading();
    struct rf_raster raster = {.width = n / 3,
                               .height = 1,
                               .channels = 3,
                               .max_value = max_value,
                               .sample = max_value ? REFOCUS_SAMPLE_U16 : REFOCUS_SAMPLE_F32};

    failing.live = failing.fail_at = 0;
    assert_int_equal(rf_raster_alloc(&read, &raster), REFOCUS_OK);
    for (int i = 0; i < n; i++)
        if (max_value)
            ((uint16_t *)(void *)raster.pixels)[i] = (uint16_t)samples[i];
        else
            ((float *)(void *)raster.pixels)[i] = samples[i];
    assert_int_equal(rf_raster_to_light(&read, &raster, curve, primaries), REFOCUS_OK);
    assert_int_equal(raster.sample, REFOCUS_SAMPLE_F32);
    assert_int_equal(raster.max_value, 0);
    assert_int_equal(failing.live, 1);
    memcpy(light, raster.pixels, (size_t)n * sizeof *light);
    rf_raster_free(&raster);
    assert_int_equal(failing.live, 0);
}

static void is_light(float is, double should, const char *what)
{
    if (!(fabs(is - should) <= 2e-4 * fmax(fabs(should), 0.05)))
        fail_msg("%s: %.7g, should be %.7g", what, is, should);
}

/* Values of BT.2100 and BT.2408: 203 cd/m2 are 58.07 % of PQ, 100 are 50.81 %, and HLG has its
 * peak at 3.7743 times white. */
TEST(curves)
{
    static const struct {
        int curve;
        float value;
        double light;
    } known[] = {
        {RF_CURVE_PQ, 0, 0},
        {RF_CURVE_PQ, 0.580689f, 1},
        {RF_CURVE_PQ, 0.508078f, 100.0 / 203},
        {RF_CURVE_PQ, 1, 10000.0 / 203},
        {RF_CURVE_HLG, 0, 0},
        {RF_CURVE_HLG, 0.25f, 0.0625 / 3 / 0.26496256},
        {RF_CURVE_HLG, 0.5f, 0.25 / 3 / 0.26496256},
        {RF_CURVE_HLG, 0.75f, 1},
        {RF_CURVE_HLG, 1, 1 / 0.26496256},
        {RF_CURVE_SRGB, 0.04f, 0.04 / 12.92},
        {RF_CURVE_SRGB, 0.5f, 0.2140411},
        {RF_CURVE_SRGB, 1, 1},
        {RF_CURVE_LINEAR, 0.3f, 0.3},
    };

    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        const uint32_t bits[] = {0, 65535};

        for (int k = 0; k < 2; k++) {
            const float code = bits[k] ? roundf(known[i].value * 65535) : known[i].value;
            const float pixel[3] = {code, 0, code};
            float light[3];

            light_of(pixel, 3, bits[k], known[i].curve, RF_PRIMARIES_BT709, light);
            is_light(light[0], known[i].light, "light");
            is_light(light[1], 0, "black");
            is_light(light[2], known[i].light, "light");
        }
    }
    assert_true(rf_curve_is_hdr(RF_CURVE_PQ) && rf_curve_is_hdr(RF_CURVE_HLG));
    assert_true(rf_curve_is_hdr(RF_CURVE_LINEAR));
    assert_false(rf_curve_is_hdr(RF_CURVE_SRGB) || rf_curve_is_hdr(RF_CURVE_BT709));
}

/* Codes of 10 bits end at 1023, and what lies beyond is white; floats of PQ end at 1, of linear
 * light nowhere. */
TEST(ends)
{
    const float codes[6] = {1023, 1022, 1024, 65535, 512, 0};
    const float floats[3] = {4, 1, 2};
    float light[6];

    light_of(codes, 6, 1023, RF_CURVE_LINEAR, RF_PRIMARIES_BT709, light);
    is_light(light[0], 1, "1023");
    is_light(light[1], 1022.0 / 1023, "1022");
    is_light(light[2], 1, "1024");
    is_light(light[3], 1, "65535");
    is_light(light[4], 512.0 / 1023, "512");
    light_of(floats, 3, 0, RF_CURVE_LINEAR, RF_PRIMARIES_BT709, light);
    is_light(light[0], 4, "linear 4");
    light_of(floats, 3, 0, RF_CURVE_PQ, RF_PRIMARIES_BT709, light);
    is_light(light[0], 10000.0 / 203, "PQ of 4");
}

/* White stays white, light adds up, and what BT.709 cannot show is 0. */
TEST(primaries)
{
    static const struct {
        int primaries;
        float in[3];
        double out[3];
    } known[] = {
        {RF_PRIMARIES_BT2020, {1, 1, 1}, {1, 1, 1}},
        {RF_PRIMARIES_P3, {1, 1, 1}, {1, 1, 1}},
        {RF_PRIMARIES_BT709, {0.1f, 0.7f, 0.2f}, {0.1, 0.7, 0.2}},
        /* 1.6605 -.5876 -.0728 | -.1246 1.1329 -.0083 | -.0182 -.1006 1.1187 */
        {RF_PRIMARIES_BT2020, {0, 1, 0}, {0, 1.1329, 0}},
        {RF_PRIMARIES_BT2020, {0.5f, 0.25f, 0.125f}, {0.67423, 0.2199, 0.10562}},
        /* 1.2249 -.2249 0 | -.0421 1.0421 0 | -.0196 -.0786 1.0983 */
        {RF_PRIMARIES_P3, {1, 0, 0}, {1.22494, 0, 0}},
        {RF_PRIMARIES_P3, {0.5f, 0.25f, 0.125f}, {0.556235, 0.239486, 0.107806}},
    };

    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        float two[6], light[6];

        memcpy(two, known[i].in, sizeof known[i].in);
        memcpy(two + 3, known[i].in, sizeof known[i].in);
        light_of(two, 6, 0, RF_CURVE_LINEAR, known[i].primaries, light);
        for (int c = 0; c < 6; c++)
            is_light(light[c], known[i].out[c % 3], "a channel");
    }
}

/* Each allocation fails once, and the codes are still the caller's. */
TEST(memory)
{
    for (long k = 1; k <= 2; k++) {
        struct rf_read read = reading();
        struct rf_raster raster = {.width = 2,
                                   .height = 2,
                                   .channels = 3,
                                   .sample = REFOCUS_SAMPLE_U16,
                                   .max_value = 1023};

        failing.calls = failing.live = failing.fail_at = 0;
        assert_int_equal(rf_raster_alloc(&read, &raster), REFOCUS_OK);
        failing.calls = 0;
        failing.fail_at = k;
        assert_int_equal(rf_raster_to_light(&read, &raster, RF_CURVE_PQ, RF_PRIMARIES_P3),
                         REFOCUS_ERR_MEMORY);
        failing.fail_at = 0;
        assert_int_equal(failing.live, 1);
        assert_int_equal(raster.sample, REFOCUS_SAMPLE_U16);
        rf_raster_free(&raster);
    }
}
