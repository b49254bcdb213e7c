/* test_temporal.c: the temporal filter of depth. */
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "unit_test.h"
#include <refocus/refocus.h>

#include "depth/temporal.h"

enum { W = 80, H = 60, SIDE = 20, SCALE = 4, NOISE = 900 };

struct video {
    uint16_t truth[W * H], map[W * H], out[W * H];
    uint8_t rgb[3 * W * SCALE * H * SCALE];
    uint32_t seed;
};
static struct video v;

static int noise(int most)
{
    v.seed = v.seed * 1664525u + 1013904223u;
    return (int)((v.seed >> 8) % (uint32_t)(2 * most + 1)) - most;
}

/* A near square at x before a far wall, both with texture of their own; noise on the map. */
static void draw(int x)
{
    for (int i = 0; i < W * H; i++) {
        const bool inside = i % W >= x && i % W < x + SIDE && i / W >= 15 && i / W < 15 + SIDE;

        v.truth[i] = inside ? 45000 : 12000;
        v.map[i] = (uint16_t)(v.truth[i] + noise(NOISE));
        for (int j = 0; j < SCALE * SCALE; j++) {
            const int px = i % W * SCALE + j % SCALE, py = i / W * SCALE + j / SCALE;
            const int u = inside ? i % W - x : i % W, t = inside ? 140 : 20;

            memset(v.rgb + 3 * (py * W * SCALE + px), t + (u * 37 + i / W * 61) % 60, 3);
        }
    }
}

static struct refocus_temporal *make(void)
{
    const struct refocus_temporal_params params = refocus_temporal_params_default(W, H);
    struct refocus_temporal *filter;

    assert_int_equal(refocus_temporal_create(&filter, &params), REFOCUS_OK);
    v.seed = 3;
    return filter;
}

static void run(struct refocus_temporal *filter, bool with_photo)
{
    const struct refocus_image photo =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, v.rgb, W * SCALE, H * SCALE, 3 * W * SCALE);
    const struct refocus_disparity map = refocus_disparity16(v.map, W, H, 2 * W);

    assert_int_equal(refocus_temporal_run(filter, with_photo ? &photo : NULL, &map, v.out, 2 * W),
                     REFOCUS_OK);
}

static double error_of(const uint16_t *map)
{
    double sum = 0;

    for (int i = 0; i < W * H; i++)
        sum += abs(map[i] - v.truth[i]);
    return sum / (W * H);
}

/* Noise falls by half or more where nothing moves, and edges stay where they are. */
TEST(calms)
{
    for (int with_photo = 0; with_photo < 2; with_photo++) {
        struct refocus_temporal *filter = make();

        for (int t = 0; t < 12; t++) {
            draw(30);
            run(filter, with_photo);
        }
        assert_true(error_of(v.out) < 0.5 * error_of(v.map));
        for (int i = 0; i < W * H; i++)
            assert_true(abs(v.out[i] - v.truth[i]) <= NOISE);
        refocus_temporal_destroy(&filter);
    }
}

/* A square that moves leaves nothing behind: no sample is ever of the wrong surface. */
TEST(leaves_no_ghosts)
{
    for (int with_photo = 0; with_photo < 2; with_photo++) {
        for (int speed = 1; speed <= 6; speed++) {
            struct refocus_temporal *filter = make();
            double calmer = 0;

            for (int t = 0; t < 8; t++) {
                draw(5 + t * speed);
                run(filter, with_photo);
                for (int i = 0; i < W * H; i++)
                    if (abs(v.out[i] - v.truth[i]) > 2 * NOISE)
                        fail_msg("photo %d, speed %d, frame %d: a ghost at %d, %d", with_photo,
                                 speed, t, i % W, i / W);
                calmer = error_of(v.out) / error_of(v.map);
            }
            assert_true(calmer < 0.6); /* followed, not just given up */
            refocus_temporal_destroy(&filter);
        }
    }
}

/* A sample that jumps while the photo stands still is not believed before six of seven looks agree;
 * a surface that does so is, a frame later. */
