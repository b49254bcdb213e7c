/* test_strokes.c: painting: what is selected, how it is filled, what undo leaves, what is
 * refused. */
#include "picture.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <refocus/platform/file.h>

enum { W = 320, H = 240 };
static struct refocus_image photo;

static struct refocus_strokes *begin(void)
{
    struct refocus_strokes *strokes;

    assert_int_equal(refocus_strokes_create(&strokes, &photo, NULL), REFOCUS_OK);
    return strokes;
}

/* Over the disc, without its edge. */
static const float over[] = {120, 120, 160, 90, 200, 120, 160, 150, 140, 120};
enum { OVER = sizeof over / sizeof *over / 2 };

TEST(test_selects_to_the_edge)
{
    struct refocus_strokes *strokes = begin();
    const uint16_t *d;
    int wrong = 0;

    paint(strokes, REFOCUS_STROKE_OBJECT, 16, 0.5f, over, OVER);
    d = refocus_strokes_disparity(strokes);
    for (int i = 0; i < W * H; i++)
        wrong += (d[i] != 0) != in_disc(i % W, i / W, W, H) || (d[i] != 0 && d[i] != 32768);
    assert_int_equal(wrong, 0);
    refocus_strokes_destroy(&strokes);
}

/* Strokes along the very sides of the picture select what lies there, and nothing at the other
 * side.
 */
TEST(test_along_sides)
{
    static const float paths[4][4] = {{W - 0.5f, 20, W - 0.5f, 60},
                                      {-0.5f, 20, -0.5f, 60},
                                      {20, H - 0.5f, 60, H - 0.5f},
                                      {20, -0.5f, 60, -0.5f}};

    for (int i = 0; i < 4; i++) {
        struct refocus_strokes *strokes = begin();
        const uint16_t *d = refocus_strokes_disparity(strokes);
        int near = 0, far = 0;

        paint(strokes, REFOCUS_STROKE_OBJECT, 9, 1, paths[i], 2);
        for (int p = 0; p < W * H; p++) {
            const int x = p % W, y = p / W;
            const int away = i == 0 ? W - 1 - x : i == 1 ? x : i == 2 ? H - 1 - y : y;

            near += d[p] && away < 9;
            far += d[p] && away > 30;
        }
        assert_in_range(near, 9 * 40, 9 * 60);
        assert_int_equal(far, 0);
        refocus_strokes_destroy(&strokes);
    }
}

/* Cut into segments or not, and with strokes dropped again between. */
TEST(test_segments_and_undo)
{
    static uint16_t expected[W * H], before[W * H];
    struct refocus_strokes *strokes = begin();
    const struct refocus_stroke object = make_stroke(REFOCUS_STROKE_OBJECT, 16, 0.5f);
    const float elsewhere[] = {20, 20, 60, 200}, edge[] = {160, 60};
    struct refocus_changed changed;

    paint(strokes, REFOCUS_STROKE_ALL, 1, 0.1f, NULL, 0);
    memcpy(before, refocus_strokes_disparity(strokes), sizeof before);
    paint(strokes, REFOCUS_STROKE_OBJECT, 16, 0.5f, over, OVER);
    memcpy(expected, refocus_strokes_disparity(strokes), sizeof expected);
    paint(strokes, REFOCUS_STROKE_LESS, 8, -1, edge, 1);
    paint(strokes, REFOCUS_STROKE_FILL, 1, 0.9f, NULL, 0);
    paint(strokes, REFOCUS_STROKE_MORE, 12, -1, elsewhere, 2);
    paint(strokes, REFOCUS_STROKE_BRUSH, 12, 1, elsewhere, 2);
    assert_memory_not_equal(refocus_strokes_disparity(strokes), expected, sizeof expected);
    for (int i = 0; i < 4; i++)
        assert_int_equal(refocus_strokes_undo(strokes, NULL), REFOCUS_OK);
    assert_memory_equal(refocus_strokes_disparity(strokes), expected, sizeof expected);
    assert_int_equal(refocus_strokes_undo(strokes, &changed), REFOCUS_OK);
    assert_memory_equal(refocus_strokes_disparity(strokes), before, sizeof before);
    assert_int_equal(changed.width, 2 * (H / 3) + 1);
    assert_int_equal(changed.height, 2 * (H / 3) + 1);
    assert_int_equal(refocus_strokes_begin(strokes, &object, NULL), REFOCUS_OK);
    for (int i = 0; i < OVER; i++)
        assert_int_equal(refocus_strokes_extend(strokes, over + 2 * i, 1, NULL), REFOCUS_OK);
    assert_memory_equal(refocus_strokes_disparity(strokes), expected, sizeof expected);
    while (refocus_strokes_count(strokes) > 0)
        assert_int_equal(refocus_strokes_undo(strokes, NULL), REFOCUS_OK);
    for (int i = 0; i < W * H; i++)
        assert_int_equal(refocus_strokes_disparity(strokes)[i], 0);
    assert_int_equal(refocus_strokes_undo(strokes, NULL), REFOCUS_ERR_STATE);
    refocus_strokes_destroy(&strokes);
}

