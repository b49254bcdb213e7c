/* test_stack_upsample.c: depth of samples that are several pixels wide becomes depth of pixels. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "unit_test.h"
#include "focus_stack/focus_stack.h"

enum { BY = 3, COLUMNS = 16, ROWS = 4, W = BY * COLUMNS, H = BY * ROWS, FRAMES = 5, SUB = 3 };

static uint8_t frame[3 * W * H], guide[3 * COLUMNS * ROWS], sure[COLUMNS * ROWS], sure_row[W];
static uint16_t depth[COLUMNS * ROWS], row[W];

/* A stack whose frames all show the same, and whose samples have their depth. */
static struct refocus_stack *make_stack(uint32_t kind)
{
    static struct refocus_stack stack;

    memset(&stack, 0, sizeof stack);
    stack.kind = kind;
    stack.width = W;
    stack.height = H;
    stack.reduced = stack.small_by = BY;
    stack.columns = COLUMNS;
    stack.rows = ROWS;
    stack.count = FRAMES;
    stack.sub = kind == REFOCUS_STACK_FOCUS ? SUB : 1;
    stack.guide = guide;
    stack.depth = depth;
    stack.sure = sure;
    for (int k = 0; k < FRAMES; k++) {
        stack.frame[k].rgb = frame;
        stack.frame[k].from_reference.c[0] = 1;
    }
    return &stack;
}

/* Samples left of a column have one colour, the rest another one. */
static void paint(int column)
{
    for (int i = 0; i < W * H; i++)
        memset(frame + 3 * i, i % W < BY * column ? 60 : 180, 3);
    for (int i = 0; i < COLUMNS * ROWS; i++)
        memset(guide + 3 * i, i % COLUMNS < column ? 60 : 180, 3);
}

/* Depth of a slope changes from pixel to pixel, not in blocks. */
TEST(slopes_are_smooth)
{
    static const uint32_t kinds[] = {REFOCUS_STACK_FOCUS, REFOCUS_STACK_APERTURE_NEAREST};

    paint(COLUMNS);
    for (size_t n = 0; n < sizeof kinds / sizeof *kinds; n++) {
        const struct refocus_stack *stack = make_stack(kinds[n]);

        for (int i = 0; i < COLUMNS * ROWS; i++)
            depth[i] = (uint16_t)(stack->sub * 60 * (i % COLUMNS));
        rf_stack_depth_row(stack, row, sure_row, H / 2);
        for (int x = BY; x < W - BY; x++)
            assert_in_range(row[x] - row[x - 1], 60 / BY - 1, 60 / BY + 1);
    }
}

/* A silhouette stays where the photo has it: no pixel has a depth between both surfaces. */
TEST(silhouettes_stay_sharp)
{
    const struct refocus_stack *stack = make_stack(REFOCUS_STACK_FOCUS);

    paint(COLUMNS / 2);
    /* A pixel of the samples left of the silhouette shows what is right of it. */
    for (int y = 0; y < H; y++)
        memset(frame + 3 * (y * W + W / 2 - 1), 180, 3);
    for (int i = 0; i < COLUMNS * ROWS; i++)
        depth[i] = i % COLUMNS < COLUMNS / 2 ? 0 : 256 * SUB * (FRAMES - 1);
    for (int y = 0; y < H; y++) {
        rf_stack_depth_row(stack, row, sure_row, y);
        assert_int_equal(row[W / 2 - 2], 0);
        assert_int_equal(row[W / 2 - 1], 256 * (FRAMES - 1));
        assert_int_equal(row[W / 2], 256 * (FRAMES - 1));
    }
}
