/* test_scene.c: what refocus_prepare_scene() makes of a scene beyond a photo and its map. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "unit_test.h"
#include <refocus/refocus.h>

enum { WIDTH = 150, HEIGHT = 110, BLUR = 9 };

/* A disc before a wall, and a map of it that is soft and lies `off` pixels beside it. */
struct drawing {
    uint8_t pixels[4 * WIDTH * HEIGHT];
    uint16_t map[WIDTH * HEIGHT];
    struct refocus_image photo;
    struct refocus_disparity disparity;
};

static struct drawing drawing;

static void draw(uint32_t format, int columns, int rows, int off, int softness)
{
    struct drawing *d = &drawing;

    d->photo = refocus_image_planar(format, d->pixels, WIDTH, HEIGHT);
    d->disparity = refocus_disparity16(d->map, columns, rows, 2 * (ptrdiff_t)columns);
    for (int plane = 0; plane < refocus_format_planes(format); plane++) {
        const ptrdiff_t bytes = d->photo.stride[plane];
        const int rows_of = refocus_plane_rows(format, plane, HEIGHT);

        for (int i = 0; i < bytes * rows_of; i++) {
            const int x = (int)(i % bytes * WIDTH / bytes) - 75,
                      y = (int)(i / bytes) * HEIGHT / rows_of - 55;
            const int inside = x * x + y * y < 1200;

            d->photo.plane[plane][i] = (uint8_t)((plane ? 100 : inside ? 180 : 60) + i * 31 % 17);
        }
    }
    for (int i = 0; i < columns * rows; i++) {
        const int x = i % columns * WIDTH / columns - 75 - off,
                  y = i / columns * HEIGHT / rows - 55;
        const int by = (x * x + y * y - 1200) / 70; /* pixels from the edge, about */
        const int part = by < -softness ? -softness : by > softness ? softness : by;

        d->map[i] = (uint16_t)(30000 - 20000 * part / softness);
    }
}

static struct refocus_renderer *make_mode(uint32_t edges, int threads, uint32_t in_place)
{
    struct refocus_renderer_params params = refocus_renderer_params_default(WIDTH, HEIGHT, BLUR);
    struct refocus_renderer *renderer;

    params.depth_edges = edges;
    params.in_place = in_place;
    params.threads = threads;
    assert_int_equal(refocus_renderer_create(&renderer, &params), REFOCUS_OK);
    return renderer;
}

static struct refocus_renderer *make(uint32_t edges, int threads)
{
    return make_mode(edges, threads, 0);
}

static void take_view(struct refocus_renderer *renderer, uint16_t *view)
{
    assert_int_equal(refocus_get_view(renderer, REFOCUS_VIEW_DISPARITY, view, 2 * WIDTH),
                     REFOCUS_OK);
}

/* The disparities of refocus_depth_edges(), by any renderer, and its report. */
TEST(same_as_alone)
{
    static const uint32_t formats[] = {REFOCUS_FORMAT_RGB8, REFOCUS_FORMAT_BGRA8,
                                       REFOCUS_FORMAT_NV12, REFOCUS_FORMAT_I420,
                                       REFOCUS_FORMAT_YUYV};
    static const int sizes[][2] = {{WIDTH, HEIGHT}, {WIDTH / 2, HEIGHT / 2}, {40, 30}};
    static uint16_t alone[WIDTH * HEIGHT], view[WIDTH * HEIGHT], plain[WIDTH * HEIGHT];
    const struct refocus_depth_edges_params params = refocus_depth_edges_params_default();

    for (size_t f = 0; f < sizeof formats / sizeof *formats; f++)
        for (size_t s = 0; s < 3; s++)
            for (int soft = 1; soft <= 5; soft += 4) {
                struct refocus_depth_edges_report expected = refocus_depth_edges_report_default();
                struct refocus_depth_edges_report got = refocus_depth_edges_report_default();
                struct refocus_renderer *renderer = make(1, 1 + (int)s);
                struct refocus_scene scene =
                    refocus_scene_default(&drawing.photo, &drawing.disparity);

                draw(formats[f], sizes[s][0], sizes[s][1], soft == 5 ? 3 : 0, soft);
                assert_int_equal(refocus_depth_edges(&drawing.photo, &drawing.disparity, &params,
                                                     alone, 2 * WIDTH, &expected),
                                 REFOCUS_OK);
                scene.depth_edges = REFOCUS_DEPTH_EDGES_AUTO;
                assert_int_equal(refocus_prepare_scene(renderer, &scene), REFOCUS_OK);
                take_view(renderer, view);
                assert_memory_equal(view, alone, sizeof view);
                assert_int_equal(refocus_get_depth_edges(renderer, &got), REFOCUS_OK);
                assert_memory_equal(&got, &expected, sizeof got);
                scene.depth_edges = REFOCUS_DEPTH_EDGES_AS_GIVEN;
                assert_int_equal(refocus_prepare_scene(renderer, &scene), REFOCUS_OK);
                take_view(renderer, view);
                assert_int_equal(refocus_prepare(renderer, &drawing.photo, &drawing.disparity),
                                 REFOCUS_OK);
                take_view(renderer, plain);
                assert_memory_equal(view, plain, sizeof view);
                assert_int_equal(refocus_get_depth_edges(renderer, &got), REFOCUS_OK);
                assert_true(got.parted == 0 && got.changed == 0 && got.softness == 0);
                assert_true(soft == 1 || memcmp(view, alone, sizeof view) != 0);
                refocus_renderer_destroy(&renderer);
            }
}