/* All that differs from before lies in what was told to have changed. */
TEST(test_changed)
{
    static uint16_t before[W * H];
    struct refocus_strokes *strokes = begin();
    const struct refocus_stroke object = make_stroke(REFOCUS_STROKE_OBJECT, 16, 0.5f);

    assert_int_equal(refocus_strokes_begin(strokes, &object, NULL), REFOCUS_OK);
    for (int i = 0; i < OVER; i++) {
        struct refocus_changed c;
        int outside = 0;

        memcpy(before, refocus_strokes_disparity(strokes), sizeof before);
        assert_int_equal(refocus_strokes_extend(strokes, over + 2 * i, 1, &c), REFOCUS_OK);
        for (int p = 0; p < W * H; p++)
            outside +=
                before[p] != refocus_strokes_disparity(strokes)[p] &&
                !(p % W >= c.x && p % W < c.x + c.width && p / W >= c.y && p / W < c.y + c.height);
        assert_int_equal(outside, 0);
    }
    refocus_strokes_destroy(&strokes);
}

TEST(test_gradient)
{
    struct refocus_strokes *strokes = begin();
    struct refocus_stroke ground = make_stroke(REFOCUS_STROKE_ALL, 1, 0);
    const struct refocus_fill fills[] = {
        {REFOCUS_FILL_GRADIENT, 0.1f, 0.9f, 10, 60, 10, 200},
        {REFOCUS_FILL_GRADIENT, 1, 0, -300, 20.5f, 600, 19},
        {REFOCUS_FILL_GRADIENT, 0.25f, 0.75f, 160, 120, 161.5f, 121},
        {REFOCUS_FILL_GRADIENT, 1, 0.5f, 1048576, -1048576, -1048576, 1048576},
    };

    for (size_t i = 0; i < sizeof fills / sizeof *fills; i++) {
        const struct refocus_fill *const f = &fills[i];
        const double dx = (double)f->x1 - (double)f->x0, dy = (double)f->y1 - (double)f->y0;

        ground.fill = *f;
        assert_int_equal(refocus_strokes_begin(strokes, &ground, NULL), REFOCUS_OK);
        for (int p = 0; p < W * H; p++) {
            double t =
                ((p % W - (double)f->x0) * dx + (p / W - (double)f->y0) * dy) / (dx * dx + dy * dy);

            t = t < 0 ? 0 : t > 1 ? 1 : t;
            t = 65535 * ((double)f->d0 + t * ((double)f->d1 - (double)f->d0));
            assert_true(fabs(refocus_strokes_disparity(strokes)[p] - t) <= 1.02);
        }
    }
    refocus_strokes_destroy(&strokes);
}

