/* test_focus_stack.c: depth and the photo in focus everywhere, of focus stacks that are drawn. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "unit_test.h"
#include "stack_scene.h"

TEST(finds_surfaces)
{
    static const struct scene scenes[] = {
        {.left = 0, .right = 4}, {.left = 1, .right = 3}, {.left = 2.4, .right = 0.5}};

    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        struct refocus_stack_result result;

        draw(&scenes[i]);
        result = run(NULL, NULL, REFOCUS_STACK_ALIGN_SIMILARITY);
        assert_true(right_share(&scenes[i]) > 0.99);
        assert_true(photo_error(&scenes[i]) < (i < 2 ? 1.5 : 8));
        assert_true(result.measured > 0.95f);
        assert_true(result.moved == 0);
    }
}

/* Few frames: surfaces between them are found by how their sharpness compares. */
TEST(finds_surfaces_in_any_number)
{
    static const struct {
        int frames;
        struct scene scene;
        double right;
    } stacks[] = {
        {9, {.left = 1, .right = 6.5}, 0.99}, {6, {.left = 1, .right = 3.5}, 0.99},
        {8, {.left = 1.5, .right = 6}, 0.99}, {7, {.left = 5.5, .right = 2}, 0.99},
        {4, {.left = 0, .right = 2.5}, 0.95}, {3, {.left = 0, .right = 2}, 0.99},
        {3, {.left = 0, .right = 1.5}, 0.9},  {2, {.left = 0, .right = 1}, 0.99},
        {2, {.left = 0, .right = 0.5}, 0.9},
    };

    for (size_t i = 0; i < sizeof stacks / sizeof *stacks; i++) {
        frames = stacks[i].frames;
        draw(&stacks[i].scene);
        run(NULL, NULL, REFOCUS_STACK_ALIGN_SIMILARITY);
        assert_true(right_share(&stacks[i].scene) > stacks[i].right);
    }
    frames = FRAMES;
}

TEST(takes_positions)
{
    static const struct scene scene = {.left = 1, .right = 3}, apart = {.left = 1, .right = 6};
    static const int order[FRAMES] = {3, 0, 4, 2, 1};
    static const double even[FRAMES] = {0.5, 1, 1.5, 2, 2.5}, uneven[FRAMES] = {0, 1, 2, 6, 10};
    static uint8_t photo_before[3 * PIXELS];
    static uint16_t before[PIXELS];

    draw(&scene);
    run(NULL, NULL, REFOCUS_STACK_ALIGN_NONE);
    memcpy(before, disparity, sizeof before);
    memcpy(photo_before, photo, sizeof photo_before);
    run(order, even, REFOCUS_STACK_ALIGN_NONE);
    assert_memory_equal(before, disparity, sizeof before);
    assert_memory_equal(photo_before, photo, sizeof photo_before);
    focus = uneven;
    draw(&apart);
    focus = NULL;
    run(order, uneven, REFOCUS_STACK_ALIGN_NONE);
    assert_true(fabs(disparity[48 * W + 36] / 65535.0 - 0.1) < 0.02);
    assert_true(fabs(disparity[48 * W + 108] / 65535.0 - 0.6) < 0.03);
}

TEST(tells_disorder)
{
    static const struct scene scene = {.left = 1, .right = 3, .scale = 0.003};
    static const int order[FRAMES] = {3, 0, 4, 2, 1}, reversed[FRAMES] = {4, 3, 2, 1, 0};

    draw(&scene);
    assert_true(run(NULL, NULL, REFOCUS_STACK_ALIGN_SIMILARITY).disorder < 0.05f);
    assert_true(run(reversed, NULL, REFOCUS_STACK_ALIGN_SIMILARITY).disorder < 0.05f);
    assert_true(run(order, NULL, REFOCUS_STACK_ALIGN_SIMILARITY).disorder > 0.5f);
}