TEST(waits_for_more_looks)
{
    struct refocus_temporal *filter = make();

    for (int t = 0; t < 6; t++) {
        draw(30);
        if (t == 4)
            v.map[100] = 60000;
        run(filter, true);
        assert_true(abs(v.out[100] - 12000) <= NOISE);
    }
    for (int t = 0; t < 5; t++) {
        assert_true(abs(v.out[100] - 12000) <= NOISE);
        draw(30);
        v.map[100] = 60000;
        run(filter, true);
    }
    assert_int_equal(v.out[100], 60000);
    for (int t = 0; t < 2; t++) {
        draw(30);
        for (int i = 0; i < W * H; i++)
            if (i % W / 8 < 3 && i / W / 8 == 1)
                v.truth[i] = v.map[i] = (uint16_t)(v.map[i] + 20000);
        run(filter, true);
        for (int i = 0; i < W * H; i++)
            if (i % W / 8 < 3 && i / W / 8 == 1)
                assert_true(abs(v.out[i] - (t ? 32000 : 12000)) <= NOISE);
    }
    refocus_temporal_destroy(&filter);
}

/* Strength 0 changes nothing; neither does a reset filter in its first frame. */
TEST(can_be_off)
{
    struct refocus_temporal_params params = refocus_temporal_params_default(W, H);
    struct refocus_temporal *off, *on = make();

    params.strength = 0;
    assert_int_equal(refocus_temporal_create(&off, &params), REFOCUS_OK);
    for (int t = 0; t < 3; t++) {
        draw(10 + t);
        run(off, true);
        assert_memory_equal(v.out, v.map, sizeof v.out);
        refocus_temporal_reset(on);
        run(on, t % 2);
        assert_memory_equal(v.out, v.map, sizeof v.out);
    }
    refocus_temporal_destroy(&off);
    refocus_temporal_destroy(&on);
    refocus_temporal_destroy(&on);
}

/* One sample by the equation of the header: n stays where it can grow no more, and looks have no
 * vote where nothing jumps, though those before the climb are most alike. A jump is not
 * believed before the second frame. A change from depth to a photo that is as bright forgets the
 * past; another scale is rounded, and clamped. */
TEST(equation)
{
    const struct refocus_temporal_params params = refocus_temporal_params_default(1, 1);
    uint8_t grey[3];
    uint16_t d, p = 0;
    const struct refocus_image photo = refocus_image_packed(REFOCUS_FORMAT_RGB8, grey, 1, 1, 3);
    const struct refocus_disparity map = refocus_disparity16(&d, 1, 1, 2);
    struct refocus_temporal *filter;
    int n = 0;

    assert_int_equal(refocus_temporal_create(&filter, &params), REFOCUS_OK);
    for (int t = 0; t < 600; t++) {
        const int climbed = t < 19 ? 0 : t < 22 ? t - 19 : 3, last = p;
        const bool jumped = t == 300 || t == 400 || t == 401;
        double keep = n / (n + 1.0), apart;

        d = (uint16_t)(t < 400 ? 20000 + 1200 * climbed : 40000);
        d = (uint16_t)(jumped ? 40000 : d + (climbed == 3 ? t % 5 * 200 : 0));
        memset(grey, climbed == 1 || climbed == 2 ? 111 : 100, 3);
        assert_int_equal(refocus_temporal_run(filter, &photo, &map, &p, 2), REFOCUS_OK);
        keep = keep < 0.85 ? keep : 0.85;
        apart = (last - d) / (0.03 * 65535);
        keep = t ? d + keep * (1 - apart * apart) * (last - d) : d;
        if (jumped)
            assert_int_equal(p, t == 401 ? 40000 : last);
        else
            assert_in_range(p, (int)keep - 8, (int)keep + 8);
        n = t == 401 ? 2 : n + !jumped;
    }
    for (int with_photo = 0; with_photo < 2; with_photo++) {
        d = (uint16_t)(25601 + 100 * with_photo);
        assert_int_equal(refocus_temporal_run(filter, with_photo ? &photo : NULL, &map, &p, 2),
                         REFOCUS_OK);
        assert_int_equal(p, d);
    }
    assert_int_equal(refocus_temporal_rescale(filter, 0.5, 0), REFOCUS_OK);
    d = 12853; /* The past is 25701 / 2, to the nearest 12851: half of two less is dropped. */
    assert_int_equal(refocus_temporal_run(filter, &photo, &map, &p, 2), REFOCUS_OK);
    assert_int_equal(p, 12853);
    for (int offset = -1; offset <= 1; offset += 2) { /* 2/3 and 3/4 of 100 codes */
        assert_int_equal(refocus_temporal_rescale(filter, 1, offset), REFOCUS_OK);
        d = offset < 0 ? 100 : 65435;
        assert_int_equal(refocus_temporal_run(filter, &photo, &map, &p, 2), REFOCUS_OK);
        assert_int_equal(p, offset < 0 ? 34 : 65509);
    }
    refocus_temporal_destroy(&filter);
}