static double to_segment(double x, double y, const float *a, const float *b)
{
    const double dx = (double)b[0] - (double)a[0], dy = (double)b[1] - (double)a[1];
    const double px = x - (double)a[0], py = y - (double)a[1];
    double t = dx * dx + dy * dy > 0 ? (px * dx + py * dy) / (dx * dx + dy * dy) : 0;

    t = t < 0 ? 0 : t > 1 ? 1 : t;
    return hypot(px - t * dx, py - t * dy);
}

TEST(test_brush)
{
    const float path[] = {10.25f, 20, 200, 31.5f, 200, 150, 319.5f, -0.5f, 30, 239, 30, 239};
    const float radii[] = {0.5f, 7.3f, 40};

    for (size_t i = 0; i < 3; i++) {
        struct refocus_strokes *strokes = begin();
        int wrong = 0;

        paint(strokes, REFOCUS_STROKE_BRUSH, radii[i], 1, path, 6);
        for (int p = 0; p < W * H; p++) {
            double least = INFINITY;

            for (int s = 0; s < 5; s++)
                least = fmin(least, to_segment(p % W, p / W, path + 2 * s, path + 2 * s + 2));
            if (fabs(least - (double)radii[i]) > 1e-3)
                wrong += (refocus_strokes_disparity(strokes)[p] != 0) != (least < (double)radii[i]);
        }
        assert_int_equal(wrong, 0);
        refocus_strokes_destroy(&strokes);
    }
}

TEST(test_base_and_selection)
{
    static uint16_t base[W * H];
    static uint8_t mask[64 * 48];
    struct refocus_strokes *strokes;
    const struct refocus_disparity map = refocus_disparity16(base, W, H, 2 * W);
    int wrong = 0;

    for (int i = 0; i < W * H; i++)
        base[i] = (uint16_t)i;
    assert_int_equal(refocus_strokes_create(&strokes, &photo, &map), REFOCUS_OK);
    assert_memory_equal(refocus_strokes_disparity(strokes), base, sizeof base);
    paint(strokes, REFOCUS_STROKE_OBJECT, 16, -1, over, OVER); /* selected, not filled */
    assert_memory_equal(refocus_strokes_disparity(strokes), base, sizeof base);
    assert_int_equal(refocus_strokes_selection(strokes, mask, 64, 48, 64), REFOCUS_OK);
    for (int i = 0; i < 64 * 48; i++)
        wrong += mask[i] != (in_disc(i % 64 * 5 + 2, i / 64 * 5 + 2, W, H) ? 255 : 0);
    assert_int_equal(wrong, 0);
    paint(strokes, REFOCUS_STROKE_FILL, 1, 1, NULL, 0);
    for (int i = 0; i < W * H; i++)
        wrong += refocus_strokes_disparity(strokes)[i] !=
                 (in_disc(i % W, i / W, W, H) ? 65535 : base[i]);
    assert_int_equal(wrong, 0);
    assert_int_equal(refocus_strokes_undo(strokes, NULL), REFOCUS_OK);
    assert_memory_equal(refocus_strokes_disparity(strokes), base, sizeof base);
    refocus_strokes_destroy(&strokes);
}

/* A photo gives equal depth in all formats and with its rows upside down in memory. */
TEST(test_formats)
{
    static uint8_t pixels[4 * W * H];
    struct refocus_strokes *strokes = begin();
    static uint16_t expected[W * H];

    paint(strokes, REFOCUS_STROKE_OBJECT, 16, 0.5f, over, OVER);
    memcpy(expected, refocus_strokes_disparity(strokes), sizeof expected);
    refocus_strokes_destroy(&strokes);
    for (uint32_t format = REFOCUS_FORMAT_RGB8; format <= REFOCUS_FORMAT_BGRA8; format++) {
        const int bytes = refocus_format_bytes(format);
        const int turned = format == REFOCUS_FORMAT_BGR8 || format == REFOCUS_FORMAT_BGRA8;
        struct refocus_image other = refocus_image_packed(
            format, pixels + (size_t)(H - 1) * (size_t)bytes * W, W, H, -bytes * W);

        for (int i = 0; i < W * H; i++)
            for (int c = 0; c < 3; c++)
                other.plane[0][i / W * other.stride[0] + i % W * bytes + c] =
                    photo.plane[0][3 * i + (turned ? 2 - c : c)];
        assert_int_equal(refocus_strokes_create(&strokes, &other, NULL), REFOCUS_OK);
        paint(strokes, REFOCUS_STROKE_OBJECT, 16, 0.5f, over, OVER);
        assert_memory_equal(refocus_strokes_disparity(strokes), expected, sizeof expected);
        refocus_strokes_destroy(&strokes);
    }
}

