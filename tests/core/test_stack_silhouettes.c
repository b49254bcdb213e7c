/* test_stack_silhouettes.c: a blurred bar lies over the background of a focus stack; depth ends at
 * the bar, and the photo in focus everywhere shows the background beside it without its blur. */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "unit_test.h"
#include <refocus/stack.h>

enum { W = 320, H = 120, FRAMES = 5, RADIUS = 8, LEFT = 140, RIGHT = 180, PIXELS = W * H };

static double light[2][PIXELS]; /* linear: the background's and the bar's */
static uint8_t drawn[FRAMES][3 * PIXELS], photo[3 * PIXELS];
static bool is_drawn[FRAMES]; /* for these surfaces and exposures */
static uint16_t disparity[PIXELS];
static double exposure[FRAMES] = {1, 1, 1, 1, 1};

static bool in_bar(int x)
{
    return x >= LEFT && x < RIGHT;
}

static uint8_t code_of(double value)
{
    const double code = value > 0.0031308 ? 1.055 * pow(value, 1 / 2.4) - 0.055 : 12.92 * value;

    return (uint8_t)(255 * (code < 0 ? 0 : code > 1 ? 1 : code) + 0.5);
}

/* Dark texture behind a bright one; grains of three pixels. */
static void draw_surfaces(double brightness)
{
    uint32_t seed = 5;

    memset(is_drawn, 0, sizeof is_drawn);
    for (int y = 0; y < H; y += 3)
        for (int x = 0; x < W; x += 3)
            for (int side = 0; side < 2; side++) {
                seed = seed * 1664525u + 1013904223u;

                const double value = (seed >> 8) % 1000 / 1000.0;

                for (int i = 0; i < 9 && x + i % 3 < W && y + i / 3 < H; i++)
                    light[side][(y + i / 3) * W + x + i % 3] =
                        side ? brightness * (0.2 + 0.2 * value) : 0.08 + 0.04 * value;
            }
}

/* Means over the disc of a surface that is out of focus; a bar has none outside of it. */
static double spread(int side, int x, int y, double radius, double *coverage)
{
    const int reach = (int)ceil(radius);
    double sum = 0, all = 0, covered = 0;

    for (int v = y - reach; v <= y + reach; v++)
        for (int u = x - reach; u <= x + reach; u++) {
            const double away = hypot(u - x, v - y);
            const double w = away < radius - 0.5   ? 1
                             : away < radius + 0.5 ? radius + 0.5 - away
                                                   : 0;
            const int at = (v < 0 ? 0 : v < H ? v : H - 1) * W + (u < 0 ? 0 : u < W ? u : W - 1);

            all += w;
            if (w > 0 && (!side || in_bar(u))) {
                covered += w;
                sum += w * light[side][at];
            }
        }
    *coverage = covered / all;
    return sum / all;
}

/* Frame k of the stack: the background is in focus in the first, the bar in the last. */
static uint8_t *draw(int k)
{
    uint8_t *frame = drawn[k];

    for (int i = 0; i < PIXELS && !is_drawn[k]; i++) {
        double whole, coverage;
        const double away = (double)k / (FRAMES - 1);
        const double back = spread(0, i % W, i / W, RADIUS * away, &whole);
        const double bar = spread(1, i % W, i / W, RADIUS * (1 - away), &coverage);

        memset(frame + 3 * i, code_of(exposure[k] * (bar + (1 - coverage) * back)), 3);
    }
    is_drawn[k] = true;
    return frame;
}

static const int far_first[FRAMES] = {0, 1, 2, 3, 4}, near_first[FRAMES] = {4, 3, 2, 1, 0};

/* Frames are added in that order, with the positions of their focus or without. */
static struct refocus_stack_result run_order(const int *order, uint32_t order_by, bool positions)
{
    struct refocus_stack_params params = refocus_stack_params_default(W, H, FRAMES);
    struct refocus_stack_result result = refocus_stack_result_default();
    struct refocus_stack *stack = NULL;

