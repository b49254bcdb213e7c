/* test_slabs.c: slabs of a tile cover all blurs that reach it, and what is far out of focus shares
 * a slab with the same blurs in every tile. The number of
 * slabs is bounded, the more where they are noise. */
#include <stdint.h>
#include <stdlib.h>
#include "unit_test.h"
#include <stdbool.h>
#include <string.h>

#include "tiles/tiles.h"

enum { BLURS = 12, SETS = 400, MOST = 71 /* slabs of a tile with all blurs */ };

struct set {
    int16_t blur[BLURS];
    int count;
};

static uint32_t noise_bits(uint32_t *seed)
{
    *seed = *seed * 1664525 + 1013904223;
    return *seed >> 8;
}

/* The plan of a picture of one tile that has those bins. */
static void plan_bins(const struct rf_bins *bins, float largest, struct rf_tile_plan *plan)
{
    static struct rf_reach reach;
    const struct rf_bin_scale scale = rf_bin_scale_of(largest, 0);
    const struct rf_viewport view = {.width = RF_TILE,
                                     .height = RF_TILE,
                                     .photo_width = RF_TILE,
                                     .photo_height = RF_TILE,
                                     .tiles_x = 1,
                                     .tiles_y = 1,
                                     .pad = (int)largest + 2};

    rf_reach_init(&reach, scale, largest, view.pad, false);
    rf_plan_tile(&view, bins, &reach, 0, 0, plan);
    assert_in_range(plan->slabs, 1, RF_MAX_SLABS);
}

static void add_blur(struct rf_bins *bins, float largest, int blur)
{
    const struct rf_viewport view = {.tiles_x = 1, .tiles_y = 1};

    rf_add_bin(&view, bins, rf_bin_scale_of(largest, 0), 0, 0, (int16_t)blur);
}

/* The plan of a picture of one tile that has those blurs. */
static void plan_of(const struct set *set, float largest, struct rf_tile_plan *plan)
{
    struct rf_bins bins = {.least = INT16_MAX, .most = INT16_MIN};

    for (int i = 0; i < set->count; i++)
        add_blur(&bins, largest, set->blur[i]);
    plan_bins(&bins, largest, plan);
}

/* The slab that a blur belongs to: one before it may reach over it by an eighth. */
static int slab_of(const struct rf_tile_plan *plan, int16_t blur)
{
    for (int k = 0; k < plan->slabs; k++) {
        const int overlap = plan->slab[k].width / 10 > 32 ? plan->slab[k].width / 10 : 32;
        const int from = blur - plan->slab[k].low - overlap + 2;

        if (abs(blur) < 16 * 256 ? (uint16_t)(blur - plan->slab[k].low) <= plan->slab[k].width
                                 : from >= 0 && from <= plan->slab[k].width - 2 * overlap + 4)
            return k;
    }
    fail_msg("no slab covers a blur of %g", blur / 256.0);
    return -1;
}

/* Two blurs that are in either tile, with whatever else. */
static void expect_same(float largest, uint32_t seed)
{
    struct rf_tile_plan plan[2];
    struct set set[2] = {{.count = BLURS}, {.count = BLURS}};
    const int range = (int)(largest * 256);

    for (int i = 0; i < BLURS; i++)
        for (int k = 0; k < 2; k++) {
            set[k].blur[i] =
                (int16_t)((int)(noise_bits(&seed) % (uint32_t)(2 * range + 1)) - range);
            if (i < 2)
                set[k].blur[i] = set[0].blur[i];
        }
    /* the second one beside the first, 16 pixels out of focus and more, on either side of it */
    set[0].blur[0] =
        (int16_t)((16 * 256 + (int)(noise_bits(&seed) % (uint32_t)(range - 20 * 256))) *
                  (noise_bits(&seed) % 2 ? 1 : -1));
    set[0].blur[1] = (int16_t)(set[0].blur[0] + (set[0].blur[0] > 0 ? 512 : -512));
    set[1].blur[0] = set[0].blur[0];
    set[1].blur[1] = set[0].blur[1];
    for (int k = 0; k < 2; k++) {
        plan_of(&set[k], largest, &plan[k]);
        for (int i = 0; i < BLURS; i++)
            slab_of(&plan[k], set[k].blur[i]);
    }
    if ((slab_of(&plan[0], set[0].blur[0]) == slab_of(&plan[0], set[0].blur[1])) !=
        (slab_of(&plan[1], set[0].blur[0]) == slab_of(&plan[1], set[0].blur[1])))
        fail_msg("K = %g: blurs of %g and %g share a slab in one tile alone", (double)largest,
                 set[0].blur[0] / 256.0, set[0].blur[1] / 256.0);
}

