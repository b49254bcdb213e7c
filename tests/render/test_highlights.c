/* test_highlights.c: which clipped things a fixed gain gives light to, and how much: things of
 * known light are drawn, and the light of their discs is measured with and without. */
#include "pictures.h"
#include "things.h"

enum { W = 160, H = 144, CX = W / 2, CY = H / 2 };
enum { BEHIND = 6554 }; /* 12 pixels of blur behind the focus at 0.5 */

/* [1 2 1] / 4 of n values `step` apart. */
static void soften_line(double *v, int n, int step)
{
    double before = v[0];

    for (int i = 0; i < n; i++) {
        const double own = v[i * step], after = v[(i + 1 < n ? i + 1 : i) * step];

        v[i * step] = (before + 2 * own + after) / 4;
        before = own;
    }
}

/* Draws a thing as a soft lens does, on black: before light above white is cut off. */
static void draw_soft(struct picture *p, const struct thing *t, double cx, double cy, int passes)
{
    const int w = p->width, h = p->height;
    double *share = calloc((size_t)w * (size_t)h, sizeof *share);

    assert_non_null(share);
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++)
            if (fabs(x - cx) < t->wide / 2 + 1 && fabs(y - cy) < t->high / 2 + 1)
                share[y * w + x] = share_of_thing(t, x - cx, y - cy);
    for (int i = 0; i < passes; i++) {
        for (int y = 0; y < h; y++)
            soften_line(share + y * w, w, 1);
        for (int x = 0; x < w; x++)
            soften_line(share + x, h, w);
    }
    for (int i = 0; i < 3 * w * h; i++)
        p->rgb[i] = picture_code(share[i / 3] * t->light[i % 3]);
    free(share);
}

/* Light of a channel in all of the picture, at a gain. */
static void render_light(struct refocus_renderer *renderer, int w, int h, float gain,
                         double light[3])
{
    uint8_t *out = malloc(3 * (size_t)w * (size_t)h);
    const struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, out, w, h, 3 * w);
    struct refocus_settings params = refocus_settings_default(0.5f, 30);

    assert_non_null(out);

    params.render.rays = 512;
    params.render.prefilter = 0;
    params.highlights.gain = gain;
    assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
    for (int c = 0; c < 3; c++) {
        light[c] = 0;
        for (int i = c; i < 3 * w * h; i += 3)
            light[c] += picture_light(out[i]);
    }
    free(out);
}

/* How many times as much light of each channel, at a gain of 4, what is drawn has. */
static void gained_in(const struct picture *p, double times[3])
{
    struct refocus_renderer *renderer = prepared(p, 30, 2);
    double with[3], without[3];

    render_light(renderer, p->width, p->height, 1, without);
    render_light(renderer, p->width, p->height, 4, with);
    for (int c = 0; c < 3; c++)
        times[c] = with[c] / without[c];
    refocus_renderer_destroy(&renderer);
}

static void gained(const struct thing *t, double times[3])
{
    struct picture p = picture_flat(W, H, (uint8_t[3]){0, 0, 0}, BEHIND);

    draw_thing(&p, t, CX + 0.3, CY - 0.2);
    gained_in(&p, times);
    picture_free(&p);
}

static double times_of(int kind, double wide, double high, double light)
{
    const struct thing t = {kind, wide, high, {light, light, light}};
    double times[3];

    gained(&t, times);
    return times[1];
}

static void expect(const char *what, double size, double times, double least, double most)
{
    if (times < least || times > most)
        fail_msg("%s of %g pixels has %.4f times its light, not %.4f to %.4f", what, size, times,
                 least, most);
}

/* Small lights get theirs back. Discs above white are cut, so small blurs are not looked at. */
TEST(highlights)
{
    static const double size[] = {2, 3, 5, 8, 12, 14};

    for (size_t i = 0; i < sizeof size / sizeof size[0]; i++) {
        expect("a round highlight", size[i], times_of(ELLIPSE, size[i], size[i], 12), 2.2, 4.05);
        expect("a flame", size[i], times_of(ELLIPSE, size[i] / 2 + 1, 1.5 * size[i], 12), 2.2,
               4.05);
    }
}