/* A renderer is made for it. */
TEST(memory_for_edges)
{
    static const int sides[][2] = {{1, 1},   {1, 65535}, {65535, 1},
                                   {17, 33}, {720, 540}, {4000, 3000}};
    static const float blurs[] = {0, 20, 127};
    struct refocus_renderer *renderer = make(0, 1);
    struct refocus_scene scene = refocus_scene_default(&drawing.photo, &drawing.disparity);

    draw(REFOCUS_FORMAT_RGB8, WIDTH, HEIGHT, 0, 1);
    scene.depth_edges = REFOCUS_DEPTH_EDGES_AUTO;
    assert_int_equal(refocus_prepare_scene(renderer, &scene), REFOCUS_ERR_ARGUMENT);
    refocus_renderer_destroy(&renderer);
    renderer = make(REFOCUS_DEPTH_EDGES_AUTO, 1);
    scene.depth_edges = REFOCUS_DEPTH_EDGES_STEADY;
    assert_int_equal(refocus_prepare_scene(renderer, &scene), REFOCUS_ERR_ARGUMENT);
    refocus_renderer_destroy(&renderer);
    for (int i = 0; i < 6 * 3; i++) {
        const double w = sides[i / 3][0], h = sides[i / 3][1];
        struct refocus_renderer_params params =
            refocus_renderer_params_default(sides[i / 3][0], sides[i / 3][1], blurs[i % 3]);
        const double without = (double)refocus_renderer_memory(&params);
        const double most = 16 * (w + 128) * (h + 64) + 64 * (w + h) + 262144;

        params.depth_edges = 1;
        const double with = (double)refocus_renderer_memory(&params);
        if (with < without || with - without > most)
            fail_msg("%.0f x %.0f: %.0f bytes more, header %.0f", w, h, with - without, most);
        params.depth_edges = REFOCUS_DEPTH_EDGES_STEADY;
        assert_true((double)refocus_renderer_memory(&params) - with <= 4 * w * h + 256);
        params.in_place = 1;
        const double steady = (double)refocus_renderer_memory(&params);
        params.depth_edges = 1;
        const double strips = (double)refocus_renderer_memory(&params);
        params.depth_edges = 0;
        const double least = (double)refocus_renderer_memory(&params);
        assert_true(steady - strips <= 4 * w * h + 256);
        if (strips < least || strips - least > 32 * (w + 128) * (h + 64) + 262144)
            fail_msg("%.0f x %.0f: %.0f bytes more in strips", w, h, strips - least);
    }
}

