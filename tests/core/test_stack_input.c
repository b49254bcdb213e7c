/* test_stack_input.c: focus stacks as they should not be: out of order, moved, of other places. */
#include <stdint.h>
#include "unit_test.h"
#include "stack_scene.h"

static const struct scene still = {.left = 1, .right = 3, .scale = 0.003};

static struct refocus_stack_result found(const int *order)
{
    struct refocus_stack_result result;

    order_by = REFOCUS_STACK_ORDER_FOUND;
    result = run(order, NULL, REFOCUS_STACK_ALIGN_SIMILARITY);
    order_by = REFOCUS_STACK_ORDER_ADDED;
    return result;
}

/* All orders of five frames give the same depth, or, where more pairs are turned, its reverse. */
TEST(finds_the_order)
{
    static const int five[][FRAMES] = {{0, 1, 2, 3, 4}, {3, 0, 4, 2, 1}, {1, 0, 2, 4, 3},
                                       {4, 3, 2, 1, 0}, {2, 4, 3, 0, 1}, {0, 4, 1, 3, 2}};

    draw(&still);
    for (size_t i = 0; i < sizeof five / sizeof *five; i++) {
        const struct refocus_stack_result result = found(five[i]);
        int pairs = 0;

        for (int a = 0; a < FRAMES; a++)
            for (int b = a + 1; b < FRAMES; b++)
                pairs += five[i][a] < five[i][b] ? 1 : -1;
        for (int k = 0; k < FRAMES; k++)
            assert_int_equal(five[i][result.order[k] - 1],
                             pairs > 0 || (pairs == 0 && five[i][result.order[0] - 1] == 0)
                                 ? k
                                 : FRAMES - 1 - k);
        assert_int_equal(result.order[FRAMES], 0);
        assert_int_equal(five[i][result.reference - 1], FRAMES / 2);
        assert_true(result.order_margin > 0.01f);
        assert_true(result.disorder < 0.05f);
        if (pairs > 0)
            assert_true(right_share(&still) > 0.98);
    }
    /* Frames with positions, and those whose order is not wanted, stay as they are. */
    assert_true(run(five[1], NULL, REFOCUS_STACK_ALIGN_NONE).order[1] == 2);
    assert_true(run(five[1], NULL, REFOCUS_STACK_ALIGN_NONE).order_margin == 1);
}

/* A surface at one depth says no more than which frames are as far from it. */
TEST(says_when_the_order_is_doubtful)
{
    static const struct scene plane = {.left = 2, .right = 2};
    static const int order[FRAMES] = {3, 0, 4, 2, 1};

    draw(&plane);
    assert_true(found(order).order_margin < 0.01f);
    memset(frame, 90, sizeof frame);
    assert_true(found(order).order_margin == 0);
    assert_true(found(order).measured == 0);
    frames = 2;
    draw(&(struct scene){.left = 0, .right = 1});
    assert_true(found(NULL).order_margin == 1);
    frames = FRAMES;
}

/* A hand that moves on by 15 % of the picture from frame to frame, and turns. */
TEST(follows_a_camera_that_moves)
{
    static const struct scene scenes[] = {{.left = 1, .right = 3, .shift_x = 14},
                                          {.left = 1, .right = 3, .shift_x = -22},
                                          {.left = 1, .right = 3, .shift_y = 11, .shift_x = 5},
                                          {.left = 1, .right = 3, .turn = 0.1},
                                          {.left = 1, .right = 3, .scale = 0.08}};

    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        struct refocus_stack_result result;

        draw(&scenes[i]);
        result = run(NULL, NULL, REFOCUS_STACK_ALIGN_SIMILARITY);
        assert_true(result.alike > 0.7f);
        assert_true(right_share(&scenes[i]) > 0.96);
        if (scenes[i].shift_y == 0 && scenes[i].shift_x != 0)
            assert_true(fabs((double)result.moved - fabs(2 * scenes[i].shift_x)) < 0.5);
    }
    assert_true(run(NULL, NULL, REFOCUS_STACK_ALIGN_NONE).alike < 0.5f);
    draw(&still);
    assert_true(run(NULL, NULL, REFOCUS_STACK_ALIGN_SIMILARITY).alike > 0.8f);
}

TEST(says_when_a_frame_shows_another_place)
{
    static const struct scene odd = {.left = 1, .right = 3, .odd = 1};
    struct refocus_stack_result result;

    draw(&odd);
    result = run(NULL, NULL, REFOCUS_STACK_ALIGN_SIMILARITY);
    assert_true(result.alike < 0.5f);
    assert_true(result.moved < 0.2 * W);
}

/* A frame gets a gain for each channel in light, by the curve of sRGB. */
static void expose(uint8_t *rgb, const double gain[3])
{
    for (int i = 0; i < 3 * PIXELS; i++) {
        const double code = rgb[i] / 255.0;
        const double light = code <= 0.04045 ? code / 12.92 : pow((code + 0.055) / 1.055, 2.4);
        const double now = light * gain[i % 3] < 1 ? light * gain[i % 3] : 1;

        rgb[i] =
            (uint8_t)(255 * (now <= 0.0031308 ? 12.92 * now : 1.055 * pow(now, 1 / 2.4) - 0.055) +
                      0.5);
    }
}

/* Few blocks of a picture are flat, or none: frames of other light and white are matched yet. */
TEST(matches_exposures_of_what_is_not_flat)
{
    static const struct {
        int flat;
        double gain[2][3]; /* the first and the last frame's */
        int matched;
        double most;
    } cases[] = {
        {1, {{0.95, 0.95, 0.95}, {1.1, 1.1, 1.1}}, 2, 1.1},
        {1, {{1.1, 1, 0.9}, {0.4, 0.45, 0.4}}, 2, 0.4},
        {0, {{0.7, 0.7, 0.7}, {0.8, 0.8, 0.8}}, 2, 0.7},
        {1, {{1, 1, 1}, {0.2, 0.2, 0.2}}, 0, 1}, /* too far away */
        {0, {{1, 1, 1}, {1, 1, 1}}, 0, 1},
    };

    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const struct scene scene = {.left = 1, .right = 3, .flat = cases[i].flat};
        struct refocus_stack_result result;

        draw(&scene);
        expose(frame[0], cases[i].gain[0]);
        expose(frame[FRAMES - 1], cases[i].gain[1]);
        result = run(NULL, NULL, REFOCUS_STACK_ALIGN_SIMILARITY);
        assert_int_equal(result.matched, cases[i].matched);
        assert_in_range(1000 * result.exposure, 1000 * cases[i].most - 20,
                        1000 * cases[i].most + 20);
        if (cases[i].most > 0.2 || !cases[i].matched)
            assert_true(result.moving < 0.1f || i == 3);
    }
}

int main(void)
{
    make_waves();
    return unit_test_run(NULL, NULL);
}