/* 8 bits, bottom-up rows, in place, and sizes down to one sample. */
TEST(any_layout)
{
    static const int sizes[][2] = {{1, 1}, {1, 9}, {9, 1}, {8, 8}, {17, 31}};

    for (int k = 0; k < 5; k++) {
        const int w = sizes[k][0], h = sizes[k][1];
        const struct refocus_temporal_params params = refocus_temporal_params_default(w, h);
        struct refocus_temporal *a, *b;
        uint8_t bytes[17 * 31], rgb[3 * 25] = {0};
        uint16_t out[17 * 31], other[17 * 31];
        const struct refocus_image photo = refocus_image_packed(REFOCUS_FORMAT_RGB8, rgb, 5, 5, 15);

        assert_int_equal(refocus_temporal_create(&a, &params), REFOCUS_OK);
        assert_int_equal(refocus_temporal_create(&b, &params), REFOCUS_OK);
        for (int t = 0; t < 5; t++) {
            struct refocus_disparity map = refocus_disparity8(bytes, w, h, w);

            for (int i = 0; i < w * h; i++) {
                const int at = (h - 1 - i / w) * w + i % w;

                bytes[i] = (uint8_t)(100 + noise(5));
                other[at] = (uint16_t)(bytes[i] * 257);
            }
            assert_int_equal(refocus_temporal_run(a, t % 2 ? &photo : NULL, &map, out, 2 * w),
                             REFOCUS_OK);
            map = refocus_disparity16(other + (h - 1) * w, w, h, -2 * w);
            assert_int_equal(
                refocus_temporal_run(b, t % 2 ? &photo : NULL, &map, other + (h - 1) * w, -2 * w),
                REFOCUS_OK);
            for (int y = 0; y < h; y++)
                assert_memory_equal(out + y * w, other + (h - 1 - y) * w, 2 * (size_t)w);
        }
        refocus_temporal_destroy(&a);
        refocus_temporal_destroy(&b);
    }
}

/* The guide for a photo is its brightness: where it is that of the grey photo, the maps are the
 * same, whatever U and V and lower bytes are. */
TEST(any_photo)
{
    enum { UPPER = __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ };
    static const struct {
        uint32_t format;
        int first, next, channels, step; /* bytes but for channels */
    } kinds[] = {{REFOCUS_FORMAT_NV12, 0, 0, 1, 1},      {REFOCUS_FORMAT_NV21, 0, 0, 1, 1},
                 {REFOCUS_FORMAT_I420, 0, 0, 1, 1},      {REFOCUS_FORMAT_YUYV, 0, 0, 1, 2},
                 {REFOCUS_FORMAT_P010, UPPER, 0, 1, 2},  {REFOCUS_FORMAT_P016, UPPER, 0, 1, 2},
                 {REFOCUS_FORMAT_RGB16, UPPER, 2, 3, 6}, {REFOCUS_FORMAT_RGBA16, UPPER, 2, 3, 8}};
    static uint8_t memory[8 * W * SCALE * H * SCALE];
    const int width = W * SCALE, height = H * SCALE;

    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        struct refocus_image photo = refocus_image_planar(kinds[k].format, memory, width, height);
        const struct refocus_disparity map = refocus_disparity16(v.map, W, H, 2 * W);
        struct refocus_temporal *filter = make(), *grey = make();
        static uint16_t out[W * H];

        for (int t = 0; t < 6; t++) {
            draw(20 + 3 * t);
            for (size_t i = 0; i < sizeof memory; i++)
                memory[i] = (uint8_t)noise(127);
            for (int i = 0; i < width * height; i++)
                for (int c = 0; c < kinds[k].channels; c++)
                    photo.plane[0][i / width * photo.stride[0] + i % width * kinds[k].step +
                                   c * kinds[k].next + kinds[k].first] = v.rgb[3 * i];
            run(grey, true);
            assert_int_equal(refocus_temporal_run(filter, &photo, &map, out, 2 * W), REFOCUS_OK);
            assert_memory_equal(out, v.out, sizeof out);
        }
        photo.plane[1] = NULL;
        assert_int_equal(refocus_temporal_run(filter, &photo, &map, out, 2 * W),
                         refocus_format_planes(kinds[k].format) == 1 ? REFOCUS_OK
                                                                     : REFOCUS_ERR_ARGUMENT);
        photo = refocus_image_planar(REFOCUS_FORMAT_RGBA_HALF, memory, width, height);
        assert_int_equal(refocus_temporal_run(filter, &photo, &map, out, 2 * W),
                         REFOCUS_ERR_UNSUPPORTED);
        refocus_temporal_destroy(&filter);
        refocus_temporal_destroy(&grey);
    }
}

