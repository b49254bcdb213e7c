/* test_stack_light.c: the light of highlights that are clipped in focus is told by frames in which
 * they are blurred. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "unit_test.h"
#include <math.h>
#include <refocus/stack.h>

enum { W = 320, H = 160, FRAMES = 5, K = 6, SIDE = 6, COUNT = 3, WALL = 16 };

#define WALL_LIGHT 1.05f

/* Highlights, of R, G and B above white and of one channel that is not. */
static const float lamps[COUNT][3] = {{3, 3, 3}, {8, 4, 0.5f}, {12, 6, 2}};

static float scene[H][W][3], light[H][W][3], other[H][W][3];
static uint8_t frame[FRAMES][3 * W * H], photo[3 * W * H], alone[3 * W * H];
static uint16_t half[H][W][3];

static double decoded(double code)
{
    return code <= 0.04045 ? code / 12.92 : pow((code + 0.055) / 1.055, 2.4);
}

static double encoded(double value)
{
    value = value < 1 ? value : 1;
    return value <= 0.0031308 ? 12.92 * value : 1.055 * pow(value, 1 / 2.4) - 0.055;
}

static int left_of(int lamp)
{
    return 60 + 80 * lamp;
}

/* Texture that all lies farthest away, and a wall above that is just clipped. */
static void draw(void)
{
    uint32_t seed = 3;

    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            seed = seed * 1664525 + 1013904223;
            for (int c = 0; c < 3; c++)
                scene[y][x][c] =
                    y < WALL ? WALL_LIGHT : (float)decoded((seed >> 24) / 255.0 * 0.6 + 0.1);
        }
    for (int i = 0; i < COUNT; i++)
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++)
                memcpy(scene[70 + y][left_of(i) + x], lamps[i], sizeof lamps[i]);
}

/* Frame k sees it by a circle of confusion of k / 4 K. */
static void photograph(int k)
{
    const double radius = (double)K * k / (FRAMES - 1);

    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            double sum[3] = {0}, all = 0;

            for (int v = -K; v <= K; v++)
                for (int u = -K; u <= K; u++) {
                    const double inside = radius + 0.5 - sqrt(u * u + v * v);
                    const double weight = inside < 0 ? 0 : inside < 1 ? inside : 1;
                    const int row = y + v < 0 ? 0 : y + v < H ? y + v : H - 1;
                    const int column = x + u < 0 ? 0 : x + u < W ? x + u : W - 1;

                    all += weight;
                    for (int c = 0; c < 3; c++)
                        sum[c] += weight * (double)scene[row][column][c];
                }
            for (int c = 0; c < 3; c++)
                frame[k][3 * (y * W + x) + c] = (uint8_t)(255 * encoded(sum[c] / all) + 0.5);
        }
}

static struct refocus_stack *stacked(int threads)
{
    struct refocus_stack_params params = refocus_stack_params_default(W, H, FRAMES);
    struct refocus_stack *stack;

    params.threads = threads;
    params.reference = 1;
    params.align = REFOCUS_STACK_ALIGN_NONE;
    assert_int_equal(refocus_stack_create(&stack, &params), REFOCUS_OK);
    for (int k = 0; k < FRAMES; k++) {
        const struct refocus_image image =
            refocus_image_packed(REFOCUS_FORMAT_RGB8, frame[k], W, H, 3 * W);

        assert_int_equal(refocus_stack_add(stack, &image, k), REFOCUS_OK);
    }
    return stack;
}

static int finish(struct refocus_stack *stack, uint8_t *rgb, const struct refocus_image *into)
{
    struct refocus_stack_result result = refocus_stack_result_default();

    result.photo = rgb;
    result.photo_stride = 3 * W;
    result.light = into;
    return refocus_stack_finish(stack, &result);
}

static int set_up(void **state)
{
    const struct refocus_image into =
        refocus_image_packed(REFOCUS_FORMAT_RGB_FLOAT, light, W, H, sizeof *light);
    struct refocus_stack *stack;

    (void)state;
    draw();
    for (int k = 0; k < FRAMES; k++)
        photograph(k);
    stack = stacked(1);
    assert_int_equal(finish(stack, photo, &into), REFOCUS_OK);
    refocus_stack_destroy(&stack);
    return 0;
}

/* Means over a highlight lie within 15 %, and what is not clipped is as the photo has it. */
TEST(light_is_found)
{
    for (int i = 0; i < COUNT; i++)
        for (int c = 0; c < 3; c++) {
            double sum = 0;

            for (int y = 0; y < SIDE; y++)
                for (int x = 0; x < SIDE; x++)
                    sum += (double)light[70 + y][left_of(i) + x][c];
            print_message("%.3f of %.3f\n", sum / (SIDE * SIDE), (double)lamps[i][c]);
            assert_true(fabs(sum / (SIDE * SIDE) / (double)lamps[i][c] - 1) < 0.15);
        }
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++)
            for (int c = 0; c < 3; c++) {
                const uint8_t code = photo[3 * (y * W + x) + c];

                if (code < 250)
                    assert_true(fabs((double)light[y][x][c] - decoded(code / 255.0)) < 0.001);
                else
                    assert_true(light[y][x][c] > 0.95f);
            }
}