/* Prepares the drawing; gives out its disparities, what was found, and a picture. */
static void prepare_and_render(struct refocus_renderer *renderer, uint32_t edges, uint16_t *view,
                               struct refocus_depth_edges_report *report, uint8_t *picture)
{
    struct refocus_scene scene = refocus_scene_default(&drawing.photo, &drawing.disparity);
    const struct refocus_image out =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, picture, WIDTH, HEIGHT, 3 * WIDTH);
    const struct refocus_render_params lens = refocus_render_params_default(0.3f, BLUR);

    *report = refocus_depth_edges_report_default();
    scene.depth_edges = edges;
    assert_int_equal(refocus_prepare_scene(renderer, &scene), REFOCUS_OK);
    assert_int_equal(refocus_get_depth_edges(renderer, report), REFOCUS_OK);
    assert_int_equal(refocus_render(renderer, &lens, &out), REFOCUS_OK);
    take_view(renderer, view);
}

/* Strip mode, here of several blocks, has the same bytes, frame after frame. */
TEST(same_in_strips)
{
    static const uint32_t formats[] = {REFOCUS_FORMAT_RGB8, REFOCUS_FORMAT_BGRA8};
    static uint16_t view[2][WIDTH * HEIGHT];
    static uint8_t picture[2][3 * WIDTH * HEIGHT];
    int placed = 0;

    for (uint32_t edges = REFOCUS_DEPTH_EDGES_AUTO; edges <= REFOCUS_DEPTH_EDGES_STEADY; edges++) {
        struct refocus_renderer *whole = make_mode(edges, 1, 0), *strips = make_mode(edges, 3, 1);

        for (int frame = 0; frame < 12; frame++) {
            struct refocus_depth_edges_report report[2];

            /* Sharp, soft and beside the photo by turns, and every fourth as it is given. */
            draw(formats[frame % 2], WIDTH, HEIGHT, frame % 3, frame % 3 ? 5 : 1);
            prepare_and_render(whole, frame % 4 == 3 ? 0 : edges, view[0], &report[0], picture[0]);
            prepare_and_render(strips, frame % 4 == 3 ? 0 : edges, view[1], &report[1], picture[1]);
            assert_memory_equal(&report[0], &report[1], sizeof report[0]);
            assert_memory_equal(view[0], view[1], sizeof view[0]);
            assert_memory_equal(picture[0], picture[1], sizeof picture[0]);
            placed += report[0].changed > 0;
        }
        refocus_renderer_destroy(&whole);
        refocus_renderer_destroy(&strips);
    }
    assert_true(placed >= 8);
}

/* Prepares the drawing and returns its disparities. */
static const uint16_t *prepared(uint32_t edges, const uint8_t *confidence, ptrdiff_t stride)
{
    static uint16_t view[WIDTH * HEIGHT];
    struct refocus_renderer *renderer = make(1, 2);
    struct refocus_scene scene = refocus_scene_default(&drawing.photo, &drawing.disparity);

    scene.depth_edges = edges;
    scene.confidence = confidence;
    scene.confidence_stride = stride;
    assert_int_equal(refocus_prepare_scene(renderer, &scene), REFOCUS_OK);
    take_view(renderer, view);
    refocus_renderer_destroy(&renderer);
    return view;
}

/* 3 x 3 samples on the disc that are no more than a guess, and wrong. */
static void spoil(uint8_t *confidence, int columns, int rows)
{
    memset(confidence, 255, (size_t)columns * (size_t)rows);
    for (int y = rows / 2 - 1; y <= rows / 2 + 1; y++)
        for (int x = columns / 2 - 1; x <= columns / 2 + 1; x++) {
            confidence[y * columns + x] = 0;
            drawing.map[y * columns + x] = 2000;
        }
}