TEST(same_slabs)
{
    for (uint32_t i = 0; i < SETS; i++) {
        expect_same(30, i);
        expect_same(60, i);
        expect_same(115, i);
    }
}

/* Blurs beyond 16 pixels share a slab with the same ones in a tile that has all of them: what is in
 * one slab does not occlude each other, so that the border of the tile would show. */
TEST(crowded_tiles)
{
    static const int K[] = {30, 60, 127};

    for (int i = 0; i < 3; i++) {
        const float largest = (float)K[i];
        struct rf_bins bins = {.least = INT16_MAX, .most = INT16_MIN};
        struct rf_tile_plan all, two;

        for (int blur = -128 * K[i]; blur <= 128 * K[i]; blur++)
            add_blur(&bins, largest, blur);
        plan_bins(&bins, largest, &all);
        for (int k = 0; k + 1 < all.slabs; k++) {
            const struct rf_slab slab = all.slab[k], next = all.slab[k + 1];
            const struct set within = {
                {(int16_t)(slab.low + slab.width / 4), (int16_t)(slab.low + slab.width / 4 * 3)},
                2};
            const struct set beside = {{slab.centre, next.centre}, 2};

            if (abs(slab.centre) < 18 * 256 || abs(next.centre) < 18 * 256)
                continue;
            plan_of(&within, largest, &two);
            assert_int_equal(two.slabs, 1);
            plan_of(&beside, largest, &two);
            assert_int_equal(two.slabs, 2);
        }
    }
}

/* The plan of a tile with all blurs from `least` to `most` and so much noise. Each blur is in a
 * slab, whose ends are not beyond 16 bits. Those that close cracks, which begin before the one that
 * they follow, are few, not counted, and take no blur from what is deeper. */
static int slabs_of_range(float largest, int least, int most, int16_t noise)
{
    struct rf_bins bins = {.least = INT16_MAX, .most = INT16_MIN};
    struct rf_tile_plan plan;
    int closing = 0;

    for (int blur = least; blur <= most; blur++)
        add_blur(&bins, largest, blur);
    bins.noise = noise;
    plan_bins(&bins, largest, &plan);
    for (int blur = least; blur <= most; blur++) {
        int k = 0;

        while (k < plan.slabs &&
               (blur < plan.slab[k].low || blur > plan.slab[k].low + plan.slab[k].width))
            k++;
        if (k == plan.slabs)
            fail_msg("no slab covers a blur of %g", blur / 256.0);
    }
    for (int k = 0; k < plan.slabs; k++) {
        assert_true(plan.slab[k].low + plan.slab[k].width <= INT16_MAX);
        if (k == 0 || plan.slab[k].low >= plan.slab[k - 1].low)
            continue;
        closing++;
        assert_int_equal(plan.slab[k].low + plan.slab[k].width,
                         plan.slab[k - 1].low + plan.slab[k - 1].width);
    }
    assert_in_range(closing, 0, 8);
    return plan.slabs - closing;
}

TEST(few_slabs)
{
    for (int K = 10; K <= 127; K += 9) {
        const float largest = (float)K;

        assert_in_range(slabs_of_range(largest, -128 * K, 128 * K, 0), 1, MOST);
        assert_in_range(slabs_of_range(largest, -256 * K, 0, 0), 1, MOST);
        assert_in_range(slabs_of_range(largest, 0, 256 * K, 0), 1, MOST);
        assert_in_range(slabs_of_range(largest, -128 * K, 128 * K, (int16_t)(256 * K)), 1, 11);
        assert_in_range(slabs_of_range(largest, -256 * K, 0, (int16_t)(256 * K)), 1, 11);
        assert_in_range(slabs_of_range(largest, 0, 256 * K, (int16_t)(256 * K)), 1, 11);
    }
    slabs_of_range(127, -127 * 256, -112 * 256, 0);
}

/* Rays test blurs against a slab modulo 2^16. Where a tile has blurs from -127 to 127 pixels none
 * may come round to a slab at the other end, which a slab of 20 pixels would let it. */
TEST(no_blur_comes_round)
{
    static const int noise[] = {0, 512, 2048, 32000};
    const int most = 127 * 256;

    for (size_t i = 0; i < sizeof noise / sizeof *noise; i++) {
        struct rf_bins bins = {.least = INT16_MAX, .most = INT16_MIN};
        struct rf_tile_plan plan;
        int round = 0;

        for (int blur = -most; blur <= most; blur++)
            add_blur(&bins, 127, blur);
        bins.noise = (int16_t)noise[i];
        plan_bins(&bins, 127, &plan);
        for (int k = 0; k < plan.slabs; k++)
            for (int blur = -most; blur <= most; blur++) {
                const int from = blur - plan.slab[k].low;

                round +=
                    (from < 0 || from > plan.slab[k].width) && (uint16_t)from <= plan.slab[k].width;
            }
        assert_int_equal(round, 0);
    }
}