TEST(test_refusals)
{
    struct refocus_strokes *strokes = begin();
    const float nan_point[] = {NAN, 3}, out[] = {(float)W, 3}, in[] = {3, 3};
    struct refocus_stroke stroke = make_stroke(REFOCUS_STROKE_MORE, 3, 0);
    struct refocus_image bad = photo;

    assert_int_equal(refocus_strokes_begin(strokes, &stroke, NULL), REFOCUS_ERR_STATE);
    stroke.kind = REFOCUS_STROKE_FILL;
    assert_int_equal(refocus_strokes_begin(strokes, &stroke, NULL), REFOCUS_ERR_STATE);
    assert_int_equal(refocus_strokes_extend(strokes, in, 1, NULL), REFOCUS_ERR_STATE);
    stroke.kind = REFOCUS_STROKE_ALL;
    assert_int_equal(refocus_strokes_begin(strokes, &stroke, NULL), REFOCUS_OK);
    assert_int_equal(refocus_strokes_extend(strokes, in, 1, NULL), REFOCUS_ERR_STATE);
    stroke.kind = REFOCUS_STROKE_LESS;
    assert_int_equal(refocus_strokes_begin(strokes, &stroke, NULL), REFOCUS_ERR_STATE);
    for (int i = 0; i < 9; i++) {
        stroke = make_stroke(REFOCUS_STROKE_OBJECT, 3, 0.5f);
        if (i == 0)
            stroke.radius = 0.4f;
        if (i == 1)
            stroke.radius = NAN;
        if (i == 2)
            stroke.reach = 65;
        if (i == 3)
            stroke.fill.d0 = 1.01f;
        if (i == 4)
            stroke.kind = 6;
        if (i == 5)
            stroke.struct_size--;
        if (i == 6)
            stroke.fill.kind = 3;
        if (i == 7)
            stroke.fill.kind = REFOCUS_FILL_GRADIENT; /* between the same points */
        if (i == 8)
            stroke.radius = 4097;
        assert_int_equal(refocus_strokes_begin(strokes, &stroke, NULL), REFOCUS_ERR_ARGUMENT);
    }
    assert_int_equal(refocus_strokes_count(strokes), 1);
    paint(strokes, REFOCUS_STROKE_OBJECT, 3, 0.5f, NULL, 0);
    assert_int_equal(refocus_strokes_extend(strokes, nan_point, 1, NULL), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_strokes_extend(strokes, out, 1, NULL), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_strokes_extend(strokes, in, 0, NULL), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_strokes_undo(strokes, NULL), REFOCUS_OK);
    for (int i = 1; i < REFOCUS_MAX_STROKES; i++)
        paint(strokes, REFOCUS_STROKE_BRUSH, 1, 0.5f, NULL, 0);
    stroke = make_stroke(REFOCUS_STROKE_BRUSH, 1, 0.5f);
    assert_int_equal(refocus_strokes_begin(strokes, &stroke, NULL), REFOCUS_ERR_SIZE);
    refocus_strokes_destroy(&strokes);
    refocus_strokes_destroy(&strokes);
    bad.format = 99;
    assert_int_equal(refocus_strokes_create(&strokes, &bad, NULL), REFOCUS_ERR_ARGUMENT);
    assert_null(strokes);
}

