/* test_tone.c: the tones of a photo are found from its base rendition and its true light, and shown
 * for light that changed. */
#include "check.h"
#include "tone.h"

#include <math.h>

enum { MOST = 16, ONE = 0x3c00, HALF = 0x3800, QUARTER = 0x3400 };

/* A pixel of the base rendition and its light, times so many of them. */
struct sample {
    uint8_t code[3];
    uint16_t light[3];
    int times;
};

static struct rf_tone *fit(const struct sample *samples, int count, bool by_brightest)
{
    uint8_t codes[3 * MOST];
    uint16_t halves[3 * MOST];
    struct rf_tone *tone = malloc(sizeof *tone);
    struct refocus_image base, light;
    int n = 0;

    assert_non_null(tone);
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < samples[i].times; k++, n++) {
            memcpy(codes + 3 * n, samples[i].code, 3);
            memcpy(halves + 3 * n, samples[i].light, 6);
        }
    }
    assert_true(n <= MOST);
    base = refocus_image_packed(REFOCUS_FORMAT_RGB8, codes, n, 1, 3 * n);
    light = refocus_image_packed(REFOCUS_FORMAT_RGB_HALF, halves, n, 1, 6 * n);
    assert_int_equal(rf_tone_fit(tone, &base, &light, by_brightest), REFOCUS_OK);
    return tone;
}

static void is_shown(const struct rf_tone *tone, int half, double light)
{
    if (!(fabs(tone->shown[half] - light) <= 1e-6)) {
        fail_msg("%#x is shown as %.7f, should be %.7f", half, tone->shown[half], light);
    }
}

#define GREY(c, h, n)                                                                              \
    {                                                                                              \
        {c, c, c}, {h, h, h}, n                                                                    \
    }

/* The middle half of the codes that light of one strength has counts: here of five pixels the last
 * three quarters of the second to the first three of the fourth. */
static void the_middle_half_counts(void **state)
{
    const struct sample samples[] = {GREY(0, HALF, 1), GREY(50, HALF, 2), GREY(100, HALF, 2)};
    const struct sample whole[] = {GREY(255, HALF, 1), GREY(128, HALF, 6), GREY(0, HALF, 1)};
    struct rf_tone *tone = fit(samples, 3, false);

    (void)state;
    is_shown(tone, HALF, 0.7 * (double)rf_tone_light(50) + 0.3 * (double)rf_tone_light(100));
    free(tone);
    tone = fit(whole, 3, false);
    is_shown(tone, HALF, (double)rf_tone_light(128));
    free(tone);
}

/* From black on straight from one to the next, and level behind the last. */
static void straight_between(void **state)
{
    const struct sample samples[] = {GREY(60, QUARTER, 1), GREY(200, ONE, 3)};
    const double a = (double)rf_tone_light(60), b = (double)rf_tone_light(200);
    struct rf_tone *tone = fit(samples, 2, false);

    (void)state;
    is_shown(tone, 0, 0);
    is_shown(tone, QUARTER / 4, a / 4);
    is_shown(tone, QUARTER, a);
    is_shown(tone, HALF, (a + b) / 2); /* halves count */
    is_shown(tone, ONE - 512, a + 0.75 * (b - a));
    is_shown(tone, ONE, b);
    is_shown(tone, RF_HALF_MOST, b);
    free(tone);
}

/* More light is never shown darker: what falls is put together, by how much there is of it. */
static void tones_do_not_fall(void **state)
{
    const struct sample samples[] = {GREY(100, QUARTER, 1), GREY(60, HALF, 3), GREY(200, ONE, 1)};
    struct rf_tone *tone = fit(samples, 3, false);
    const double mean = ((double)rf_tone_light(100) + 3 * (double)rf_tone_light(60)) / 4;

    (void)state;
    is_shown(tone, (QUARTER + 3 * HALF) / 4, mean);
    is_shown(tone, ONE, (double)rf_tone_light(200));
    for (int half = 1; half <= RF_HALF_MOST; half++) {
        assert_true(tone->shown[half] >= tone->shown[half - 1]);
    }
    free(tone);
}

/* By the brightest channel the others do not count, whichever it is. */
static void by_the_brightest(void **state)
{
    struct rf_tone *tone;

    (void)state;
    for (int c = 0; c < 3; c++) {
        struct sample sample = {{10, 10, 10}, {QUARTER, QUARTER, QUARTER}, 1};

        sample.code[c] = 180;
        sample.light[c] = ONE;
        tone = fit(&sample, 1, true);
        assert_true(tone->by_brightest);
        is_shown(tone, ONE, (double)rf_tone_light(180));
        is_shown(tone, ONE / 2, (double)rf_tone_light(180) / 2);
        free(tone);
        tone = fit(&sample, 1, false);
        is_shown(tone, QUARTER, (double)rf_tone_light(10));
        free(tone);
    }
}

static void encode(const struct rf_tone *tone, const uint16_t *own, const uint8_t *base,
                   const uint16_t *light, uint8_t *out)
{
    static const uint8_t thresholds[8] = {31, 31, 31, 31, 31, 31, 31, 31};
    const struct rf_tone_row row = {.own = own,
                                    .base = base,
                                    .light = (const uint8_t *)light,
                                    .out = out,
                                    .width = 1,
                                    .thresholds = thresholds};

    rf_tone_encode(tone, &row);
}

/* Light that is the pixel's own keeps its code, whatever the tones say; light that is all new has
 * the code of its tone, and between them the code's distance from the tone fades. */
static void shown_as_the_photo_shows_it(void **state)
{
    const struct sample samples[] = {GREY(100, HALF, 1), GREY(200, ONE, 1)};
    struct rf_tone *const tone = fit(samples, 2, false);
    const uint16_t own[3] = {HALF, HALF, HALF};
    const uint16_t near_by[3] = {HALF + 1, HALF, HALF}, other[3] = {ONE, 0xffff, ONE};
    const uint8_t base[3] = {90, 100, 110};
    uint8_t out[3];

    (void)state;
    encode(tone, own, base, own, out);
    assert_memory_equal(out, base, 3);
    encode(tone, own, base, near_by, out);
    assert_memory_equal(out, base, 3);
    encode(tone, own, base, other, out);
    assert_int_equal(out[0], 200);
    assert_int_equal(out[1], 0); /* negative light, or none that is a number */
    assert_int_equal(out[2], 200);
    free(tone);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_middle_half_counts),      cmocka_unit_test(straight_between),
        cmocka_unit_test(tones_do_not_fall),           cmocka_unit_test(by_the_brightest),
        cmocka_unit_test(shown_as_the_photo_shows_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