TEST(undoes_breathing_and_shake)
{
    static const struct scene scenes[] = {
        {.left = 1, .right = 3, .scale = 0.0075},
        {.left = 1, .right = 3, .shift_x = 1.3, .shift_y = -0.8},
        {.left = 3, .right = 1, .scale = -0.005, .shift_x = -0.6, .shift_y = 0.4}};

    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        const struct scene *s = &scenes[i];
        /* The way of the corners of the first and the last frame. */
        const double x = 2 * (fabs(s->scale) * (W - 1) / 2 + fabs(s->shift_x));
        const double y = 2 * (fabs(s->scale) * (H - 1) / 2 + fabs(s->shift_y));
        struct refocus_stack_result result;

        draw(s);
        result = run(NULL, NULL, REFOCUS_STACK_ALIGN_SIMILARITY);
        assert_true(fabs((double)result.moved - sqrt(x * x + y * y)) < 0.25);
        assert_true(right_share(s) > 0.97);
        assert_true(photo_error(s) < 6);
        run(NULL, NULL, REFOCUS_STACK_ALIGN_NONE);
        assert_true(photo_error(s) > 12);
    }
}

/* The frame that is focused on the right surface does not show its right end, and ends where that
 * is flat: the other frames, which show texture out of focus there, are not taken for sharp. */
TEST(measures_nothing_beyond_the_border)
{
    static const struct scene scenes[] = {
        {.left = 0, .right = 4, .flat = 1, .shift_x = 14},
        {.left = 0, .right = 4, .flat = 1, .shift_x = 14, .noise = 2},
        {.left = 0, .right = 4, .flat = 1, .shift_x = 10}};

    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        const double d = scenes[i].right / (FRAMES - 1);
        int wrong = 0;

        draw(&scenes[i]);
        run(NULL, NULL, REFOCUS_STACK_ALIGN_SIMILARITY);
        for (int y = 20; y < 76; y++)
            for (int x = 132; x < W; x++)
                wrong += fabs(disparity[y * W + x] / 65535.0 - d) > 0.1;
        assert_true(wrong < 12 * 56 / 20);
    }
}

/* The first frame is sharp on the left, but shows nothing of the first six columns, nor the second
 * one of the first three: these are as in the reference, not smeared from beside. */
TEST(covers_the_border)
{
    static const struct scene scene = {.left = 0, .right = 3, .shift_x = 3};
    int wrong = 0;

    draw(&scene);
    run(NULL, NULL, REFOCUS_STACK_ALIGN_SIMILARITY);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < 2; x++)
            wrong += abs(photo[3 * (y * W + x)] - frame[FRAMES / 2][3 * (y * W + x)]) > 1;
    assert_true(wrong < H / 10);
}

/* Where the first frame ends, at column 6, the photo goes over from it to the second within two
 * pixels, of a size of 128 and more. */
TEST(fades_where_a_frame_ends)
{
    static const struct scene scene = {.left = 0, .right = 3, .shift_x = 3};
    double from_mix = 0, from_first = 0;

    draw(&scene);
    run(NULL, NULL, REFOCUS_STACK_ALIGN_SIMILARITY);
    for (int y = 8; y < H - 8; y++)
        for (int x = 6; x < 8; x++) {
            const int here = photo[3 * (y * W + x)], first = frame[0][3 * (y * W + x - 6)];
            const int second = frame[1][3 * (y * W + x - 3)];

            from_mix +=
                fabs(here - (x == 6 ? 0.25 : 0.75) * first - (x == 6 ? 0.75 : 0.25) * second);
            from_first += abs(here - first);
        }
    assert_true(from_mix < from_first / 2);
}

TEST(fills_what_is_flat)
{
    static const struct scene scene = {.left = 1, .right = 3, .flat = 1};

    draw(&scene);
    run(NULL, NULL, REFOCUS_STACK_ALIGN_NONE);
    assert_true(right_share(&scene) > 0.98);
    assert_true(confidence[48 * W + 108] < 64);
    assert_int_equal(confidence[48 * W + 20], 255);
}