/* A stroke is given out as far as the caller's struct goes. */
TEST(test_struct_sizes)
{
    struct newer {
        struct refocus_stroke known;
        uint32_t added, behind;
    } newer = {refocus_stroke_default(0, 1), 7, 9};
    const struct refocus_stroke given = make_stroke(REFOCUS_STROKE_BRUSH, 3, 0.5f);
    struct refocus_strokes *strokes = begin();
    struct newer first = newer, untouched;

    assert_int_equal(refocus_strokes_begin(strokes, &given, NULL), REFOCUS_OK);
    assert_int_equal(refocus_strokes_get(strokes, 0, &first.known, NULL, NULL), REFOCUS_OK);
    assert_memory_equal(&first.known, &given, sizeof given);
    assert_int_equal(first.added, 7);
    newer.known.struct_size = offsetof(struct newer, behind);
    assert_int_equal(refocus_strokes_get(strokes, 0, &newer.known, NULL, NULL), REFOCUS_OK);
    assert_int_equal(newer.known.struct_size, offsetof(struct newer, behind));
    assert_memory_equal(&newer.known.kind, &given.kind, sizeof given - sizeof given.struct_size);
    assert_true(newer.added == 0 && newer.behind == 9);
    for (int i = 0; i < 3; i++) {
        const float *points = NULL;

        memset(&newer, 0xa5, sizeof newer);
        newer.known.struct_size = (uint32_t[]){0, sizeof given - 1, REFOCUS_MAX_STRUCT_SIZE + 1}[i];
        untouched = newer;
        assert_int_equal(refocus_strokes_get(strokes, 0, &newer.known, &points, NULL),
                         REFOCUS_ERR_ARGUMENT);
        assert_memory_equal(&newer, &untouched, sizeof newer);
        assert_null(points);
    }
    refocus_strokes_destroy(&strokes);
}

/* In places where colours mix a selection is a matter of every bit: the same one on every
 * processor. */
TEST(test_same_everywhere)
{
    const float path[] = {60.3f, 170, 100.7f, 70.25f, 240, 60, 250.5f, 180};
    struct refocus_image noise = make_picture(W, H);
    struct refocus_stroke stroke = make_stroke(REFOCUS_STROKE_OBJECT, 9.3f, 0);
    struct refocus_strokes *strokes;
    uint64_t hash = UINT64_C(14695981039346656037);
    uint32_t state = 3;
    int inside = 0;

    for (int i = 0; i < 3 * W * H; i++) {
        state = state * 1664525 + 1013904223;
        noise.plane[0][i] =
            (uint8_t)((noise.plane[0][i] + 3 * (int)(state >> 26) + i / 3 % W / 2) / 3);
    }
    assert_int_equal(refocus_strokes_create(&strokes, &noise, NULL), REFOCUS_OK);
    stroke.fill = (struct refocus_fill){REFOCUS_FILL_GRADIENT, 0.2f, 0.7f, 3, 9, 300, 211};
    assert_int_equal(refocus_strokes_begin(strokes, &stroke, NULL), REFOCUS_OK);
    assert_int_equal(refocus_strokes_extend(strokes, path, 4, NULL), REFOCUS_OK);
    paint(strokes, REFOCUS_STROKE_BRUSH, 20.2f, 0.9f, path, 2);
    for (int i = 0; i < W * H; i++) {
        inside += refocus_strokes_disparity(strokes)[i] != 0;
        hash = (hash ^ refocus_strokes_disparity(strokes)[i]) * UINT64_C(1099511628211);
    }
    printf("%d pixels, hash %016llx\n", inside, (unsigned long long)hash);
    assert_true(inside > 1000 && inside < W * H / 2);
    assert_true(hash == UINT64_C(0x961a7c5f1af2b81c));
    refocus_strokes_destroy(&strokes);
    free(noise.plane[0]);
}