/* The larger something white is, the less likely it has lost much. */
TEST(large)
{
    static const int kind[] = {ELLIPSE, BOX, DIAMOND};

    for (size_t i = 0; i < sizeof kind / sizeof kind[0]; i++) {
        double before = 4.05;

        for (double size = 14; size < 80; size *= 1.3) {
            const double times = times_of(kind[i], size, size, 12);

            expect("something white", size, times, 0.99, before + 0.05);
            before = times;
        }
        expect("something large and white", 70, before, 0.99, 1.5);
    }
}

/* Photos that are larger have larger highlights, sharp and soft ones. Of the largest discs, which
 * 30 pixels of blur make little larger, much lies above white and is cut. A highlight that is much
 * smaller than a cell of the grid is known by its skirt alone. */
static double large_times(int cell, double size, double light, int soft)
{
    struct picture p = picture_flat(720 * cell, 160 * cell, (uint8_t[3]){0, 0, 0}, BEHIND);
    const struct thing t = {ELLIPSE, size, size, {light, light, light}};
    double times[3];

    draw_soft(&p, &t, 300 * cell + 0.3, 80 * cell - 0.2, soft);
    gained_in(&p, times);
    picture_free(&p);
    return times[1];
}

TEST(large_photos)
{
    for (int cell = 2; cell <= 4; cell *= 2)
        for (int soft = 0; soft <= 2 * cell; soft += cell) {
            expect("a small highlight of a large photo", 2 * cell,
                   large_times(cell, 2 * cell, 30, soft), soft ? 1.5 : 1, 4.05);
            expect("a highlight of a large photo", 9 * cell, large_times(cell, 9 * cell, 12, soft),
                   cell > 2 ? 1.6 : 2.2, 4.05);
            expect("a bright disc of a large photo", 60 * cell,
                   large_times(cell, 60 * cell, 12, soft), 0.99, 1.3);
        }
}

/* A wall that a highlight lights around it is not its edge. */
TEST(lit_walls)
{
    struct picture p = picture_flat(W, H, (uint8_t[3]){60, 60, 60}, BEHIND);
    const struct thing highlight = {ELLIPSE, 7, 7, {12, 12, 12}};
    double times[3];

    for (int i = 0; i < W * H; i++) {
        const double away = hypot(i % W - CX, (double)(i / W) - CY);

        memset(p.rgb + 3 * i, picture_code(0.04 + 0.75 / (1 + pow(away / 5, 2))), 3);
    }
    draw_thing(&p, &highlight, CX + 0.3, CY - 0.2);
    gained_in(&p, times);
    expect("a highlight that lights what is around it", 7, times[1], 1.02, 1.5);
    picture_free(&p);
}

/* A flame, and the wax that it lights: so bright near it that it is clipped too. */
static double candle_times(double light)
{
    struct picture p = picture_flat(W, H, (uint8_t[3]){30, 30, 30}, BEHIND);
    const struct thing flame = {ELLIPSE, 9, 18, {light, light, light}};
    const struct thing top = {ELLIPSE, 23, 4, {1.1, 1.1, 1.1}};
    const struct thing side = {BOX, 23, 40, {0.5, 0.5, 0.5}};
    double times[3];

    draw_thing(&p, &side, CX + 0.3, CY + 29);
    draw_thing(&p, &top, CX + 0.3, CY + 9);
    draw_thing(&p, &flame, CX + 0.3, CY - 0.2);
    gained_in(&p, times);
    picture_free(&p);
    return times[1];
}

TEST(candles)
{
    expect("a candle", 9, candle_times(3), 1.3, 2.5);
    expect("a candle", 9, candle_times(5), 1.3, 2.5);
}

/* A wire in focus, three pixels wide in the map, thinner in the picture, and a highlight of the
 * given disparity on it: light of the highlight at both sides of the wire. */
static struct picture wired(uint16_t disparity)
{
    struct picture p = picture_flat(W, H, (uint8_t[3]){20, 20, 20}, BEHIND);
    const struct thing highlight = {ELLIPSE, 9, 9, {12, 12, 12}};