/* A range that widens to twice what it was, after four frames: a filter that is told of it gives
 * the maps of one that has seen the new scale alone, to a code; one that is not told forgets. */
TEST(follows_the_range)
{
    for (int with_photo = 0; with_photo < 2; with_photo++) {
        struct refocus_temporal *told = make(), *narrow = make();
        uint16_t after[W * H];
        double calm;

        for (int t = 0; t < 8; t++) {
            v.seed = (uint32_t)t;
            draw(30);
            for (int i = 0; i < W * H; i++)
                v.map[i] = (uint16_t)(v.map[i] / 2 + 10000); /* disparity of the wider range */
            run(narrow, with_photo);
            memcpy(after, v.out, sizeof after);
            for (int i = 0; i < W * H && t < 4; i++)
                v.map[i] = (uint16_t)((v.map[i] - 10000) * 2);
            if (t == 4)
                assert_int_equal(refocus_temporal_rescale(told, 0.5, 10000 / 65535.0), REFOCUS_OK);
            run(told, with_photo);
        }
        calm = 0;
        for (int i = 0; i < W * H; i++)
            calm += abs(v.out[i] - after[i]);
        assert_true(calm / (W * H) < 40); /* the noise of a map is 225 */
        assert_int_equal(refocus_temporal_rescale(told, 1e9, 0), REFOCUS_OK); /* clamps */
        assert_int_equal(refocus_temporal_rescale(told, 0, 0), REFOCUS_ERR_ARGUMENT);
        assert_int_equal(refocus_temporal_rescale(told, 1.0 / 0.0, 0), REFOCUS_ERR_ARGUMENT);
        assert_int_equal(refocus_temporal_rescale(told, 1, 0.0 / 0.0), REFOCUS_ERR_ARGUMENT);
        assert_int_equal(refocus_temporal_rescale(NULL, 1, 0), REFOCUS_ERR_ARGUMENT);
        refocus_temporal_destroy(&told);
        refocus_temporal_destroy(&narrow);
    }
}

/* Without a photo depth is its own guide, of the new scale too: here the near half would else be
 * looked for on the far one, whose codes were what the near half's are now. */
TEST(guides_itself)
{
    const struct refocus_temporal_params params = refocus_temporal_params_default(16, 8);
    uint16_t d[16 * 8], out[16 * 8];
    const struct refocus_disparity map = refocus_disparity16(d, 16, 8, 32);
    struct refocus_temporal *filter;

    assert_int_equal(refocus_temporal_create(&filter, &params), REFOCUS_OK);
    for (int t = 0; t < 2; t++) {
        for (int i = 0; i < 16 * 8; i++)
            d[i] = (uint16_t)((i % 16 < 8 ? 40000 : 10000) / (t ? 4 : 1) + 100 * t);
        assert_int_equal(refocus_temporal_run(filter, NULL, &map, out, 32), REFOCUS_OK);
        assert_int_equal(refocus_temporal_rescale(filter, 0.25, 0), REFOCUS_OK);
    }
    for (int i = 0; i < 16 * 8; i++)
        assert_int_equal(out[i],
                         (i % 16 < 8 ? 10000 : 2500) + 51); /* half the way, but for 1 in 256 */
    refocus_temporal_destroy(&filter);
}