    params.align = REFOCUS_STACK_ALIGN_NONE;
    params.order = order_by;
    result.photo = photo;
    result.photo_stride = 3 * W;
    result.disparity = disparity;
    result.disparity_stride = 2 * W;
    assert_int_equal(refocus_stack_create(&stack, &params), REFOCUS_OK);
    for (int k = 0; k < FRAMES; k++) {
        const struct refocus_image image =
            refocus_image_packed(REFOCUS_FORMAT_RGB8, draw(order[k]), W, H, 3 * W);

        assert_int_equal(refocus_stack_add(stack, &image, positions ? order[k] : (double)NAN),
                         REFOCUS_OK);
    }
    assert_int_equal(refocus_stack_finish(stack, &result), REFOCUS_OK);
    refocus_stack_destroy(&stack);
    return result;
}

static void run(void)
{
    run_order(far_first, REFOCUS_STACK_ORDER_ADDED, true);
}

/* Root mean square error, in codes, of what the photo shows of the background within the largest
 * radius of the bar, two pixels off. */
static double error_beside(void)
{
    double sum = 0;
    int all = 0;

    for (int i = 0; i < PIXELS; i++) {
        const int x = i % W, away = x < LEFT ? LEFT - x : x - RIGHT + 1;

        if (away > 2 && away <= RADIUS) {
            const double e = photo[3 * i] - code_of(light[0][i]);

            sum += e * e;
            all++;
        }
    }
    return sqrt(sum / all);
}

/* How many pixels are on the wrong one of both surfaces. */
static int misplaced(void)
{
    int wrong = 0;

    for (int i = 0; i < PIXELS; i++)
        wrong += in_bar(i % W) != (disparity[i] > 32768);
    return wrong;
}

/* By how many pixels the bar's two edges move from row to row, in all: they are straight. */
static int teeth(void)
{
    int sum = 0, left = LEFT, right = RIGHT - 1;

    for (int y = 0; y < H; y++) {
        const uint16_t *row = disparity + y * W;
        int first = 0, last = W - 1;

        while (first < W - 1 && row[first] <= 32768)
            first++;
        while (last > 0 && row[last] <= 32768)
            last--;
        sum += abs(first - left) + abs(last - right);
        left = first;
        right = last;
    }
    return sum;
}

TEST(ends_at_silhouettes)
{
    draw_surfaces(1);
    run();
    /* One pixel of a row of 320 is allowed; windows alone are wrong at 12. */
    assert_true(misplaced() < H);
    assert_true(error_beside() < 2);
    assert_true(teeth() < 12); /* votes alone leave 27 */
}

/* The bar's edge is as blurred as the bar is, whatever is brighter. */
TEST(tells_which_end_is_far)
{
    static const int shuffled[FRAMES] = {3, 0, 4, 2, 1};
    static const double brightness[] = {1, 0.08}; /* the bar's: more and less than what is behind */

    for (size_t i = 0; i < sizeof brightness / sizeof *brightness; i++) {
        struct refocus_stack_result result;

        draw_surfaces(brightness[i]);
        result = run_order(far_first, REFOCUS_STACK_ORDER_EITHER, false);
        assert_true(result.direction > 0.1f && result.by_rows == 0);
        assert_int_equal(result.order[0], 1);
        assert_true(misplaced() < H);
        result = run_order(near_first, REFOCUS_STACK_ORDER_EITHER, false);
        assert_true(result.direction < -0.1f && result.by_rows == 0);
        for (int k = 0; k < FRAMES; k++)
            assert_int_equal(result.order[k], FRAMES - k);
        assert_int_equal(result.reference, 3);
        assert_true(misplaced() < H);
        assert_true(error_beside() < 2);
        result = run_order(shuffled, REFOCUS_STACK_ORDER_FOUND, false);
        for (int k = 0; k < FRAMES; k++)
            assert_int_equal(shuffled[result.order[k] - 1], k);
        assert_true(misplaced() < H);
    }
    /* Frames with positions, and those that are said to come far end first, stay as they are. */
    assert_true(run_order(near_first, REFOCUS_STACK_ORDER_EITHER, true).direction == 0);
    assert_true(misplaced() < H);
    assert_true(run_order(near_first, REFOCUS_STACK_ORDER_ADDED, false).direction == 0);
    assert_true(misplaced() > PIXELS / 2);
}

