/* test_stack_white.c: what is clipped is white in the photo of a focus stack, and what is bright is
 * as bright as it was. */
#include <stdint.h>
#include "unit_test.h"
#include <refocus/stack.h>

enum { W = 64, H = 32, FRAMES = 2 };

static uint8_t frame[3 * W * H], photo[3 * W * H];

/* The photo of frames that are all alike. */
static void compose(void)
{
    struct refocus_stack_params params = refocus_stack_params_default(W, H, FRAMES);
    struct refocus_stack_result result = refocus_stack_result_default();
    struct refocus_image image = {.struct_size = sizeof image,
                                  .format = REFOCUS_FORMAT_RGB8,
                                  .width = W,
                                  .height = H,
                                  .plane = {frame},
                                  .stride = {3 * W}};
    struct refocus_stack *stack;

    assert_int_equal(refocus_stack_create(&stack, &params), REFOCUS_OK);
    for (int k = 0; k < FRAMES; k++)
        assert_int_equal(refocus_stack_add(stack, &image, k), REFOCUS_OK);
    result.photo = photo;
    result.photo_stride = 3 * W;
    assert_int_equal(refocus_stack_finish(stack, &result), REFOCUS_OK);
    refocus_stack_destroy(&stack);
}

/* Red is `most` and up to five codes less, green is 240, and blue is as red on the right. */
static void fill(int most)
{
    for (int i = 0; i < W * H; i++) {
        frame[3 * i] = (uint8_t)(most - i * 7 % 11 / 2);
        frame[3 * i + 1] = 240;
        frame[3 * i + 2] = (uint8_t)(i % W < W / 2 ? 10 : frame[3 * i]);
    }
}

TEST(clipped_is_white)
{
    fill(255); /* 250 to 255 */
    compose();
    for (int i = 0; i < W * H; i++) {
        assert_in_range(photo[3 * i], 254, 255);
        assert_int_equal(photo[3 * i + 1], 240);
        if (i % W >= W / 2)
            assert_in_range(photo[3 * i + 2], 254, 255);
        else
            assert_int_equal(photo[3 * i + 2], 10);
    }
}

TEST(paper_stays)
{
    fill(250); /* 245 to 250 */
    compose();
    assert_memory_equal(photo, frame, sizeof frame);
}

/* From 240 to 255, as before: it grows, by steps of three codes at the most. */
TEST(gradients_have_no_steps)
{
    for (int i = 0; i < 3 * W * H; i++)
        frame[i] = (uint8_t)(240 + i / 3 % W / 4);
    compose();
    for (int x = 1; x < W; x++)
        assert_in_range(photo[3 * x] - photo[3 * (x - 1)], 0, 3);
    assert_int_equal(photo[3 * (W - 1)], 255);
}