TEST(guesses_count_least)
{
    static uint8_t confidence[WIDTH * HEIGHT];
    static uint16_t alone[WIDTH * HEIGHT], placed[WIDTH * HEIGHT], without[WIDTH * HEIGHT];
    const struct refocus_disparity upsampled = refocus_disparity16(alone, WIDTH, HEIGHT, 2 * WIDTH);
    const struct refocus_depth_edges_params params = refocus_depth_edges_params_default();
    struct refocus_upsample_params upsample = refocus_upsample_params_default();
    const int middle = HEIGHT / 2 * WIDTH + WIDTH / 2;
    const uint16_t *view;

    for (int columns = 50; columns <= WIDTH; columns += 25) {
        const int rows = columns * HEIGHT / WIDTH;

        draw(columns == 50 ? REFOCUS_FORMAT_NV12 : REFOCUS_FORMAT_RGB8, columns, rows, 0, 1);
        spoil(confidence, columns, rows);
        view = prepared(REFOCUS_DEPTH_EDGES_AUTO, confidence, columns);
        assert_in_range(view[middle], 45000, 55000);
        view = prepared(REFOCUS_DEPTH_EDGES_AUTO, NULL, 0);
        assert_true(view[middle] < 5000);
        if (columns == 50 || columns == WIDTH)
            continue;
        upsample.confidence = confidence;
        upsample.confidence_stride = columns;
        assert_int_equal(
            refocus_upsample(&drawing.photo, &drawing.disparity, &upsample, alone, 2 * WIDTH),
            REFOCUS_OK);
        view = prepared(REFOCUS_DEPTH_EDGES_AS_GIVEN, confidence, columns);
        assert_memory_equal(view, alone, sizeof alone);
        assert_int_equal(
            refocus_depth_edges(&drawing.photo, &upsampled, &params, placed, 2 * WIDTH, NULL),
            REFOCUS_OK);
        view = prepared(REFOCUS_DEPTH_EDGES_AUTO, confidence, columns);
        assert_memory_equal(view, placed, sizeof placed);
    }
    /* A map of the photo's size, all sure: nothing changes, whichever way its rows lie. */
    memcpy(without, prepared(REFOCUS_DEPTH_EDGES_AUTO, NULL, 0), sizeof without);
    memset(confidence, 255, sizeof confidence);
    view = prepared(REFOCUS_DEPTH_EDGES_AUTO, confidence + (HEIGHT - 1) * WIDTH, -WIDTH);
    assert_memory_equal(view, without, sizeof without);
}

/* A frame of a video: what is drawn moves `at` pixels to the right, and the photo gets noise. */
static void move_on(uint32_t format, int at, uint32_t seed)
{
    const int columns = drawing.disparity.width;

    for (int plane = 0; plane < refocus_format_planes(format); plane++) {
        const int bytes = (int)drawing.photo.stride[plane];

        for (int y = 0; y < refocus_plane_rows(format, plane, HEIGHT); y++) {
            uint8_t *row = drawing.photo.plane[plane] + y * bytes;

            memmove(row + at * bytes / WIDTH, row, (size_t)(bytes - at * bytes / WIDTH));
            for (int x = 0; x < bytes; x++) {
                seed = seed * 1664525 + 1013904223;
                row[x] = (uint8_t)(row[x] + (seed >> 24) % 13);
            }
        }
    }
    for (int y = 0; y < drawing.disparity.height; y++) {
        uint16_t *row = drawing.map + y * columns;

        memmove(row + at * columns / WIDTH, row,
                (size_t)(columns - at * columns / WIDTH) * sizeof *row);
    }
}

/* A soft disc. */
static void draw_frame(uint32_t format, int columns, int at, uint32_t seed)
{
    draw(format, columns, columns * HEIGHT / WIDTH, 0, 5);
    move_on(format, at, seed);
}

static void prepare_edges(struct refocus_renderer *renderer, uint32_t edges, uint16_t *view)
{
    struct refocus_scene scene = refocus_scene_default(&drawing.photo, &drawing.disparity);

    scene.depth_edges = edges;
    assert_int_equal(refocus_prepare_scene(renderer, &scene), REFOCUS_OK);
    take_view(renderer, view);
}

static int count_other(const uint16_t *a, const uint16_t *b)
{
    int count = 0;

    for (int i = 0; i < WIDTH * HEIGHT; i++)
        count += abs(a[i] - b[i]) > 1024;
    return count;
}

/* Noise of the photo turns no decision while the map stays, and what moves is as if it were alone.
 */
