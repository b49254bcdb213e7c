/* test_tone.c: the tones of a photo are found from its base rendition and its true light, place by
 * place, and shown for light that changed. */
#include "check.h"
#include "tone.h"

#include <math.h>

enum { SIDE = 96, ONE = 0x3c00, HALF = 0x3800, QUARTER = 0x3400 };

static uint8_t codes[3 * SIDE * SIDE];
static uint16_t halves[3 * SIDE * SIDE];

static void set(int x, int y, uint16_t light, double base)
{
    for (int c = 0; c < 3; c++) {
        const double v = base <= 0.0031308 ? 12.92 * base : 1.055 * pow(base, 1 / 2.4) - 0.055;

        codes[3 * (SIDE * y + x) + c] = (uint8_t)(255 * v + 0.5);
        halves[3 * (SIDE * y + x) + c] = light;
    }
}

static struct rf_tone *fit(bool by_brightest)
{
    const struct refocus_image base =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, codes, SIDE, SIDE, 3 * SIDE);
    const struct refocus_image light =
        refocus_image_packed(REFOCUS_FORMAT_RGB_HALF, halves, SIDE, SIDE, 6 * SIDE);
    struct rf_tone *tone = malloc(sizeof *tone);

    assert_non_null(tone);
    assert_int_equal(rf_tone_fit(tone, &base, &light, by_brightest), REFOCUS_OK);
    return tone;
}

/* The tones of a photo whose pixels are white or half as bright, by turns. */
static struct rf_tone *fit_two(void)
{
    for (int i = 0; i < 3 * SIDE * SIDE; i++) {
        codes[i] = i / 3 % 2 ? 200 : 100;
        halves[i] = i / 3 % 2 ? ONE : HALF;
    }
    return fit(false);
}

/* Shows `count` pixels of a row from (x, y) on. */
static void encode_row(const struct rf_tone *tone, int x, int y, int count, const uint16_t *own,
                       const uint8_t *base, const uint16_t *light, uint8_t *out)
{
    static uint16_t owns[3 * SIDE * SIDE], lights[3 * SIDE];
    static uint8_t bases[3 * SIDE * SIDE], thresholds[64];
    const struct refocus_image own_image =
        refocus_image_packed(REFOCUS_FORMAT_RGB_HALF, owns, SIDE, SIDE, 6 * SIDE);
    const struct refocus_image base_image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, bases, SIDE, SIDE, 3 * SIDE);
    const struct refocus_image light_image =
        refocus_image_packed(REFOCUS_FORMAT_RGB_HALF, lights, count, 1, 6 * SIDE);
    const struct refocus_image out_image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, out, count, 1, 3 * SIDE);
    const struct rf_tone_part part = {.own = &own_image,
                                      .base = &base_image,
                                      .light = &light_image,
                                      .out = &out_image,
                                      .x = x,
                                      .y = y,
                                      .thresholds = thresholds};
    const size_t samples = 3 * (size_t)count;

    memset(thresholds, 31, sizeof thresholds);
    memcpy(owns + 3 * (SIDE * y + x), own, samples * sizeof *own);
    memcpy(bases + 3 * (SIDE * y + x), base, samples);
    memcpy(lights, light, samples * sizeof *light);
    rf_tone_encode(tone, &part);
}

static void encode(const struct rf_tone *tone, int x, int y, const uint16_t *own,
                   const uint8_t *base, const uint16_t *light, uint8_t *out)
{
    encode_row(tone, x, y, 1, own, base, light, out);
}

/* The light that is shown of grey light at a place whose own is black. */
static double shown(const struct rf_tone *tone, int x, int y, int half)
{
    static const uint16_t own[3] = {0, 0, 0};
    static const uint8_t base[3] = {0, 0, 0};
    const uint16_t light[3] = {(uint16_t)half, (uint16_t)half, (uint16_t)half};
    uint8_t out[3];

    encode(tone, x, y, own, base, light, out);
    return (double)rf_tone_light(out[1]);
}

