/* test_grain_coarse.c: noise that is coarser than a pixel is told from texture, which is so too. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "unit_test.h"

#include "look/look.h"

enum { WIDTH = 384, HEIGHT = 320, PIXELS = WIDTH * HEIGHT };

static double plane[PIXELS], spare[PIXELS];
static uint32_t random_state;

static double normally(void)
{
    double sum = -6;

    for (int i = 0; i < 12; i++) {
        random_state = random_state * 1664525 + 1013904223;
        sum += (random_state >> 8) / 16777216.0;
    }
    return sum;
}

static void fill_white(double *at)
{
    for (int i = 0; i < PIXELS; i++)
        at[i] = normally();
}

/* Smooths by (1, 2, 1) / 4 each way, `step` pixels apart, as if the picture went on at its edges
 * where it begins: that is a variance of step^2 / 2. */
static void smooth(double *at, int step)
{
    static double rows[PIXELS];

    for (int i = 0; i < PIXELS; i++) {
        const int y = i / WIDTH * WIDTH, x = i % WIDTH;

        rows[i] = (at[y + (x + WIDTH - step) % WIDTH] + 2 * at[i] + at[y + (x + step) % WIDTH]) / 4;
    }
    for (int i = 0; i < PIXELS; i++) {
        const int up = (i + PIXELS - step * WIDTH) % PIXELS, down = (i + step * WIDTH) % PIXELS;

        at[i] = (rows[up] + 2 * rows[i] + rows[down]) / 4;
    }
}

static double deviation_of(const double *at)
{
    double squares = 0;

    for (int i = 0; i < PIXELS; i++)
        squares += at[i] * at[i];
    return sqrt(squares / PIXELS);
}

/* Noise smoothed so often, 1 pixel apart. */
static void draw_noise(int times)
{
    fill_white(plane);
    for (int i = 0; i < times; i++)
        smooth(plane, 1);
}

/* Light and shade of all sizes, of no detail below 2 pixels: each is 1.4 times as strong as what is
 * half its size. */
static void draw_texture(void)
{
    memset(plane, 0, sizeof plane);
    for (int octave = 0; octave < 5; octave++) {
        double deviation;

        fill_white(spare);
        for (int step = 0; step <= octave; step++)
            for (int i = 0; i < 3; i++)
                smooth(spare, 1 << step);
        deviation = deviation_of(spare);
        for (int i = 0; i < PIXELS; i++)
            plane[i] += spare[i] / deviation * pow(1.4, octave);
    }
}

/* The grain, in codes, of a photo that has what is drawn, of this deviation, over mid-grey. */
static double grain_of(double codes)
{
    static uint8_t rgb[3 * PIXELS];
    static struct rf_grain grain;
    const double scale = codes / deviation_of(plane);
    const struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, rgb, WIDTH, HEIGHT, 3 * WIDTH);
    const struct rf_transfer unused = {0};
    const struct rf_executor alone = {0};
    const struct rf_look look = {
        .exec = &alone, .photo = {WIDTH, HEIGHT, &unused, .image = &image}, .grain = &grain};

    for (int i = 0; i < PIXELS; i++)
        memset(rgb + 3 * i, (int)floor(fmin(fmax(112.5 + plane[i] * scale, 8), 248)), 3);
    rf_measure_grain(&look);
    return grain.sigma[112 / RF_NOISE_WIDTH] / 256.0;
}

/* Noise of a deviation of 1.4 pixels still has the grain that is finer than two pixels, which is
 * 0.45 of it. */
TEST(coarse_noise_stays)
{
    for (int seed = 1; seed <= 3; seed++) {
        for (int times = 0; times <= 4; times++) {
            const double least = times < 2 ? 0.9 : times == 2 ? 0.65 : 0.4;
            double is;

            random_state = (uint32_t)seed;
            draw_noise(times);
            is = grain_of(4);
            if (!(is > least * 4 && is < 1.1 * 4))
                fail_msg("%d, smoothed %d times: %g of 4 codes", seed, times, is);
        }
    }
}

TEST(coarse_texture_goes)
{
    for (int seed = 1; seed <= 3; seed++) {
        random_state = (uint32_t)seed;
        draw_texture();
        for (int codes = 4; codes <= 32; codes *= 2)
            if (grain_of(codes) > 0)
                fail_msg("%d, texture of %d codes: %g", seed, codes, grain_of(codes));
    }
}

/* Makes what is drawn 0.44 to 2.3 times as strong, in patches of some 50 pixels. */
static void vary(void)
{
    double deviation;

    fill_white(spare);
    for (int step = 1; step <= 32; step *= 2)
        for (int i = 0; i < 2; i++)
            smooth(spare, step);
    deviation = deviation_of(spare);
    for (int i = 0; i < PIXELS; i++)
        plane[i] *= exp2(fmin(fmax(spare[i] / deviation, -1.2), 1.2));
}

/* Sharpened fur and gravel differ from pixel to pixel as noise does, but not alike in all places.
 * Noise as strong keeps more than three quarters of its grain. */
TEST(strong_texture_goes)
{
    for (int seed = 1; seed <= 3; seed++) {
        for (int times = 0; times <= 1; times++) {
            random_state = (uint32_t)seed;
            draw_noise(times);
            for (int codes = 4; codes <= 20; codes += 4)
                if (!(grain_of(codes) > 0.75 * codes))
                    fail_msg("%d, noise of %d codes: %g", seed, codes, grain_of(codes));
            vary();
            for (int codes = 24; codes <= 40; codes += 8)
                if (grain_of(codes) > 0)
                    fail_msg("%d, texture of %d codes: %g", seed, codes, grain_of(codes));
        }
    }
}