    draw_thing(&p, &highlight, CX, CY);
    for (int y = CY - 5; y <= CY + 5; y++)
        for (int x = CX - 5; x <= CX + 5; x++)
            if (is_in_thing(&highlight, x - CX, (double)y - CY))
                p.disparity[y * W + x] = disparity;
    for (int x = 0; x < W; x++) {
        for (int y = CY - 1; y <= CY + 1; y++)
            if (p.disparity[y * W + x] < 32768)
                p.disparity[y * W + x] = 32768;
        memset(p.rgb + 3 * (CY * W + x), disparity < 32768 || abs(x - CX) > 5 ? 30 : 255, 3);
    }
    return p;
}

/* Blurs, Q7.8, of the pixels of the wire's upper row that the highlight crosses. */
static void expect_wire_blur(uint16_t disparity, int least, int most)
{
    static uint16_t blur[W * H];
    struct picture p = wired(disparity);
    struct refocus_renderer *renderer = prepared(&p, 30, 1);
    double light[3];

    render_light(renderer, W, H, 1, light);
    assert_int_equal(refocus_get_view(renderer, REFOCUS_VIEW_BLUR, blur, 2 * W), REFOCUS_OK);
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
    for (int x = CX - 5; x < CX + 5; x++)
        assert_in_range(blur[(CY - 1) * W + x], least, most);
}

TEST(wires)
{
    /* a highlight behind the wire is blurred as far as it is seen, one that hangs on it is sharp */
    expect_wire_blur(BEHIND, 11 * 256, 13 * 256);
    expect_wire_blur(32768, 0, 16);
}

/* A highlight far before the focus, whose edge the map gives to what is sharp behind it. However
 * little of the highlight a pixel of the edge holds, none is left as a dot: of each, how much
 * brighter than the pixels around it is counted. */
static int brightest_dot(double light)
{
    struct picture p = picture_flat(W, H, (uint8_t[3]){40, 40, 40}, 32768);
    const struct thing highlight = {ELLIPSE, 9, 9, {light, light, light}};
    static uint8_t out[3 * W * H];
    const struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, out, W, H, 3 * W);
    struct refocus_settings params = refocus_settings_default(0.5f, 30);
    struct refocus_renderer *renderer;
    int most = 0;

    draw_thing(&p, &highlight, CX + 0.3, CY - 0.2);
    for (int i = 0; i < W * H; i++)
        if (share_of_thing(&highlight, i % W - CX - 0.3, (double)(i / W) - CY + 0.2) >= 0.5)
            p.disparity[i] = 59000;
    renderer = prepared(&p, 30, 2);
    params.highlights.gain = 1;
    assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
    for (int y = CY - 20; y <= CY + 20; y++)
        for (int x = CX - 20; x <= CX + 20; x++) {
            int around = 0;

            for (int i = 0; i < 9; i++)
                around += out[3 * ((y + i / 3 - 1) * W + x + i % 3 - 1)];
            around = (around - out[3 * (y * W + x)]) / 8;
            around = out[3 * (y * W + x)] - around;
            most = around > most ? around : most;
        }
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
    return most;
}

TEST(silhouettes)
{
    for (double light = 1; light < 40; light *= 2) {
        const int dot = brightest_dot(light);

        if (dot > 36)
            fail_msg("of a highlight of %g times white a dot is left, brighter by %d codes", light,
                     dot);
    }
}

/* Longer than a highlight, but no wider. */
TEST(tubes)
{
    expect("a tube", 100, times_of(BOX, 100, 2.7, 12), 2, 4.05);
    expect("an upright tube", 100, times_of(BOX, 2.7, 100, 12), 2, 4.05);
}

/* A channel that is not clipped has lost nothing, and where one alone is clipped it has lost
 * nothing either; the rest is of the colour of the edge. */
TEST(colours)
{
    const struct thing green = {ELLIPSE, 7, 7, {0.3, 12, 0.5}};
    const struct thing amber = {ELLIPSE, 7, 7, {12, 6, 2.4}};
    double times[3];

    gained(&green, times);
    expect("red of a green highlight", 7, times[0], 0.99, 1.01);
    expect("green of a green highlight", 7, times[1], 0.99, 1.01);
    expect("blue of a green highlight", 7, times[2], 0.99, 1.01);
    gained(&amber, times);
    expect("red of an amber highlight", 7, times[0], 2.2, 4.05);
    expect("green of an amber highlight", 7, times[1] - 1, 0.3 * (times[0] - 1),
           0.95 * (times[0] - 1));
    expect("blue of an amber highlight", 7, times[2] - 1, 0.05 * (times[0] - 1),
           0.8 * (times[1] - 1));
}

