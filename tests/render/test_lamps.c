/* Which clipped things get light back, and how much: drawn ones of known light, measured in the
 * light of their discs with and without. */
#include "pictures.h"

enum { W = 160, H = 144, CX = W / 2, CY = H / 2 };
enum { BEHIND = 6554 }; /* 12 pixels of blur behind the focus at 0.5 */

static double light_of(uint8_t code)
{
    const double v = code / 255.0;

    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

static uint8_t code_of(double light)
{
    const double v = light <= 0.0031308 ? 12.92 * light : 1.055 * pow(light, 1 / 2.4) - 0.055;

    return (uint8_t)(255 * fmin(v, 1) + 0.5);
}

/* What is drawn: whether a point, relative to the middle, lies in it. */
struct thing {
    enum { ELLIPSE, BOX, DIAMOND } kind;
    double wide, high; /* of all of it */
    double light[3];
};

static bool is_in(const struct thing *t, double x, double y)
{
    x = fabs(x) / (t->wide / 2);
    y = fabs(y) / (t->high / 2);
    return t->kind == ELLIPSE ? x * x + y * y < 1 : t->kind == BOX ? x < 1 && y < 1 : x + y < 1;
}

/* Share of a pixel. */
static double share_in(const struct thing *t, double x, double y)
{
    enum { FINE = 16 };
    int count = 0;

    for (int i = 0; i < FINE * FINE; i++)
        count += is_in(t, x + (i % FINE + 0.5) / FINE, y + (double)(i / FINE + 0.5) / FINE);
    return count / (double)(FINE * FINE);
}

static void draw(struct picture *p, const struct thing *t, double cx, double cy)
{
    for (int y = 0; y < p->height; y++)
        for (int x = 0; x < p->width; x++) {
            const double share = fabs(x - cx) > t->wide / 2 + 1 || fabs(y - cy) > t->high / 2 + 1
                                     ? 0
                                     : share_in(t, x - cx, y - cy);

            for (int c = 0; c < 3 && share > 0; c++) {
                uint8_t *code = &p->rgb[3 * (y * p->width + x) + c];

                *code = code_of(share * t->light[c] + (1 - share) * light_of(*code));
            }
        }
}

/* Light of a channel in all of the picture, at a gain. */
static void render_light(struct refocus_renderer *renderer, float gain, double light[3])
{
    static uint8_t out[3 * W * H];
    const struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, out, W, H, 3 * W);
    struct refocus_render_params params = refocus_render_params_default(0.5f, 30);

    params.rays = 512;
    params.prefilter = 0;
    params.highlight_gain = gain;
    assert_int_equal(refocus_render(renderer, &params, &image), REFOCUS_OK);
    for (int c = 0; c < 3; c++) {
        light[c] = 0;
        for (int i = c; i < 3 * W * H; i += 3)
            light[c] += light_of(out[i]);
    }
}

/* How many times as much light of each channel, at a gain of 4, the disc of a thing has. */
static void gained(const struct thing *t, double times[3])
{
    struct picture p = picture_flat(W, H, (uint8_t[3]){0, 0, 0}, BEHIND);
    struct refocus_renderer *renderer;
    double with[3], without[3];

    draw(&p, t, CX + 0.3, CY - 0.2);
    renderer = prepared(&p, 30, 2);
    render_light(renderer, 1, without);
    render_light(renderer, 4, with);
    for (int c = 0; c < 3; c++)
        times[c] = with[c] / without[c];
    refocus_renderer_destroy(&renderer);
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
        fail_msg("%s of %g pixels has %.2f times its light, not %.2f to %.2f", what, size, times,
                 least, most);
}

/* Of every size up to RF_LAMP_SIDE. Discs above white are cut, so small blurs are not looked at. */
static void lamps(void **state)
{
    static const double size[] = {2, 3, 5, 8, 12, 14};

    (void)state;
    for (size_t i = 0; i < sizeof size / sizeof size[0]; i++) {
        expect("a round lamp", size[i], times_of(ELLIPSE, size[i], size[i], 12), 2.2, 4.05);
        expect("a flame", size[i], times_of(ELLIPSE, size[i] / 2 + 1, 1.5 * size[i], 12), 2.2,
               4.05);
    }
}

/* White paint is lit in part all along its edge. */
static void paint(void **state)
{
    static const double size[] = {3, 5, 8, 12, 18, 23};

    (void)state;
    for (size_t i = 0; i < sizeof size / sizeof size[0]; i++)
        expect("white paint", size[i], times_of(ELLIPSE, size[i], size[i], 1), 0.99, 1.2);
}

