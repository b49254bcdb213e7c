/* test_cut.c: the least cut against all cuts there are. */
#include <stdlib.h>
#include <string.h>
#include "unit_test.h"
#include "cut.h"

enum { W = 4, H = 3, PIXELS = W * H };

static const int dx[8] = {-1, 0, 1, -1, 1, -1, 0, 1}, dy[8] = {-1, -1, -1, 0, 0, 1, 1, 1};

static uint32_t state = 7;

static int32_t draw(int32_t below)
{
    state = state * 1664525 + 1013904223;
    return (int32_t)((state >> 8) % (uint32_t)below);
}

static void make(struct rf_cut *cut, int32_t most)
{
    assert_int_equal(rf_cut_reserve(cut, PIXELS), 0);
    cut->count = PIXELS;
    for (int i = 0; i < PIXELS; i++) {
        struct rf_cut_node *const node = &cut->nodes[i];

        node->terminal = draw(2 * most + 1) - most;
        for (int d = 0; d < 8; d++) {
            const int x = i % W + dx[d], y = i / W + dy[d];
            const int inside = x >= 0 && x < W && y >= 0 && y < H;

            node->neighbour[d] = inside ? y * W + x : -1;
            node->capacity[d] = inside ? draw(most / 2 + 1) : 0; /* one way each */
        }
    }
}

/* The cost of taking these pixels for the object. */
static int32_t cost(const struct rf_cut *cut, unsigned object)
{
    int32_t sum = 0;

    for (int i = 0; i < PIXELS; i++) {
        const struct rf_cut_node *const node = &cut->nodes[i];
        const int inside = object >> i & 1;

        sum += inside ? (node->terminal < 0 ? -node->terminal : 0)
                      : (node->terminal > 0 ? node->terminal : 0);
        for (int d = 0; d < 8 && inside; d++)
            if (node->neighbour[d] >= 0 && !(object >> node->neighbour[d] & 1))
                sum += node->capacity[d];
    }
    return sum;
}

TEST(test_least)
{
    struct rf_cut cut = {0}, kept = {0};

    for (int round = 0; round < 300; round++) {
        unsigned found = 0, smallest = ~0u;
        int32_t least = INT32_MAX;

        make(&cut, round % 3 == 0 ? 3 : 100);
        assert_int_equal(rf_cut_reserve(&kept, PIXELS), 0);
        memcpy(kept.nodes, cut.nodes, PIXELS * sizeof *cut.nodes);
        for (unsigned object = 0; object < 1u << PIXELS; object++) {
            const int32_t one = cost(&kept, object);

            if (one < least) {
                least = one;
                smallest = object;
            } else if (one == least) {
                smallest &= object; /* the least cuts are closed under intersection */
            }
        }
        rf_cut_solve(&cut);
        for (int i = 0; i < PIXELS; i++)
            found |= (unsigned)(rf_cut_inside(&cut, i) != 0) << i;
        assert_int_equal(cost(&kept, found), least);
        assert_int_equal(found, smallest);
    }
    rf_cut_free(&cut);
    rf_cut_free(&kept);
}

/* No single pixel makes it better, and it is no worse than the guess. */
TEST(test_settled)
{
    struct rf_cut cut = {0}, kept = {0};

    for (int round = 0; round < 300; round++) {
        const unsigned guess = (unsigned)draw(1 << PIXELS);
        unsigned found = 0;

        make(&cut, 100);
        for (int i = 0; i < PIXELS; i++) /* both ways the same, as in a picture */
            for (int d = 4; d < 8; d++)
                if (cut.nodes[i].neighbour[d] >= 0)
                    cut.nodes[cut.nodes[i].neighbour[d]].capacity[7 - d] = cut.nodes[i].capacity[d];
        assert_int_equal(rf_cut_reserve(&kept, PIXELS), 0);
        memcpy(kept.nodes, cut.nodes, PIXELS * sizeof *cut.nodes);
        for (int i = 0; i < PIXELS; i++)
            rf_cut_guess(&cut, i, guess >> i & 1);
        rf_cut_settle(&cut);
        for (int i = 0; i < PIXELS; i++)
            found |= (unsigned)(rf_cut_inside(&cut, i) != 0) << i;
        assert_true(cost(&kept, found) <= cost(&kept, guess));
        for (int i = 0; i < PIXELS; i++)
            assert_true(cost(&kept, found) <= cost(&kept, found ^ 1u << i));
    }
    rf_cut_free(&cut);
    rf_cut_free(&kept);
}