/* Noise of two pixels around 8 is one slab; what is clean has slabs of a pixel. */
TEST(noise_is_merged)
{
    struct rf_bins bins = {.least = INT16_MAX, .most = INT16_MIN};
    struct rf_tile_plan plan;

    assert_int_equal(slabs_of_range(30, 7 * 256, 9 * 256, 256), 1);
    assert_int_equal(slabs_of_range(30, 7 * 256, 9 * 256, 0), 3);
    add_blur(&bins, 30, 7 * 256); /* a gap wider than a pixel ends a slab */
    add_blur(&bins, 30, 9 * 256);
    bins.noise = 1024;
    plan_bins(&bins, 30, &plan);
    assert_int_equal(plan.slabs, 2);
}

/* The plan of the first of two tiles side by side whose noise of `noise` pixels is around a blur
 * each. In the second one the surface of the first goes on above and for so many pixels. */
static void plan_corner(const int16_t middle[2], int noise, int corner, struct rf_tile_plan *plan)
{
    enum { WIDTH = 2 * RF_TILE, CELLS = WIDTH / RF_CELL };
    static struct rf_reach reach;
    const float largest = 30;
    const struct rf_bin_scale scale = rf_bin_scale_of(largest, 0);
    const struct rf_viewport view = {.width = WIDTH,
                                     .height = RF_TILE,
                                     .photo_width = WIDTH,
                                     .photo_height = RF_TILE,
                                     .tiles_x = 2,
                                     .tiles_y = 1,
                                     .pad = (int)largest + 2};
    int16_t blur[RF_TILE][WIDTH], least[CELLS * RF_TILE / RF_CELL], most[CELLS * RF_TILE / RF_CELL];
    const struct rf_cells cells = {least, most, CELLS};
    struct rf_bins bins[2];
    uint32_t seed = 1;

    for (size_t i = 0; i < sizeof least / sizeof *least; i++) {
        least[i] = INT16_MAX;
        most[i] = INT16_MIN;
    }
    for (int y = 0; y < RF_TILE; y++)
        for (int x = 0; x < WIDTH; x++) {
            const int off =
                (int)(noise_bits(&seed) % (uint32_t)(2 * noise * 256 + 1)) - noise * 256;

            blur[y][x] = (int16_t)(middle[x >= RF_TILE + corner && y >= corner] + off);
            rf_add_to_cell(&cells, x, y, blur[y][x]);
        }
    rf_bin_tiles(&view, scale, (struct rf_blur_q8){blur[0], WIDTH, 0}, &cells, bins, 0);
    rf_reach_init(&reach, scale, largest, view.pad, false);
    rf_plan_tile(&view, bins, &reach, 0, 0, plan);
}

static void plan_level(const int16_t middle[2], int noise, struct rf_tile_plan *plan)
{
    plan_corner(middle, noise, 0, plan);
}

/* A level surface with noise is one slab, and sharp in the focus; two that meet are two slabs. */
TEST(level_surfaces)
{
    static const int16_t sharp[2] = {20, -20}, blurred[2] = {6 * 256, 6 * 256};
    static const int16_t apart[2] = {0, 8 * 256};
    struct rf_tile_plan plan;

    plan_level(sharp, 3, &plan);
    assert_int_equal(plan.slabs, 1);
    assert_int_equal(plan.slab[0].centre, 0);
    assert_true(plan.sharp);
    plan_level(blurred, 3, &plan);
    assert_int_equal(plan.slabs, 1);
    assert_in_range(plan.slab[0].centre, 6 * 256 - 80, 6 * 256 + 80);
    assert_false(plan.sharp);
    plan_level(apart, 3, &plan);
    assert_int_equal(plan.slabs, 2);
    assert_int_equal(plan.slab[0].centre, 0);
    assert_in_range(plan.slab[1].centre, 8 * 256 - 80, 8 * 256 + 80);
}

/* So it is beside a tile whose blocks are cut by a silhouette, but for one. */
TEST(silhouettes_are_noisy)
{
    static const int16_t apart[2] = {0, 20 * 256};
    struct rf_tile_plan plan;

    plan_corner(apart, 3, RF_CELL, &plan);
    assert_int_equal(plan.slab[0].centre, 0);
    assert_true(plan.slab[0].low <= -3 * 256);
    assert_int_equal(plan.slabs, 2);
}