static void is_shown(const struct rf_tone *tone, int x, int y, int half, double light)
{
    const double is = shown(tone, x, y, half);

    if (!(fabs(is - light) <= 0.02 * light + 0.002))
        fail_msg("%#x at (%d, %d) is shown as %.4f, should be %.4f", half, x, y, is, light);
}

/* Light from 0 to 2 in each cell, shown as half of it in the left third, as a quarter in the right,
 * and as a third between. */
static const double part_of[3] = {0.5, 1 / 3.0, 0.25};

static void fill(void)
{
    for (int y = 0; y < SIDE; y++) {
        for (int x = 0; x < SIDE; x++) {
            const int i = (7 * x + 11 * y) % 97;
            const uint16_t light = rf_half_of((float)i / 48);

            set(x, y, light, part_of[3 * x / SIDE] * (double)rf_half_value(light));
        }
    }
}

TEST(tones_are_of_their_place)
{
    fill();
    for (int by_brightest = 0; by_brightest < 2; by_brightest++) {
        struct rf_tone *tone = fit(by_brightest);

        for (int third = 0; third < 3; third++) {
            for (int half = QUARTER; half <= ONE; half += 128) {
                is_shown(tone, 16 + 32 * third, 48, half,
                         part_of[third] * (double)rf_half_value((uint16_t)half));
            }
        }
        for (int x = 1; x < SIDE; x++) /* without a step from one to the next */
            assert_true(fabs(shown(tone, x, 48, ONE) - shown(tone, x - 1, 48, ONE)) < 0.04);
        free(tone);
    }
}

/* A cell that has no pixel of a light shows it as the photo does elsewhere; what is brighter than
 * all is as bright as the brightest. */
TEST(few_pixels_take_the_photo_s)
{
    struct rf_tone *tone;

    for (int y = 0; y < SIDE; y++) {
        for (int x = 0; x < SIDE; x++) {
            const bool bright = x >= SIDE / 2;

            set(x, y, bright ? ONE : QUARTER, bright ? 0.7 : 0.2);
        }
    }
    set(90, 90, 0x4800, 1);
    tone = fit(false);
    is_shown(tone, 4, 48, QUARTER, 0.2);
    is_shown(tone, 4, 48, ONE, 0.7);
    is_shown(tone, 92, 48, ONE, 0.7);
    is_shown(tone, 92, 48, QUARTER, 0.2);
    is_shown(tone, 4, 4, 0x4800, 1);
    is_shown(tone, 4, 4, RF_HALF_MOST, 1);
    assert_true(shown(tone, 4, 4, 0x4400) < 0.95);
    is_shown(tone, 4, 4, QUARTER / 2, shown(tone, 92, 92, QUARTER / 2));
    free(tone);
}

/* Where the photo clips, its curve comes up to white and bends there, as light between the knots
 * does: noise and JPEG leave white a code or two short. */
TEST(clipped_light_is_white)
{
    struct rf_tone *tone;

    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            const int i = (7 * x + 11 * y) % 97;
            const uint16_t light = rf_half_of(0.5f + (float)i / 64);
            const double value = (double)rf_half_value(light);

            set(x, y, light, value < 1 ? value : i & 1 ? 1 : 0.98);
        }
    tone = fit(false);
    is_shown(tone, 48, 48, HALF + 256, 0.625);
    is_shown(tone, 48, 48, HALF + 512, 0.75);
    is_shown(tone, 48, 48, ONE, 0.985);
    is_shown(tone, 48, 48, ONE + 128, 0.99);
    is_shown(tone, 48, 48, ONE + 512, 0.99);
    is_shown(tone, 48, 48, ONE + 1024, 0.99);
    free(tone);
}

/* More light is never shown darker. */
TEST(tones_do_not_fall)
{
    struct rf_tone *tone;

    for (int y = 0; y < SIDE; y++) {
        for (int x = 0; x < SIDE; x++) {
            const int i = (3 * x + 5 * y) % 3;

            set(x, y, (uint16_t)(QUARTER + (HALF - QUARTER) * i),
                i == 0   ? 0.4
                : i == 1 ? 0.2
                         : 0.8);
        }
    }
    tone = fit(false);
    for (int x = 5; x < SIDE; x += 17)
        for (int half = 64; half <= RF_HALF_MOST; half += 64)
            assert_true(shown(tone, x, x, half) >= shown(tone, x, x, half - 64));
    is_shown(tone, 48, 48, HALF, 0.3);
    free(tone);
}