TEST(video_is_steady)
{
    static const uint32_t formats[] = {REFOCUS_FORMAT_RGB8, REFOCUS_FORMAT_NV12};
    static uint16_t first[WIDTH * HEIGHT], steady[WIDTH * HEIGHT], alone[WIDTH * HEIGHT];

    for (int run = 0; run < 4; run++) {
        const uint32_t format = formats[run % 2];
        const int columns = run < 2 ? WIDTH : WIDTH / 2;
        struct refocus_renderer *renderer = make(2, 2), *other = make(1, 1);
        int turned = 0;

        draw_frame(format, columns, 0, 1);
        prepare_edges(renderer, REFOCUS_DEPTH_EDGES_STEADY, first);
        prepare_edges(other, REFOCUS_DEPTH_EDGES_AUTO, alone);
        assert_memory_equal(first, alone, sizeof first);
        for (uint32_t frame = 2; frame < 8; frame++) {
            draw_frame(format, columns, 0, frame);
            prepare_edges(renderer, REFOCUS_DEPTH_EDGES_STEADY, steady);
            prepare_edges(other, REFOCUS_DEPTH_EDGES_AUTO, alone);
            assert_true(columns != WIDTH || count_other(steady, first) == 0);
            assert_true(count_other(steady, first) <= count_other(alone, first));
            turned += count_other(alone, first);
        }
        assert_true(columns != WIDTH || turned > 100);
        for (int at = 4; at <= 20; at += 4) {
            draw_frame(format, columns, at, 9);
            prepare_edges(renderer, REFOCUS_DEPTH_EDGES_STEADY, steady);
        }
        prepare_edges(other, REFOCUS_DEPTH_EDGES_AUTO, alone);
        assert_true(count_other(steady, alone) < WIDTH * HEIGHT / 20);
        /* Another scene between two frames, and nothing is left of the first. */
        prepare_edges(renderer, REFOCUS_DEPTH_EDGES_AS_GIVEN, steady);
        prepare_edges(renderer, REFOCUS_DEPTH_EDGES_STEADY, steady);
        assert_memory_equal(steady, alone, sizeof steady);
        refocus_renderer_destroy(&renderer);
        refocus_renderer_destroy(&other);
    }
}

/* The edge of a sharp map that lies 4 pixels beside the photo leaves nothing behind where it moves,
 * although the map itself stays there, be it that every other frame has the map of the one before.
 * Where the edge moves along itself up to 21 pixels stay; 1904 did when all were kept. */
TEST(video_moves)
{
    static uint16_t steady[WIDTH * HEIGHT], alone[WIDTH * HEIGHT];
    struct refocus_renderer *renderer = make(2, 2), *other = make(1, 1);

    for (int at = 0; at <= 12; at++) {
        draw(REFOCUS_FORMAT_RGB8, WIDTH, HEIGHT, at >= 6 && at % 2 ? 3 : 4, 1);
        move_on(REFOCUS_FORMAT_RGB8, at, 3);
        prepare_edges(renderer, REFOCUS_DEPTH_EDGES_STEADY, steady);
        prepare_edges(other, REFOCUS_DEPTH_EDGES_AUTO, alone);
        assert_true(count_other(alone, drawing.map) > 200);
        assert_in_range(count_other(steady, alone), 0, 32);
    }
    refocus_renderer_destroy(&renderer);
    refocus_renderer_destroy(&other);
}

/* Pictures of all sizes through one renderer: nothing stays of the one before. */
TEST(one_after_the_other)
{
    static uint8_t first[3 * WIDTH * HEIGHT], again[3 * WIDTH * HEIGHT];
    const struct refocus_image out =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, first, WIDTH, HEIGHT, 3 * WIDTH);
    const struct refocus_render_params lens = refocus_render_params_default(0.3f, BLUR);
    struct refocus_renderer *renderer = make(1, 2);
    struct refocus_scene scene = refocus_scene_default(&drawing.photo, &drawing.disparity);

    for (int turn = 0; turn < 2; turn++) {
        draw(REFOCUS_FORMAT_RGB8, 60, 44, 2, 4);
        scene.depth_edges = REFOCUS_DEPTH_EDGES_AUTO;
        assert_int_equal(refocus_prepare_scene(renderer, &scene), REFOCUS_OK);
        assert_int_equal(refocus_render(renderer, &lens, &out), REFOCUS_OK);
        if (turn)
            assert_memory_equal(first, again, sizeof first);
        memcpy(again, first, sizeof first);
        draw(REFOCUS_FORMAT_RGB8, WIDTH, HEIGHT, 0, 1);
        scene.depth_edges = REFOCUS_DEPTH_EDGES_AS_GIVEN;
        assert_int_equal(refocus_prepare_scene(renderer, &scene), REFOCUS_OK);
        assert_int_equal(refocus_render(renderer, &lens, &out), REFOCUS_OK);
    }
    refocus_renderer_destroy(&renderer);
}