TEST(bad_arguments)
{
    struct refocus_temporal_params params = refocus_temporal_params_default(W, H), bad[9];
    struct refocus_temporal *filter;
    struct refocus_disparity map = refocus_disparity16(v.map, W, H, 2 * W);

    for (int i = 0; i < 9; i++)
        bad[i] = params;
    bad[0].struct_size = 1;
    bad[1].width = 0;
    bad[2].height = REFOCUS_MAX_SIDE + 1;
    bad[3].strength = 0.96f;
    bad[4].strength = -0.1f;
    bad[5].noise = 0.3f;
    bad[6].noise = (float)(0.0 / 0.0);
    bad[7].width = -4;
    bad[8].reserved = 1;
    for (int i = 0; i < 9; i++) {
        assert_int_equal(refocus_temporal_create(&filter, &bad[i]), REFOCUS_ERR_ARGUMENT);
        assert_null(filter);
    }
    assert_int_equal(refocus_temporal_create(NULL, &params), REFOCUS_ERR_ARGUMENT);
    filter = make();
    memset(v.out, 7, sizeof v.out);
    assert_int_equal(refocus_temporal_run(filter, NULL, NULL, v.out, 2 * W), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_temporal_run(filter, NULL, &map, v.out, 2 * W - 2),
                     REFOCUS_ERR_ARGUMENT);
    map.width = W - 1;
    assert_int_equal(refocus_temporal_run(filter, NULL, &map, v.out, 2 * W), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(v.out[0], 0x0707);
    refocus_temporal_destroy(&filter);
}

/* Noise that moved as a whole, which no search finds: a block knows of it by its own vector of the
 * last frame or by those of blocks that come before it, and by nothing that lies around the list.
 */
/* A landscape: a ramp with a hill at x, in codes times gain / 4. */
static void draw_hill(uint8_t *guide, int x, int gain)
{
    for (int i = 0; i < W * H; i++) {
        const int apart = abs(i % W - x) + abs(i / W - 30);

        guide[i] = (uint8_t)((10 + i / W / 2 + (apart < 30 ? 2 * (30 - apart) : 0)) * gain / 4);
    }
}

TEST(tells_cuts)
{
    static uint8_t a[W * H], b[W * H];

    draw_hill(a, 20, 4);
    draw_hill(b, 60, 4); /* another scene */
    assert_true(rf_is_cut(b, a, W, H));
    assert_false(rf_is_cut(a, a, W, H));
    draw_hill(b, 22, 4); /* movement by two samples a frame */
    assert_false(rf_is_cut(b, a, W, H));
    for (int gain = 2; gain <= 10; gain++) { /* exposures */
        draw_hill(b, 20, gain);
        assert_false(rf_is_cut(b, a, W, H));
        assert_false(rf_is_cut(a, b, W, H));
    }
    memset(b, 0, sizeof b); /* Black comes and goes. */
    assert_true(rf_is_cut(b, a, W, H));
    assert_true(rf_is_cut(a, b, W, H));
    for (int i = 0; i < W * H; i++) { /* noise before two walls of no contrast */
        a[i] = (uint8_t)(100 + noise(8));
        b[i] = (uint8_t)(100 + noise(8));
    }
    assert_false(rf_is_cut(b, a, W, H));
    assert_false(rf_is_cut((const uint8_t[]){0}, (const uint8_t[]){255}, 1, 1));
    assert_true(rf_is_cut((const uint8_t[]){0, 255}, (const uint8_t[]){255, 0}, 2, 1));
}

/* The first map after a cut is as it came, though much of the photo is as bright as it was. */
TEST(forgets_at_a_cut)
{
    struct refocus_temporal *filter = make();

    for (int frame = 0; frame < 8; frame++) {
        draw(5);
        run(filter, true);
    }
    draw(55);
    memmove(v.rgb, v.rgb + sizeof v.rgb / 4, sizeof v.rgb / 4 * 3);
    run(filter, true);
    assert_memory_equal(v.out, v.map, sizeof v.map);
    draw(55);
    memmove(v.rgb, v.rgb + sizeof v.rgb / 4, sizeof v.rgb / 4 * 3);
    run(filter, true);
    assert_memory_not_equal(v.out, v.map, sizeof v.map);
    refocus_temporal_destroy(&filter);
}

TEST(vectors_spread)
{
    enum { COLUMNS = W / RF_BLOCK, ROWS = (H + RF_BLOCK - 1) / RF_BLOCK, FIRST = 3 };
    static uint16_t near[2][W * H];
    static uint8_t guide[2][W * H];
    const struct rf_frame now = {near[0], guide[0], NULL}, last = {near[1], guide[1], NULL};
    const struct rf_motion moved = {7, 5};
    struct rf_motion list[(ROWS + 2) * COLUMNS], *const motion = list + COLUMNS;

    v.seed = 3;
    for (int i = 0; i < W * H; i++)
        guide[1][i] = (uint8_t)noise(127);
    for (int i = 0; i < W * H; i++)
        guide[0][i] = i % W < W - 7 && i / W < H - 5 ? guide[1][i + 5 * W + 7] : 0;
    for (int known = 0; known < 2; known++) {
        for (int i = 0; i < (ROWS + 2) * COLUMNS; i++)
            list[i] = moved;
        memset(motion, 0, ROWS * COLUMNS * sizeof *motion);
        if (known)
            motion[FIRST] = moved;
        rf_find_motion(motion, &now, &last, W, H, NULL);
        for (int i = 0; i < COLUMNS - 1; i++)
            assert_int_equal(motion[i].x == 7 && motion[i].y == 5, known && i >= FIRST);
        for (int y = 1; known && y < ROWS - 1; y++) /* leftwards from row to row */
            for (int i = FIRST - y > 0 ? FIRST - y : 0; i < COLUMNS - 1; i++)
                assert_true(motion[y * COLUMNS + i].x == 7 && motion[y * COLUMNS + i].y == 5);
    }
}

struct canceller {
    struct refocus_temporal *filter;
    int left, looks, after; /* looks before it cancels, all, and those after it */
};

static void cancel_later(void *user)
{
    struct canceller *const c = user;

    c->looks++;
    c->after += c->left < 0;
    if (--c->left == 0) {
        refocus_temporal_cancel(c->filter);
        c->left = -1;
    }
}

/* A cancelled run ends within eight rows, wherever it is: the looks are counted, not time. Nothing
 * is written, and the past is forgotten: the next map comes out as it is. */
TEST(is_cancelled)
{
    static uint16_t untouched[W * H];
    struct refocus_temporal *filter = make();
    struct canceller canceller = {filter, 0, 0, 0};
    struct rf_run *const looked_at = rf_run_of_temporal(filter);
    const struct refocus_image photo =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, v.rgb, W * SCALE, H * SCALE, 3 * W * SCALE);
    const struct refocus_disparity map = refocus_disparity16(v.map, W, H, 2 * W);
    int looks;

    memset(untouched, 0x5a, sizeof untouched);
    draw(30);
    run(filter, true);
    refocus_temporal_cancel(filter); /* nothing runs */
    looked_at->user = &canceller;
    looked_at->looked_at = cancel_later;
    draw(30);
    run(filter, true);
    assert_memory_not_equal(v.out, v.map, sizeof v.map);
    looks = canceller.looks;
    assert_in_range(looks, H + 2 * (H / RF_BLOCK), H + 2 * (H / RF_BLOCK + 2) + 1);
    for (int k = 1; k <= looks; k++) {
        draw(30);
        canceller = (struct canceller){filter, k, 0, 0};
        memset(v.out, 0x5a, sizeof v.out);
        assert_int_equal(refocus_temporal_run(filter, &photo, &map, v.out, 2 * W),
                         REFOCUS_ERR_CANCELLED);
        assert_in_range(canceller.after, 0, 2); /* Loops that do not begin. */
        assert_memory_equal(v.out, untouched, sizeof untouched);
        canceller.left = 0;
        run(filter, true);
        assert_memory_equal(v.out, v.map, sizeof v.map);
    }
    refocus_temporal_destroy(&filter);
}