/* The border, beyond which nothing is seen, is no brighter than what is beside it. */
TEST(borders_are_no_lamps)
{
    float most = 0;

    for (int y = 0; y < WALL; y++)
        for (int x = 0; x < W; x++)
            for (int c = 0; c < 3; c++)
                most = fmaxf(most, light[y][x][c]);
    print_message("%.3f of %.3f\n", (double)most, (double)WALL_LIGHT);
    assert_true(most < 1.25f * WALL_LIGHT);
}

/* Any number of threads gives the same bits; halves are those rounded; the photo needs no light. */
TEST(is_the_same)
{
    const struct refocus_image floats =
        refocus_image_packed(REFOCUS_FORMAT_RGB_FLOAT, other, W, H, sizeof *other);
    const struct refocus_image halves =
        refocus_image_packed(REFOCUS_FORMAT_RGB_HALF, half, W, H, sizeof *half);
    struct refocus_stack *stack = stacked(3);

    assert_int_equal(finish(stack, alone, &floats), REFOCUS_OK);
    refocus_stack_destroy(&stack);
    assert_memory_equal(light, other, sizeof light);
    assert_memory_equal(photo, alone, sizeof photo);
    stack = stacked(2);
    assert_int_equal(finish(stack, alone, &halves), REFOCUS_OK);
    refocus_stack_destroy(&stack);
    for (int i = 0; i < 3 * W * H; i++) {
        const uint16_t bits = (&half[0][0][0])[i];
        const double value = ldexp(1024 + (bits & 1023), (bits >> 10) - 25);

        if (bits >= 1024) /* a normal number */
            assert_true(fabs(value / (double)(&light[0][0][0])[i] - 1) < 0.0005);
    }
    stack = stacked(0);
    assert_int_equal(finish(stack, alone, NULL), REFOCUS_OK);
    refocus_stack_destroy(&stack);
    assert_memory_equal(photo, alone, sizeof photo);
}

/* Whites that noise and JPEG leave some codes short do not tell of light of 1. The second highlight
 * is clipped wherever it is blurred, but for its edge. */
TEST(noisy_white_is_clipped)
{
    const struct refocus_image floats =
        refocus_image_packed(REFOCUS_FORMAT_RGB_FLOAT, other, W, H, sizeof *other);
    struct refocus_stack *stack;
    uint32_t seed = 5;

    for (int k = 0; k < FRAMES; k++)
        for (int i = 0; i < 3 * W * H; i++) {
            seed = seed * 1664525 + 1013904223;
            if (frame[k][i] == 255)
                frame[k][i] = (uint8_t)(255 - (seed >> 24) % 11);
        }
    stack = stacked(2);
    assert_int_equal(finish(stack, alone, &floats), REFOCUS_OK);
    refocus_stack_destroy(&stack);
    for (int i = 0; i < COUNT; i++) {
        double sum = 0;

        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++)
                sum += (double)other[70 + y][left_of(i) + x][0];
        print_message("%.3f of %.3f\n", sum / (SIDE * SIDE), (double)lamps[i][0]);
        assert_true(fabs(sum / (SIDE * SIDE) / (double)lamps[i][0] - 1) < 0.25);
    }
}

TEST(wrong_images_are_refused)
{
    struct refocus_stack *stack = stacked(1);
    struct refocus_image into =
        refocus_image_packed(REFOCUS_FORMAT_RGB_FLOAT, other, W, H, sizeof *other);

    assert_int_equal(finish(stack, NULL, &into), REFOCUS_ERR_ARGUMENT); /* without the photo */
    into.height = H - 1;
    assert_int_equal(finish(stack, photo, &into), REFOCUS_ERR_ARGUMENT);
    into.height = H;
    into.transfer = REFOCUS_TRANSFER_SRGB;
    assert_int_equal(finish(stack, photo, &into), REFOCUS_ERR_ARGUMENT);
    into.transfer = REFOCUS_TRANSFER_LINEAR;
    into.white = 203;
    assert_int_equal(finish(stack, photo, &into), REFOCUS_ERR_ARGUMENT);
    into.white = 0;
    into.format = REFOCUS_FORMAT_RGB16;
    assert_int_equal(finish(stack, photo, &into), REFOCUS_ERR_ARGUMENT);
    into.format = REFOCUS_FORMAT_RGB_FLOAT;
    assert_int_equal(finish(stack, photo, &into), REFOCUS_OK);
    refocus_stack_destroy(&stack);
}

int main(void)
{
    return unit_test_run(set_up, NULL);
}
