/* test_depth_holes.c: holes at the border of a depth map, with a thin thing or a wide one beside.
 */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "unit_test.h"
#include <refocus/depth.h>

#include "depth/holes.h"

/* An eighth of the side is 30: a step of the whole range outweighs that many samples. */
enum { SIDE = 240, HOLE = 14, BEGIN = 60, END = 180, FAR = 2000 };

static uint16_t map[SIDE][SIDE];
static uint8_t state[SIDE][SIDE];

/* Sample `i` from border 0 to 3 on, `along` it. */
static void put(int border, int i, int along, uint16_t disparity, uint8_t known)
{
    const int from = border & 1 ? SIDE - 1 - i : i;
    const int x = border < 2 ? from : along, y = border < 2 ? along : from;

    map[y][x] = disparity;
    state[y][x] = known;
}

static uint16_t get(int border, int i, int along)
{
    const int from = border & 1 ? SIDE - 1 - i : i;

    return border < 2 ? map[along][from] : map[from][along];
}

/* A far surface, a hole along the border, and beside its middle a thing of this width. */
static void fill(int border, int width, uint16_t disparity, int gap)
{
    memset(state, RF_SAMPLE_KNOWN, sizeof state);
    for (int along = 0; along < SIDE; along++) {
        for (int i = 0; i < SIDE; i++) {
            const int is_thing =
                along >= BEGIN && along < END && i >= HOLE && i < HOLE + width - gap;
            const int is_gap =
                along >= BEGIN && along < END && i >= HOLE + width - gap && i < HOLE + width;

            put(border, i, along, is_thing ? disparity : FAR,
                i < HOLE || is_gap ? RF_SAMPLE_UNKNOWN : RF_SAMPLE_KNOWN);
        }
    }
    rf_fill_holes(map[0], sizeof map[0], SIDE, SIDE, state[0], NULL);
}

/* Samples of the hole at the middle of the thing that are nearer than the far surface. */
static int near_in_hole(int border)
{
    int count = 0;

    for (int i = 0; i < HOLE; i++)
        count += get(border, i, SIDE / 2) > FAR + FAR;
    return count;
}

/* A thing as wide as the hole is deep, or with a gap behind it, ends where it was measured. */
TEST(thin_things_end)
{
    for (int border = 0; border < 4; border++) {
        for (int gap = 0; gap <= 6; gap += 6) {
            fill(border, HOLE, 60000, gap);
            assert_int_equal(near_in_hole(border), 0);
            assert_int_equal(get(border, HOLE, SIDE / 2), 60000);
        }
        fill(border, 1, 60000, 0);
        assert_int_equal(near_in_hole(border), 0);
    }
}

/* A wider thing goes on to the border, and so does one that is nearer by less than half. */
TEST(wide_things_go_on)
{
    for (int border = 0; border < 4; border++) {
        fill(border, HOLE + 1, 60000, 0);
        assert_int_equal(near_in_hole(border), HOLE);
        fill(border, 4, FAR + 65535 / 2, 0);
        assert_int_equal(near_in_hole(border), HOLE);
        fill(border, 4, FAR + 65535 / 2 + 1, 0);
        assert_int_equal(near_in_hole(border), 0);
    }
}

/* Fills a hole along the border that ends at a far surface, and at a near one from the middle on.
 * Returns how far the far one goes before the near one, at the border itself. */
static int fill_beside_near(int border)
{
    int along = SIDE / 2;

    for (int at = 0; at < SIDE; at++)
        for (int i = 0; i < SIDE; i++)
            put(border, i, at, at < SIDE / 2 ? FAR : 62000,
                i < HOLE ? RF_SAMPLE_UNKNOWN : RF_SAMPLE_KNOWN);
    rf_fill_holes(map[0], sizeof map[0], SIDE, SIDE, state[0], NULL);
    while (along < SIDE - 1 && get(border, 0, along) < FAR + FAR)
        along++;
    return along - SIDE / 2;
}

/* Without an other side, a step of 60000 outweighs 30 / 4 * 60000 / 65535 = 6.9 samples, and the
 * way to the border is longer by half of what it goes to the side: 13 samples. */
TEST(surfaces_go_on_to_the_border)
{
    for (int border = 0; border < 4; border++)
        assert_in_range(fill_beside_near(border), 12, 14);
}

/* A dent of the hole at the top, between known samples of its rows, has nothing that the samples
 * above it do not have, however far what is left of them. */