/* Channels have curves of their own; by the brightest channel the others do not count, whichever it
 * is, and keep their ratio to it. */
TEST(by_the_brightest)
{
    const uint16_t own[3] = {0, 0, 0};
    const uint8_t base[3] = {0, 0, 0};

    for (int c = 0; c < 3; c++) {
        struct rf_tone *tone;
        uint16_t light[3] = {QUARTER, QUARTER, QUARTER};
        uint8_t out[3];

        light[c] = ONE;
        for (int i = 0; i < 3 * SIDE * SIDE; i++) {
            codes[i] = i % 3 == c ? 180 : 10;
            halves[i] = light[i % 3];
        }
        tone = fit(true);
        assert_true(tone->by_brightest);
        encode(tone, 48, 48, own, base, light, out);
        assert_int_equal(out[c], 180);
        assert_true(fabs(4 * (double)rf_tone_light(out[(c + 1) % 3]) / (double)rf_tone_light(180) -
                         1) < 0.02);
        free(tone);
        tone = fit(false);
        encode(tone, 48, 48, own, base, light, out);
        for (int k = 0; k < 3; k++)
            assert_int_equal(out[k], k == c ? 180 : 10);
        free(tone);
    }
}

/* Light that is the pixel's own keeps its code, whatever the tones say; light that is all new has
 * the code of its tone, and between them the code's distance from the tone fades. */
TEST(shown_as_the_photo_shows_it)
{
    const uint16_t own[3] = {HALF, HALF, HALF};
    const uint16_t near_by[3] = {HALF + 1, HALF, HALF}, other[3] = {ONE, 0xffff, ONE};
    const uint8_t base[3] = {90, 100, 110};
    struct rf_tone *tone;
    uint8_t out[3];

    tone = fit_two();
    encode(tone, 48, 48, own, base, own, out);
    assert_memory_equal(out, base, 3);
    encode(tone, 48, 48, own, base, near_by, out);
    assert_memory_equal(out, base, 3);
    encode(tone, 48, 48, own, base, other, out);
    assert_int_equal(out[0], 200);
    assert_int_equal(out[1], 0); /* negative light, or none that is a number */
    assert_int_equal(out[2], 200);
    free(tone);
}

/* Where blurred light is that of a pixel by chance, between others that it is not that of, nothing
 * of the pixel's own tone shows. */
TEST(light_by_chance)
{
    static const uint16_t light[9] = {ONE, ONE, ONE, HALF, HALF, HALF, ONE, ONE, ONE};
    static const uint8_t base[9] = {90, 90, 90, 90, 90, 90, 90, 90, 90};
    uint16_t own[9];
    struct rf_tone *tone;
    uint8_t out[9];

    for (int i = 0; i < 9; i++)
        own[i] = HALF + 1;
    tone = fit_two();
    encode_row(tone, 48, 48, 3, own, base, light, out);
    assert_in_range(out[4], 97, 101);
    encode_row(tone, 48, 48, 1, own + 3, base + 3, light + 3, out);
    assert_in_range(out[0], 89, 91);
    free(tone);
}

/* A part is shown as it is in the whole photo, and in nine pixels at its sides nearly so: what lies
 * beyond them is not known. The two at the sides have no bound. */