/* A floor, nearer where it is lower, is in focus there in later frames. */
static void draw_floor(void)
{
    draw_surfaces(1);
    for (int k = 0; k < FRAMES; k++) {
        for (int i = 0; i < PIXELS; i++) {
            const double away = (double)k / (FRAMES - 1) - (double)(i / W) / (H - 1);
            double whole;

            memset(drawn[k] + 3 * i,
                   code_of(2 * spread(0, i % W, i / W, RADIUS * fabs(away), &whole)), 3);
        }
        is_drawn[k] = true;
    }
}

/* It has no edges. */
TEST(lower_is_nearer)
{
    struct refocus_stack_result result;

    draw_floor();
    result = run_order(far_first, REFOCUS_STACK_ORDER_EITHER, false);
    assert_in_range(1000 * result.direction, 160, 240);
    assert_int_equal(result.by_rows, 1);
    assert_int_equal(result.order[0], 1);
    assert_in_range(disparity[10 * W + W / 2], 0, 9999);
    assert_in_range(disparity[(H - 10) * W + W / 2], 55000, 65535);
    result = run_order(near_first, REFOCUS_STACK_ORDER_EITHER, false);
    assert_in_range(-1000 * result.direction, 160, 240);
    assert_int_equal(result.by_rows, 1);
    assert_int_equal(result.order[0], FRAMES);
    assert_in_range(disparity[10 * W + W / 2], 0, 9999);
    assert_in_range(disparity[(H - 10) * W + W / 2], 55000, 65535);
}

/* A patch lies on the floor: its texture is in focus in the last frame, its edges are sharp in the
 * first, as those of nothing are. */
static void draw_patch(double brightness)
{
    const double left = 60, right = 120, top = 5, bottom = 55;

    for (int k = 0; k < FRAMES; k++)
        for (int i = 0; i < PIXELS; i++) {
            const int x = i % W, y = i / W;
            const double away = (double)k / (FRAMES - 1), wide = 2 * RADIUS * away + 1;
            const double across = fmin(x - left, right - x) / wide + 0.5;
            const double down = fmin(y - top, bottom - y) / wide + 0.5;
            const double share = fmin(fmax(across, 0), 1) * fmin(fmax(down, 0), 1);
            uint8_t *p = drawn[k] + 3 * i;
            double whole;

            if (share > 0)
                memset(p,
                       (int)(*p + share * (code_of(brightness *
                                                   spread(0, x, y, RADIUS * (1 - away), &whole)) -
                                           *p)),
                       3);
        }
}

/* The votes of the patch are wrong: they are outweighed by what lies lower, or left out as they are
 * clipped. */
TEST(weighs_edges_with_what_lies_lower)
{
    static const double brightness[] = {3, 30};

    for (int clipped = 0; clipped < 2; clipped++) {
        struct refocus_stack_result result;

        draw_floor();
        draw_patch(brightness[clipped]);
        result = run_order(far_first, REFOCUS_STACK_ORDER_EITHER, false);
        assert_true(result.direction > (clipped ? 0.15f : 0.04f));
        assert_int_equal(result.by_rows, 1);
        assert_int_equal(result.order[0], 1);
    }
}

/* A camera that measures the light for each frame: tones are those of the reference. */
TEST(matches_exposures)
{
    static const double metered[FRAMES] = {0.85, 1.1, 1, 0.9, 1.2};
    const double even[FRAMES] = {1, 1, 1, 1, 1};
    struct refocus_stack_result result;

    draw_surfaces(1);
    memcpy(exposure, metered, sizeof exposure);
    result = run_order(far_first, REFOCUS_STACK_ORDER_ADDED, true);
    assert_int_equal(result.reference, 3);
    assert_true(result.moving == 0);
    assert_true(misplaced() < H);
    assert_true(error_beside() < 3); /* 8 without */
    for (int y = 8; y < H; y += 16) {
        const int i = y * W + (LEFT + RIGHT) / 2;

        assert_in_range(photo[3 * i], code_of(light[1][i]) - 2, code_of(light[1][i]) + 2);
    }
    memcpy(exposure, even, sizeof exposure);
}

/* The bar is five times as bright as white: none of its light that is blurred over the background
 * stays there, although nobody knows how much it is. */
TEST(leaves_no_disc_of_what_is_clipped)
{
    double of_frame;

    draw_surfaces(15);
    memcpy(photo, draw(0), sizeof photo);
    of_frame = error_beside();
    run();
    assert_true(of_frame > 100);
    assert_true(error_beside() < 12);
}