TEST(dents_follow_what_is_above)
{
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            map[y][x] = x < 60 ? FAR : 42000;
            state[y][x] = y < (x < 60 ? 8 : 12) || (y < 14 && x >= 72 && x < 96) ? RF_SAMPLE_UNKNOWN
                                                                                 : RF_SAMPLE_KNOWN;
        }
    rf_fill_holes(map[0], sizeof map[0], SIDE, SIDE, state[0], NULL);
    for (int y = 12; y < 14; y++)
        for (int x = 72; x < 96; x++)
            assert_int_equal(map[y][x], 42000);
}

/* Lines without a known sample, and maps of one line, have nothing to look behind. */
TEST(lines_without_samples)
{
    memset(map, 0, sizeof map);
    memset(state, RF_SAMPLE_UNKNOWN, sizeof state);
    map[9][7] = 60000;
    state[9][7] = RF_SAMPLE_KNOWN;
    rf_fill_holes(map[0], sizeof map[0], SIDE, SIDE, state[0], NULL);
    for (int i = 0; i < SIDE * SIDE; i++)
        assert_int_equal(map[i / SIDE][i % SIDE], 60000);
    for (int x = 0; x < SIDE; x += 40) {
        memset(state[0], RF_SAMPLE_UNKNOWN, sizeof state[0]);
        state[0][x] = RF_SAMPLE_KNOWN;
        rf_fill_holes(map[0], sizeof map[0], SIDE, 1, state[0], NULL);
        assert_int_equal(map[0][SIDE - 1], 60000);
    }
}

/* A near square before a far surface, beside a strip of its far side that has no sample; of all
 * others so many percent have a value, by chance. */
static void fill_sparse(uint32_t percent, int strip)
{
    uint32_t random = 1;

    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            const int is_near = x >= BEGIN && x < END && y >= BEGIN && y < END;

            random = random * 1664525u + 1013904223u;
            map[y][x] = is_near ? 60000 : FAR;
            state[y][x] = (x >= BEGIN - strip && x < BEGIN) || (random >> 16) % 100 >= percent
                              ? RF_SAMPLE_UNKNOWN
                              : RF_SAMPLE_KNOWN;
        }
    rf_fill_holes(map[0], sizeof map[0], SIDE, SIDE, state[0], NULL);
}

/* The samples of sparse maps, as of a laser scanner, are taken for what is around them, near or
 * far, but holes are still farther. Gaps end two distances of samples off: 9.4 pixels with 5
 * percent.
 */
TEST(gaps_are_no_holes)
{
    enum { EDGE = 6, STRIP = 24 };

    for (uint32_t percent = 5; percent <= 40; percent += 5) {
        int near = 0;

        fill_sparse(percent, 0);
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++) {
                const int within =
                    x >= BEGIN + EDGE && x < END - EDGE && y >= BEGIN + EDGE && y < END - EDGE;
                const int beyond =
                    x < BEGIN - EDGE || x >= END + EDGE || y < BEGIN - EDGE || y >= END + EDGE;

                if (within)
                    assert_int_equal(map[y][x], 60000);
                else if (beyond)
                    assert_int_equal(map[y][x], FAR);
            }
        fill_sparse(percent, STRIP);
        for (int y = BEGIN + EDGE; y < END - EDGE; y++)
            for (int x = BEGIN - STRIP; x < BEGIN - 10; x++)
                near += map[y][x] != FAR;
        assert_in_range(near, 0, (END - BEGIN) * STRIP / 100); /* rows that begin in the strip */
    }
}

/* A map that is dense where it has any samples, a fifth of it, is no sparse one. */
TEST(parts_are_dense)
{
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            map[y][x] = x < 54 ? FAR : 62000;
            state[y][x] = x < 30 || (x >= 54 && x < 70) ? RF_SAMPLE_KNOWN : RF_SAMPLE_UNKNOWN;
        }
    rf_fill_holes(map[0], sizeof map[0], SIDE, SIDE, state[0], NULL);
    for (int y = 0; y < SIDE; y++)
        for (int x = 30; x < 54; x++)
            assert_int_equal(map[y][x], FAR);
}

/* A tilted, noisy floor with a round hole: inpainted near its plane, and rows inside do not
 * differ from those above and below more than the surface itself does. */