/* A tail light: red alone is clipped in what glows around it, and gets nothing there. */
TEST(glows)
{
    const struct thing red = {ELLIPSE, 6, 6, {40, 6, 5}};
    struct picture p = picture_flat(W, H, (uint8_t[3]){0, 0, 0}, BEHIND);
    double times[3];

    for (int k = 0; k < W * H; k++) {
        const double away = hypot(k % W - CX, (double)(k / W) - CY), glow = exp(-away / 3.5);

        p.rgb[3 * k] = picture_code(0.003 + 6 * glow);
        p.rgb[3 * k + 1] = p.rgb[3 * k + 2] = picture_code(0.001 + 0.05 * glow);
    }
    draw_thing(&p, &red, CX + 0.3, CY - 0.2);
    gained_in(&p, times);
    expect("a tail light's red", 6, times[0], 1.2, 1.5);
    picture_free(&p);
}

/* Cyan among cyan is no highlight, however bright beside it; on something dark it may be one. */
TEST(petals)
{
    static const uint8_t among[][3] = {{60, 190, 200}, {20, 65, 70}};
    const struct thing petal = {ELLIPSE, 6, 6, {0.3, 3, 3}};

    for (int i = 0; i < 2; i++) {
        struct picture p = picture_flat(W, H, among[i], BEHIND);
        double times[3];

        draw_thing(&p, &petal, CX + 0.3, CY - 0.2);
        gained_in(&p, times);
        expect(i ? "a cyan highlight" : "a petal", 6, times[2], i ? 1.04 : 0.999, i ? 1.2 : 1.005);
        picture_free(&p);
    }
}

/* Highlights, tubes and signs anywhere, across the blocks of strip mode and each other. */
enum { NIGHT_W = 330, NIGHT_H = 290 };

/* Renders the night by a renderer for blurs up to `most`. */
static void render_night(const struct picture *p, float blur, float most, uint32_t in_place,
                         int threads, uint8_t *out)
{
    struct refocus_renderer_params limits =
        refocus_renderer_params_default(p->width, p->height, most);
    struct refocus_settings settings = refocus_settings_default(0.5f, blur);

    limits.threads = threads;
    limits.in_place = limits.highlights = in_place;
    settings.highlights.gain = 8;
    settings.render.rays = 24;
    render_once(&limits, p, &settings, out);
}

static void expect_same_night(uint32_t seed, int w, int h, float blur)
{
    struct picture p = night(seed, w, h);
    uint8_t *whole = malloc(3 * (size_t)w * (size_t)h), *is = malloc(3 * (size_t)w * (size_t)h);

    assert_non_null(whole);
    assert_non_null(is);
    render_night(&p, blur, blur, 0, 1, whole);
    render_night(&p, blur, blur, 0, 4, is);
    assert_same_pixels(is, whole, w, h, "highlights found by four threads");
    render_night(&p, blur, blur, 1, 1, is);
    assert_same_pixels(is, whole, w, h, "highlights found in blocks");
    render_night(&p, blur, 127, 0, 2, is);
    assert_same_pixels(is, whole, w, h, "highlights by a renderer for larger blurs");
    free(whole);
    free(is);
    picture_free(&p);
}

TEST(nights)
{
    for (uint32_t seed = 1; seed <= 6; seed++)
        expect_same_night(seed, NIGHT_W, NIGHT_H, 9);
    expect_same_night(7, 1441, 391, 9);
    expect_same_night(9, 1441, 391, 30);
    expect_same_night(8, 290, 2883, 9);
    expect_same_night(10, NIGHT_W, NIGHT_H, 40);
    expect_same_night(11, 290, 700, 90);
    expect_same_night(12, NIGHT_W, NIGHT_H, 4);
    expect_same_night(109, 333, 619,
                      120); /* windows from side to side, with all of their margins */
}