/* Waves of one code, in noise of one code, tell depth where no edge is near. */
TEST(takes_faint_texture_for_what_it_is)
{
    static const struct scene scene = {.left = 1, .right = 3, .faint = 0.07};
    int sure = 0, right = 0;

    draw(&scene);
    run(NULL, NULL, REFOCUS_STACK_ALIGN_NONE);
    for (int y = 8; y < H - 8; y++)
        for (int x = W - 40; x < W - 8; x++) {
            sure += confidence[y * W + x] > 200;
            right += fabs(disparity[y * W + x] / 65535.0 - 0.75) < 0.06;
        }
    assert_true(sure > 0.95 * 32 * (H - 16));
    assert_true(right > 0.98 * 32 * (H - 16));
}

TEST(makes_no_blob_of_a_lamp)
{
    static const struct scene scene = {.left = 1, .right = 3, .lamp = 1};

    draw(&scene);
    run(NULL, NULL, REFOCUS_STACK_ALIGN_NONE);
    assert_true(right_share(&scene) > 0.98);
}

/* The largest step of disparity between neighbours on the wall. */
static int largest_step_on_wall(void)
{
    int most = 0;

    for (int y = 1; y < H; y++)
        for (int x = WALL_LEFT + 12; x < WALL_RIGHT - 12; x++) {
            const int i = y * W + x;
            const int across = abs(disparity[i] - disparity[i - 1]);
            const int down = abs(disparity[i] - disparity[i - W]);

            most = across > most ? across : most;
            most = down > most ? down : most;
        }
    return most;
}

/* A wall between surfaces at the two ends of focus, clean or with noise: depth goes over from one
 * to the other without a step, whatever the noise looks like. */
TEST(is_smooth_where_nothing_is_measured)
{
    static const struct scene scenes[] = {
        {.left = 0, .right = 8, .wall = 1},
        {.left = 0, .right = 8, .wall = 1, .noise = 6},
        {.left = 0, .right = 8, .wall = 1, .noise = 16},
    };

    frames = MOST;
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        int sure = 0;

        draw(&scenes[i]);
        run(NULL, NULL, REFOCUS_STACK_ALIGN_NONE);
        assert_true(largest_step_on_wall() < 65535 / 32);
        for (int y = 0; y < H; y++)
            for (int x = WALL_LEFT + 12; x < WALL_RIGHT - 12; x++)
                sure += confidence[y * W + x] >= 64;
        assert_int_equal(sure, 0);
        assert_true(disparity[48 * W + 16] < 65535 / 20);
        assert_true(abs(disparity[48 * W + 128] - 65535) < 65535 / 20);
    }
    frames = FRAMES;
}

/* Noise is as sharp in each frame. */
TEST(takes_no_noise_for_texture)
{
    static const struct scene scene = {.left = 1, .right = 3, .flat = 1, .noise = 12};

    draw(&scene);
    run(NULL, NULL, REFOCUS_STACK_ALIGN_NONE);
    assert_true(right_share(&scene) > 0.98);
}

/* How many pixels on the left are a mix of two frames that differ there. */
static int mixed_of(int k, int l)
{
    int mixed = 0;

    for (int i = 0; i < 3 * PIXELS; i += 3) {
        const int a = frame[k][i], b = frame[l][i];
        const double share = (double)(photo[i] - b) / (a - b ? a - b : 1);

        mixed += i / 3 % W < W / 2 - 8 && abs(a - b) > 30 && share > 0.2 && share < 0.8;
    }
    return mixed;
}

/* A disc that walks is in the photo once, where the reference has it, and changes no depth where it
 * was in other frames. */
TEST(shows_what_moves_once)
{
    static const struct scene scene = {.left = 1, .right = 3, .walks = 1},
                              without = {.left = 1, .right = 3};
    struct refocus_stack_result result;
    int wrong = 0, right = 0;

    draw(&scene);
    result = run(NULL, NULL, REFOCUS_STACK_ALIGN_NONE);
    for (int i = 0; i < PIXELS; i++) {
        const int x = i % W, y = i / W;
        const int in_reference = (x - 72) * (x - 72) + (y - 48) * (y - 48) < 14 * 14;

        right += in_reference && abs(photo[3 * i] - 230) < 4;
        wrong += !in_reference && abs(x - W / 2) > 8 &&
                 fabs(photo[3 * i] - code_at(&without, x, y, x < W / 2 ? 1 : 3)) > 100;
    }
    assert_true(right > 590);
    assert_true(wrong < 40);
    assert_true(result.moving > 0.2f && result.moving < 0.9f);
    assert_true(mixed_of(1, 2) > 12); /* 1 where masks have hard borders */
    draw(&without);
    assert_true(run(NULL, NULL, REFOCUS_STACK_ALIGN_NONE).moving == 0);
}

