/* test_stack_clipped.c: taps that are several pixels apart see a highlight alike, wherever it lies
 * between them. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "unit_test.h"
#include "focus_stack/focus_stack.h"

enum { W = 40, H = 30, LABELS = 8, NEAR = 40000, X = 17, Y = 13 };

static uint8_t rgb[3 * W * H];
static _Alignas(64) uint8_t cost[LABELS * W * H];
static uint16_t moved[W * H];

static struct rf_stack_clipped find(int reduced, int apart)
{
    static struct refocus_stack stack;
    struct rf_pool pool;
    struct rf_stack_clipped found;

    memset(&stack, 0, sizeof stack);
    stack.width = W;
    stack.height = H;
    stack.reduced = reduced;
    stack.columns = (W + reduced - 1) / reduced;
    stack.rows = (H + reduced - 1) / reduced;
    stack.moved = moved;
    stack.cost = cost;
    stack.pool = &pool;
    assert_int_equal(rf_pool_start(&pool, 1, NULL, NULL), 0);
    found = rf_stack_find_clipped(&stack, &(struct rf_stack_photo){rgb, 3 * W}, apart);
    rf_pool_end(&pool);
    return found;
}

/* One pixel is clipped in a channel; its sample is near, all others are far. */
static void paint(int reduced)
{
    memset(rgb, 100, sizeof rgb);
    memset(moved, 0, sizeof moved);
    rgb[3 * (Y * W + X) + 2] = 255;
    moved[Y / reduced * ((W + reduced - 1) / reduced) + X / reduced] = NEAR;
}

TEST(is_seen_by_any_lattice)
{
    paint(1);
    for (int apart = 1; apart <= 5; apart++) {
        const struct rf_stack_clipped found = find(1, apart);

        for (int phase = 0; phase < apart * apart; phase++) {
            int share = 0, taps = 0;

            for (int y = phase / apart; y < H; y += apart)
                for (int x = phase % apart; x < W; x += apart) {
                    share += found.share[y * W + x];
                    taps += found.disparity[y * W + x] == NEAR;
                }
            assert_int_equal(share, RF_STACK_CLIPPED / (apart * apart));
            assert_int_equal(taps, 1);
        }
    }
}

/* One pixel of the 4 x 4 of a sample is clipped, or of the 4 x 2 of that in the corner. */
TEST(samples_have_a_share)
{
    struct rf_stack_clipped found;

    paint(4);
    found = find(4, 4);
    assert_int_equal(found.share[Y / 4 * (W / 4) + X / 4], RF_STACK_CLIPPED / 16);
    assert_int_equal(found.share[Y / 4 * (W / 4) + X / 4 + 1], 0);
    memset(rgb, 100, sizeof rgb);
    memset(rgb + sizeof rgb - 3, 255, 3);
    found = find(4, 4);
    assert_int_equal(found.share[(H + 3) / 4 * (W / 4) - 1], RF_STACK_CLIPPED / 8);
}