TEST(parts_are_shown_as_the_whole)
{
    enum {
        X = 13,
        Y = 7,
        WIDE = 70,
        HIGH = 60,
        SIDES = 2,
        REACHED = 9,
        LOOKED_AT = (WIDE - 2 * REACHED) * (HIGH - 2 * REACHED)
    };
    static uint16_t lights[3 * SIDE * SIDE];
    static uint8_t whole[3 * SIDE * SIDE], part[3 * SIDE * SIDE];
    const struct refocus_image base =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, codes, SIDE, SIDE, 3 * SIDE);
    const struct refocus_image own =
        refocus_image_packed(REFOCUS_FORMAT_RGB_HALF, halves, SIDE, SIDE, 6 * SIDE);
    const struct refocus_image light =
        refocus_image_packed(REFOCUS_FORMAT_RGB_HALF, lights, SIDE, SIDE, 6 * SIDE);
    const struct refocus_image cut = refocus_image_packed(
        REFOCUS_FORMAT_RGB_HALF, lights + 3 * (SIDE * Y + X), WIDE, HIGH, 6 * SIDE);
    const struct refocus_image shown =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, whole, SIDE, SIDE, 3 * SIDE);
    const struct refocus_image shown_cut =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, part, WIDE, HIGH, 3 * SIDE);
    static const uint8_t thresholds[64] = {7, 31, 60};
    struct rf_tone *tone;
    int kept = 0, worst = 0;

    for (int i = 0; i < 3 * SIDE * SIDE; i++) {
        const int noise = 7 * i % 61 + 5 * i % 17;

        codes[i] = (uint8_t)(60 + i % 23 + noise);
        halves[i] = (uint16_t)(HALF + 7 * noise);
        lights[i] = (uint16_t)(halves[i] + i % 5 + (i / 3 % SIDE > 40 ? 100 * (i % 7) : 0));
    }
    tone = fit(false);
    rf_tone_encode(tone, &(struct rf_tone_part){&own, &base, &light, &shown, 0, 0, thresholds});
    rf_tone_encode(tone, &(struct rf_tone_part){&own, &base, &cut, &shown_cut, X, Y, thresholds});
    for (int y = SIDES; y < HIGH - SIDES; y++) {
        for (int x = SIDES; x < WIDE - SIDES; x++) {
            const uint8_t *a = whole + 3 * (SIDE * (Y + y) + X + x), *b = part + 3 * (SIDE * y + x);

            if (x < REACHED || y < REACHED || x >= WIDE - REACHED || y >= HIGH - REACHED) {
                for (int c = 0; c < 3; c++)
                    worst = abs(a[c] - b[c]) > worst ? abs(a[c] - b[c]) : worst;
                continue;
            }
            kept += abs(a[1] - codes[3 * (SIDE * (Y + y) + X + x) + 1]) < 2;
            if (memcmp(a, b, 3) != 0) {
                fail_msg("(%d, %d) of a part is %d %d %d, not %d %d %d", x, y, b[0], b[1], b[2],
                         a[0], a[1], a[2]);
            }
        }
    }
    assert_in_range(worst, 0, 2); /* codes */
    /* Both ways of showing are seen. */
    assert_in_range(kept, LOOKED_AT / 4, LOOKED_AT * 3 / 4);
    free(tone);
}

/* Light that saturates at 4 times white is shown as the photo is around, if that is more, whatever
 * the pixel's own is, and light below that leads there without a step. */
TEST(saturated_light_is_that_around)
{
    static const uint16_t bright[3] = {0x4800, 0x4800, 0x4800}, dim[3] = {0x4200, 0x4200, 0x4200};
    static const uint8_t base[3] = {250, 250, 250}, dim_base[3] = {220, 220, 220};
    struct rf_tone *tone;
    uint8_t out[3], other[3], last = 0;

    for (int i = 0; i < 3 * SIDE * SIDE; i++) {
        const bool left = i / 3 % SIDE < SIDE / 2;

        codes[i] = left ? 250 : 180;
        halves[i] = left ? 0x4800 : ONE;
    }
    tone = fit(false);
    for (int half = 0x4000; half <= 0x4400; half += 8) { /* 2 to 4 times white */
        const uint16_t light[3] = {(uint16_t)half, (uint16_t)half, (uint16_t)half};

        encode(tone, 20, 48, bright, base, light, out);
        encode(tone, 20, 48, dim, dim_base, light, other);
        assert_in_range(other[0], last, last ? last + 2 : 255);
        last = other[0];
    }
    assert_in_range(out[0], 249, 251);
    assert_int_equal(out[0], other[0]);
    encode(tone, 80, 48, bright, base, (const uint16_t[3]){0x4400, 0x4400, 0x4400}, out);
    assert_in_range(out[0], 181, 240); /* less than that around */
    free(tone);
}