TEST(says_when_frames_are_alike)
{
    struct refocus_stack_result result;

    for (int k = 0; k < FRAMES; k++)
        for (int i = 0; i < 3 * PIXELS; i++)
            frame[k][i] = (uint8_t)(i * 37 % 251);
    result = run(NULL, NULL, REFOCUS_STACK_ALIGN_SIMILARITY);
    assert_true(result.measured == 0);
    memset(frame, 90, sizeof frame);
    result = run(NULL, NULL, REFOCUS_STACK_ALIGN_SIMILARITY);
    assert_true(result.measured == 0);
    assert_true(result.moved == 0);
}

/* The bytes of a stack of noise, which no library of mathematics draws, by any number of threads.
 */
TEST(is_the_same_everywhere)
{
    uint32_t seed = 3;

    for (int k = 0; k < FRAMES; k++)
        for (int i = 0; i < 3 * PIXELS; i++) {
            const int other = k ? frame[k - 1][i] : 128;
            const int x = i / 3 % W / 36;

            frame[k][i] = (uint8_t)(x == k ? (int)(next(&seed) & 255) : (other * 3 + 128) / 4);
        }
    for (threads = 4; threads >= 0; threads--) {
        uint32_t hash = 2166136261u;

        run(NULL, NULL, REFOCUS_STACK_ALIGN_SIMILARITY);
        for (int i = 0; i < 3 * PIXELS; i++)
            hash = (hash ^ photo[i]) * 16777619u;
        for (int i = 0; i < PIXELS; i++)
            hash = (hash ^ disparity[i]) * 16777619u;
        assert_int_equal(hash, 0x1019da52);
    }
    threads = 0;
}

TEST(keeps_its_states)
{
    struct refocus_stack_params params = refocus_stack_params_default(W, H, 3);
    struct refocus_stack_result result = refocus_stack_result_default();
    const struct refocus_image image = image_of(0),
                               small = refocus_image_packed(REFOCUS_FORMAT_RGB8, frame[0], W - 1, H,
                                                            3 * W);
    struct refocus_stack *stack = NULL;

    params.reference = 3;
    assert_int_equal(refocus_stack_create(&stack, &params), REFOCUS_OK);
    assert_int_equal(refocus_stack_finish(stack, &result), REFOCUS_ERR_STATE);
    assert_int_equal(refocus_stack_add(stack, &image, 1), REFOCUS_OK);
    assert_int_equal(refocus_stack_finish(stack, &result), REFOCUS_ERR_STATE);
    assert_int_equal(refocus_stack_add(stack, &image, 1), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_stack_add(stack, &image, (double)NAN), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_stack_add(stack, &small, 2), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_stack_add(stack, &image, 2), REFOCUS_OK);
    assert_int_equal(refocus_stack_finish(stack, &result), REFOCUS_ERR_STATE);
    assert_int_equal(refocus_stack_add(stack, &image, 0), REFOCUS_OK);
    assert_int_equal(refocus_stack_add(stack, &image, 4), REFOCUS_ERR_STATE);
    assert_int_equal(refocus_stack_finish(stack, &result), REFOCUS_OK);
    assert_int_equal(refocus_stack_finish(stack, &result), REFOCUS_ERR_STATE);
    refocus_stack_destroy(&stack);
    /* Fewer frames than were announced. */
    params.frames = 8;
    assert_int_equal(refocus_stack_create(&stack, &params), REFOCUS_OK);
    for (int k = 0; k < 3; k++)
        assert_int_equal(refocus_stack_add(stack, &image, k), REFOCUS_OK);
    assert_int_equal(refocus_stack_finish(stack, &result), REFOCUS_OK);
    refocus_stack_destroy(&stack);
}

int main(void)
{
    make_waves();
    return unit_test_run(NULL, NULL);
}