/* Pictures of a pixel, a row, a column. */
TEST(test_small)
{
    const int sizes[][2] = {{1, 1}, {1, 300}, {300, 1}, {2, 2}, {3, 7}};
    const float point[] = {0, 0};

    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        struct refocus_image small = make_picture(sizes[i][0], sizes[i][1]);
        struct refocus_strokes *strokes;

        assert_int_equal(refocus_strokes_create(&strokes, &small, NULL), REFOCUS_OK);
        paint(strokes, REFOCUS_STROKE_OBJECT, 2, 1, point, 1);
        assert_int_equal(refocus_strokes_disparity(strokes)[0], 65535);
        paint(strokes, REFOCUS_STROKE_LESS, 4096, -1, point, 1);
        assert_int_equal(refocus_strokes_disparity(strokes)[0], 0);
        assert_int_equal(refocus_strokes_undo(strokes, NULL), REFOCUS_OK);
        assert_int_equal(refocus_strokes_disparity(strokes)[0], 65535);
        refocus_strokes_destroy(&strokes);
        free(small.plane[0]);
    }
}

static bool is_figure(const struct refocus_depth_map *map, int x, int y)
{
    const uint16_t *const row =
        (const uint16_t *)(const void *)((const char *)map->samples + y * map->stride);

    return row[x] > 36000 && row[x] < 48000;
}

/* The count is over the 49 pixels around. */
static int figure_around(const struct refocus_depth_map *map, int x, int y)
{
    int count = 0;

    for (int i = 0; i < 49; i++)
        count += is_figure(map, x - 3 + i % 7, y - 3 + i / 7);
    return count;
}

/* The shipped scene: two strokes over the figure, against its exact disparities. */
TEST(test_scene)
{
    const char *const root = getenv("REFOCUS_SOURCE_ROOT");
    const float head[] = {262, 215, 320, 190, 380, 170, 460, 180, 480, 225, 400,
                          230, 400, 280, 400, 340, 400, 385, 340, 375, 450, 380};
    const float body[] = {250, 480, 300, 440, 400, 420, 500, 440, 560, 500, 450, 520,
                          300, 510, 220, 520, 200, 500, 250, 445, 300, 412, 345, 395,
                          455, 398, 510, 415, 550, 440, 580, 480, 585, 525};
    struct refocus_photo *scene = NULL, *depth = NULL;
    struct refocus_strokes *strokes;
    char path[4096];
    int both = 0, either = 0;

    snprintf(path, sizeof path, "%s/examples/data/portrait/allfocus.png", root ? root : ".");
    if (refocus_photo_read(&scene, path, NULL, NULL) == REFOCUS_ERR_UNSUPPORTED) {
        printf("SKIPPED: no PNG in this build\n");
        skip();
    }
    assert_non_null(scene);
    snprintf(path, sizeof path, "%s/examples/data/portrait/disparity.png", root ? root : ".");
    assert_int_equal(refocus_depth_read(&depth, path, NULL, 0, 0, NULL, NULL), REFOCUS_OK);
    assert_int_equal(refocus_strokes_create(&strokes, scene->image, NULL), REFOCUS_OK);
    paint(strokes, REFOCUS_STROKE_OBJECT, 14, 1, head, 11);
    paint(strokes, REFOCUS_STROKE_MORE, 16, -1, body, 17);
    for (int y = 3; y < scene->image->height - 3; y++) {
        for (int x = 3; x < scene->image->width - 3; x++) {
            const bool painted =
                refocus_strokes_disparity(strokes)[y * scene->image->width + x] != 0;
            const int around = figure_around(depth->depth, x, y);
            const bool figure = is_figure(depth->depth, x, y);

            if (figure && around < 25) /* a hair: not painted */
                continue;
            both += figure && painted;
            either += figure || painted;
        }
    }
    printf("figure: %.1f %% of either are in both\n", 100.0 * both / either);
    assert_true(both >= 0.93 * either);
    refocus_strokes_destroy(&strokes);
    refocus_photo_free(&scene);
    refocus_photo_free(&depth);
}

int main(void)
{
    int failed;

    photo = make_picture(W, H);
    failed = unit_test_run(NULL, NULL);
    free(photo.plane[0]);
    return failed;
}