static void large(void **state)
{
    static const double size[] = {26, 32, 40, 60};

    (void)state;
    for (size_t i = 0; i < sizeof size / sizeof size[0]; i++) {
        expect("a bright disc", size[i], times_of(ELLIPSE, size[i], size[i], 12), 0.99, 1.05);
        expect("a bright box", size[i], times_of(BOX, size[i], size[i], 12), 0.99, 1.15);
        expect("a bright diamond", size[i], times_of(DIAMOND, size[i], size[i], 12), 0.99, 1.4);
    }
}

/* Longer than a lamp, but no wider. */
static void tubes(void **state)
{
    (void)state;
    expect("a tube", 100, times_of(BOX, 100, 2.7, 12), 2, 4.05);
    expect("an upright tube", 100, times_of(BOX, 2.7, 100, 12), 2, 4.05);
}

/* What is not clipped has lost nothing; the rest is of the colour of the rim. */
static void colours(void **state)
{
    const struct thing green = {ELLIPSE, 7, 7, {0.3, 12, 0.5}};
    const struct thing amber = {ELLIPSE, 7, 7, {12, 6, 2.4}};
    double times[3];

    (void)state;
    gained(&green, times);
    expect("red of a green lamp", 7, times[0], 0.99, 1.01);
    expect("green of a green lamp", 7, times[1], 2.2, 4.05);
    expect("blue of a green lamp", 7, times[2], 0.99, 1.01);
    gained(&amber, times);
    expect("red of an amber lamp", 7, times[0], 2.2, 4.05);
    expect("green of an amber lamp", 7, times[1] - 1, 0.3 * (times[0] - 1), 0.7 * (times[0] - 1));
    expect("blue of an amber lamp", 7, times[2] - 1, 0.05 * (times[0] - 1), 0.4 * (times[0] - 1));
}

/* Lamps, tubes and signs anywhere, across the blocks of strip mode and each other. */
enum { NIGHT_W = 330, NIGHT_H = 290 };

static struct picture night(uint32_t seed)
{
    struct picture p = picture_make(NIGHT_W, NIGHT_H, seed);

    for (int i = 0; i < 3 * NIGHT_W * NIGHT_H; i++)
        p.rgb[i] /= 5;
    for (int i = 0; i < 150; i++) {
        struct thing t = {.light = {8, 8, 8}};
        double x, y;

        seed = seed * 1664525 + 1013904223;
        t.kind = seed >> 8 & 1 ? ELLIPSE : seed >> 9 & 1 ? BOX : DIAMOND;
        t.wide = 1 + (seed >> 10 & 15);
        t.high = (seed >> 14 & 7) == 0 ? 70 : 1 + (seed >> 17 & 31);
        t.light[seed >> 22 & 1] = 0.6;
        seed = seed * 1664525 + 1013904223;
        x = (double)((seed >> 8) % NIGHT_W);
        y = (double)((seed >> 18) % NIGHT_H);
        draw(&p, &t, x, y);
    }
    return p;
}

static void render_night(const struct picture *p, uint32_t in_place, int threads, uint8_t *out)
{
    struct refocus_renderer_params limits = refocus_renderer_params_default(NIGHT_W, NIGHT_H, 9);
    const struct refocus_image photo = picture_image(p);
    const struct refocus_disparity disparity = picture_disparity(p);
    const struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, out, NIGHT_W, NIGHT_H, 3 * NIGHT_W);
    struct refocus_render_params params = refocus_render_params_default(0.5f, 9);
    struct refocus_renderer *renderer;

    limits.threads = threads;
    limits.in_place = in_place;
    params.highlight_gain = 8;
    params.rays = 24;
    assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_OK);
    assert_int_equal(refocus_prepare(renderer, &photo, &disparity), REFOCUS_OK);
    assert_int_equal(refocus_render(renderer, &params, &image), REFOCUS_OK);
    refocus_renderer_destroy(&renderer);
}

static void nights(void **state)
{
    static uint8_t whole[3 * NIGHT_W * NIGHT_H], is[3 * NIGHT_W * NIGHT_H];

    (void)state;
    for (uint32_t seed = 1; seed <= 6; seed++) {
        struct picture p = night(seed);

        render_night(&p, 0, 1, whole);
        render_night(&p, 0, 4, is);
        assert_same_pixels(is, whole, NIGHT_W, NIGHT_H, "lamps found by four threads");
        render_night(&p, 1, 1, is);
        assert_same_pixels(is, whole, NIGHT_W, NIGHT_H, "lamps found in blocks");
        picture_free(&p);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lamps),   cmocka_unit_test(paint),   cmocka_unit_test(large),
        cmocka_unit_test(tubes),   cmocka_unit_test(colours), cmocka_unit_test(nights),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