TEST(fill_leaves_no_streaks)
{
    enum { W = 160, H = 120, R = 24 };
    static uint16_t v[H][W], out[H][W];
    uint32_t seed = 1;
    double across = 0, along = 0;
    int worst = 0, n = 0;

    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            const int dx = x - W / 2, dy = y - H / 2;
            seed = seed * 1664525 + 1013904223;
            v[y][x] = (uint16_t)(20000 + 100 * y + 40 * x + (int)(seed >> 22) - 512);
            if (dx * dx + dy * dy < R * R)
                v[y][x] = 0;
        }
    struct refocus_depth_map given = refocus_depth_map_default();
    given.samples = v;
    given.sample = REFOCUS_SAMPLE_U16;
    given.width = W;
    given.height = H;
    given.stride = sizeof *v;
    given.flags = REFOCUS_DEPTH_ZERO_IS_UNKNOWN;
    given.value_near = 65535;
    assert_int_equal(refocus_depth_to_disparity(&given, out[0], sizeof *out, NULL), REFOCUS_OK);
    for (int y = 1; y < H; y++)
        for (int x = 1; x < W; x++) {
            if (v[y][x] != 0) {
                assert_int_equal(out[y][x], v[y][x]);
                continue;
            }
            const int error = abs(out[y][x] - (20000 + 100 * y + 40 * x));
            worst = error > worst ? error : worst;
            across += abs(out[y][x] - out[y - 1][x]);
            along += abs(out[y][x] - out[y][x - 1]);
            n++;
        }
    assert_true(n > 1700);
    assert_true(worst < 100 * R + 512); /* no farther off than its nearest edge and noise */
    assert_true(across / n < 200);      /* streaks: a mean step of some 340, the noise's */
    assert_true(along / n < 200);
}

enum { SILHOUETTE = 130, HOLE_FROM = 116, HOLE_TO = 136, ZOOM = 2 };

/* Fills a hole of which all but the last columns lie on a near surface of one code, that ends at
 * the silhouette before a far one of another. Returns where the far one begins in a row. */
static int silhouette_by(const struct refocus_repair_params *given, uint8_t near, uint8_t far)
{
    static uint16_t samples[SIDE][SIDE], out[SIDE][SIDE];
    static uint8_t rgb[SIDE * ZOOM][SIDE * ZOOM][3];
    const struct refocus_image photo =
        refocus_image_packed(REFOCUS_FORMAT_BGR8, rgb, SIDE * ZOOM, SIDE * ZOOM, sizeof rgb[0]);
    struct refocus_repair_params params = *given;
    struct refocus_depth_map given_map = refocus_depth_map_default();
    int x = 0;

    for (int y = 0; y < SIDE * ZOOM; y++)
        for (x = 0; x < SIDE * ZOOM; x++)
            memset(rgb[y][x], x < SILHOUETTE * ZOOM ? near : far, 3);
    for (int y = 0; y < SIDE; y++)
        for (x = 0; x < SIDE; x++)
            samples[y][x] = x >= HOLE_FROM && x < HOLE_TO && y > 80 && y < 160 ? 0
                            : x < SILHOUETTE                                   ? 50000
                                                                               : FAR;
    given_map.samples = samples;
    given_map.sample = REFOCUS_SAMPLE_U16;
    given_map.width = given_map.height = SIDE;
    given_map.stride = sizeof samples[0];
    given_map.flags = REFOCUS_DEPTH_ZERO_IS_UNKNOWN;
    given_map.value_near = 65535;
    params.photo = &photo;
    assert_int_equal(refocus_depth_repair(&given_map, &params, out[0], sizeof out[0], NULL),
                     REFOCUS_OK);
    for (x = 0; out[SIDE / 2][x] > 2 * FAR; x++) {
    }
    return x;
}

/* A hole is filled from the surface that looks like it, in memory of the caller as well; and from
 * the farther one where both look the same. */
TEST(photo_says_which_side)
{
    struct refocus_repair_params params = refocus_repair_params_default();
    const size_t photo_bytes = (size_t)6 * SIDE * SIDE;

    assert_int_equal(silhouette_by(&params, 200, 60), SILHOUETTE);
    assert_int_equal(silhouette_by(&params, 60, 200), SILHOUETTE);
    assert_int_equal(silhouette_by(&params, 100, 100), HOLE_FROM);
    params.speckle = 4;
    params.memory_bytes = (size_t)refocus_repair_memory(SIDE, SIDE, 4) + photo_bytes;
    params.memory = malloc(params.memory_bytes);
    assert_non_null(params.memory);
    assert_int_equal(silhouette_by(&params, 200, 60), SILHOUETTE);
    free(params.memory);
}
