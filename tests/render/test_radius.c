/* test_radius.c: blurs of more than 127 pixels, which are stored in units of two pixels and more:
 * strips, regions, threads and instruction sets yield the same bytes; discs of highlights are even;
 * and what is no method of such blurs says so. */
#include "yuv_pictures.h"

enum { WIDTH = 410, HEIGHT = 190 };

static const struct {
    float focus, blur;
} lenses[] = {{0.9f, 128}, {0.4f, 236}, {0, 300}, {1, 512}, {0.7f, 944}};
enum { LENSES = sizeof lenses / sizeof lenses[0] };

static struct refocus_settings settings_of(int lens, bool gathers)
{
    struct refocus_settings s = refocus_settings_default(lenses[lens].focus, lenses[lens].blur);

    s.render.rays = 32;
    s.highlights.gain = 4;
    if (gathers)
        s.look.cat_eye = 0.5f; /* then highlights are not splatted */
    return s;
}

static struct refocus_renderer_params limits_of(const struct picture *p, float blur)
{
    struct refocus_renderer_params limits =
        refocus_renderer_params_default(p->width, p->height, blur);

    limits.threads = 2;
    return limits;
}

/* Strips, another number of threads, and other instruction sets change nothing. */
TEST(same_bytes)
{
    const size_t size = 3 * WIDTH * HEIGHT;
    struct picture p = picture_make(WIDTH, HEIGHT, 7);
    uint8_t *expected = malloc(size), *out = malloc(size);

    assert_true(expected && out);
    for (int i = 0; i < 2 * LENSES; i++) {
        const struct refocus_settings s = settings_of(i / 2, i % 2);
        struct refocus_renderer_params limits = limits_of(&p, s.render.max_blur_radius);

        if (left_out(i, 4))
            continue;
        render_once(&limits, &p, &s, expected);
        assert_memory_not_equal(expected, p.rgb, size);
        limits.in_place = limits.highlights = 1;
        render_once(&limits, &p, &s, out);
        assert_same_pixels(out, expected, WIDTH, HEIGHT, "strips");
        limits.in_place = limits.highlights = 0;
        limits.threads = 5;
        limits.cpu = REFOCUS_CPU_C;
        render_once(&limits, &p, &s, out);
        assert_same_pixels(out, expected, WIDTH, HEIGHT, "plain C, five threads");
    }
    free(expected);
    free(out);
    picture_free(&p);
}

TEST(regions)
{
    static const int part[][4] = {{0, 0, 40, 30}, {301, 77, 90, 50}, {560, 300, 60, 30}};
    struct picture p = picture_make(1300, 1100, 9);
    const struct refocus_image photo = picture_image(&p);
    const struct refocus_disparity map = picture_disparity(&p);
    uint8_t *whole = malloc(3 * (size_t)p.width * (size_t)p.height), out[3 * 90 * 50];

    assert_non_null(whole);
    for (int lens = 0; lens < (left_out(1, 2) ? 1 : 2); lens++) {
        struct refocus_settings s = settings_of(lens, false);
        const struct refocus_renderer_params limits = limits_of(&p, s.render.max_blur_radius);
        struct refocus_renderer *r;

        render_once(&limits, &p, &s, whole);
        for (int i = 0; i < 3; i++) {
            const int w = part[i][2], h = part[i][3];
            const struct refocus_image to =
                refocus_image_packed(REFOCUS_FORMAT_RGB8, out, w, h, 3 * w);

            assert_int_equal(refocus_renderer_create(&r, &limits), REFOCUS_OK);
            assert_int_equal(refocus_prepare(r, &photo, &map), REFOCUS_OK);
            s.render.region_x = part[i][0], s.render.region_y = part[i][1];
            s.render.region_width = w, s.render.region_height = h;
            assert_int_equal(refocus_render_settings(r, &s, &to), REFOCUS_OK);
            for (int y = 0; y < h; y++)
                assert_memory_equal(
                    out + 3 * y * w,
                    whole + 3 * ((size_t)(part[i][1] + y) * (size_t)p.width + (size_t)part[i][0]),
                    3 * (size_t)w);
            refocus_renderer_destroy(&r);
        }
    }
    free(whole);
    picture_free(&p);
}

/* Photos of Y, U and V, by vectors and by plain C. */
TEST(yuv)
{
    struct picture p = picture_make(402, 250, 11);
    const struct refocus_disparity map = picture_disparity(&p);

    for (int i = 0; i < 4; i++) {
        struct yuv_picture photo = yuv_make(yuv_formats[i], p.width, p.height, 3);
        struct yuv_picture out[2];
        struct refocus_settings s = settings_of(i, false);

        s.highlights.gain = 1;
        yuv_from_picture(&photo, &p);
        for (int c = 0; c < 2; c++) {
            struct refocus_renderer_params limits = limits_of(&p, s.render.max_blur_radius);
            struct refocus_renderer *r;

            limits.cpu = c ? REFOCUS_CPU_C : REFOCUS_CPU_AUTO;
            out[c] = yuv_make(yuv_formats[i], p.width, p.height, 3);
            assert_int_equal(refocus_renderer_create(&r, &limits), REFOCUS_OK);
            assert_int_equal(refocus_prepare(r, &photo.image, &map), REFOCUS_OK);
            assert_int_equal(refocus_render_settings(r, &s, &out[c].image), REFOCUS_OK);
            refocus_renderer_destroy(&r);
        }
        assert_same_yuv(&out[0].image, &out[1].image, "plain C");
        for (int c = 0; c < 2; c++)
            yuv_free(&out[c]);
        yuv_free(&photo);
    }
    picture_free(&p);
}

/* A lamp so wide on a dark wall, all of it out of focus by K: the least and the greatest code
 * inside its disc, on a cross through the middle. */
static void disc_of(float K, int wide, int *least, int *most)
{
    const int side = 2 * (int)K + 2 * wide + 64, middle = side / 2;
    struct picture p = picture_flat(side, side, (const uint8_t[3]){20, 20, 20}, 0);
    struct refocus_settings s = refocus_settings_default(1, K);
    const struct refocus_renderer_params limits = limits_of(&p, K);
    uint8_t *out = malloc(3 * (size_t)side * (size_t)side);

    assert_non_null(out);
    s.highlights.gain = 16;
    for (int i = 0; i < wide * wide; i++)
        memset(p.rgb + 3 * ((middle + i / wide) * side + middle + i % wide), 255, 3);
    render_once(&limits, &p, &s, out);
    *least = 255;
    *most = 0;
    for (int i = -(int)K + wide + 2; i < (int)K - wide - 2; i++) {
        const int across = out[3 * (middle * side + middle + i)];
        const int down = out[3 * ((middle + i) * side + middle)];

        *least = across < *least ? across : *least;
        *least = down < *least ? down : *least;
        *most = across > *most ? across : *most;
        *most = down > *most ? down : *most;
    }
    /* Nothing of it is beyond its rim. */
    assert_int_equal(out[3 * (middle * side + middle - (int)K - 3)], 20);
    free(out);
    picture_free(&p);
}

/* A disc has no ripple of more than 2 codes, and the light of the lamp over its area. */
TEST(discs)
{
    static const float blurs[] = {127, 200, 300, 470};

    for (int i = 0; i < 4; i++)
        for (int wide = 4; wide <= 12 && !left_out(i, 3); wide += 4) {
            const double lamp = 16 * wide * wide;
            const double area = 3.14159265358979 * (double)blurs[i] * (double)blurs[i];
            const double light = picture_light(20) + lamp / area;
            int least, most;

            disc_of(blurs[i], wide, &least, &most);
            if (most - least > 2 || fabs(picture_light(most) / light - 1) > 0.12)
                fail_msg("K = %g, a lamp of %d: codes %d to %d, should be %d", (double)blurs[i],
                         wide, least, most, picture_code(light));
        }
}

/* A round lamp on a dark wall, whose light falls off over `soft` pixels at its rim. */
struct lamp {
    int wide, soft;
};

/* The share of the lamp that is seen at a distance from its middle. */
static double seen(const struct lamp *lamp, double distance)
{
    return fmin(fmax((lamp->wide / 2.0 - distance) / lamp->soft + 0.5, 0), 1);
}

/* The least and the greatest code inside its disc, where all of it is out of focus by K. Returns
 * how much light there is, in pixels of white. */
static double soft_disc_of(float K, const struct lamp *lamp, int *least, int *most)
{
    const int reach = lamp->wide / 2 + lamp->soft + 1;
    const int side = 2 * (int)K + 2 * reach + 64, middle = side / 2;
    struct picture p = picture_flat(side, side, (const uint8_t[3]){20, 20, 20}, 0);
    struct refocus_settings s = refocus_settings_default(1, K);
    const struct refocus_renderer_params limits = limits_of(&p, K);
    uint8_t *out = malloc(3 * (size_t)side * (size_t)side);
    double light = 0;

    assert_non_null(out);
    s.highlights.gain = 16;
    for (int y = -reach; y <= reach; y++)
        for (int x = -reach; x <= reach; x++) {
            const double at = picture_light(20) + seen(lamp, hypot(x, y));
            const int code = at < 1 ? picture_code(at) : 255;

            memset(p.rgb + 3 * ((middle + y) * side + middle + x), code, 3);
            light += code == 255 ? 16 : picture_light(code) - picture_light(20);
        }
    render_once(&limits, &p, &s, out);
    *least = 255;
    *most = 0;
    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++) {
            const int code = out[3 * (y * side + x)];

            if (hypot(x - middle, y - middle) > (double)K - reach - 1)
                continue;
            *least = code < *least ? code : *least;
            *most = code > *most ? code : *most;
        }
    /* Next to nothing of it is beyond its rim, which rays draw in part. */
    assert_in_range(out[3 * (middle * side + middle - (int)K - reach - (int)fminf(K / 8, 24))], 20,
                    21);
    free(out);
    picture_free(&p);
    return light;
}

/* Nor has that of a round lamp with a rim, anywhere in it. */
TEST(soft_discs)
{
    static const float blurs[] = {60, 100, 127, 200, 300, 470};
    static const struct lamp lamps[] = {{4, 1}, {9, 1}, {9, 4}, {40, 1}, {40, 4}};

    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 5 && !left_out(5 * i + j, 4); j++) {
            const double area = 3.14159265358979 * (double)blurs[i] * (double)blurs[i];
            int least, most;
            const double lamp = soft_disc_of(blurs[i], &lamps[j], &least, &most);
            const double light = picture_light(20) + lamp / area;
            const bool small = lamps[j].wide < 12; /* large ones get less than the gain */

            if (most - least > 2 || (small && fabs(picture_light(most) / light - 1) > 0.12))
                fail_msg("K = %g, a lamp of %d, its rim %d: codes %d to %d, should be %d",
                         (double)blurs[i], lamps[j].wide, lamps[j].soft, least, most,
                         picture_code(light));
        }
}

/* Other methods than the sweep go up to 127 pixels, also in a renderer for more; a full mask of the
 * sweep has no more rays for more. */
TEST(methods)
{
    struct picture p = picture_make(90, 70, 3);
    const struct refocus_image photo = picture_image(&p);
    const struct refocus_disparity map = picture_disparity(&p);
    struct refocus_renderer_params limits = limits_of(&p, 300);
    static uint8_t out[3 * 90 * 70], own[3 * 90 * 70];
    const struct refocus_image to = refocus_image_packed(REFOCUS_FORMAT_RGB8, out, 90, 70, 270);
    struct refocus_renderer *r;

    limits.papers = refocus_papers();
    limits.methods = REFOCUS_METHODS_ALL;
    assert_int_equal(refocus_renderer_create(&r, &limits), REFOCUS_OK);
    assert_int_equal(refocus_prepare(r, &photo, &map), REFOCUS_OK);
    for (uint32_t method = 0; method < REFOCUS_METHOD_COUNT; method++) {
        const bool any = refocus_method_traits(method) & REFOCUS_METHOD_ANY_RADIUS;
        struct refocus_settings s = refocus_settings_default(0.3f, 127.5f);

        s.render.method = method;
        assert_int_equal(refocus_render_settings(r, &s, &to),
                         any ? REFOCUS_OK : REFOCUS_ERR_ARGUMENT);
        s.render.max_blur_radius = 20;
        assert_int_equal(refocus_render_settings(r, &s, &to), REFOCUS_OK);
        limits.max_blur_radius = 20;
        render_once(&limits, &p, &s, own);
        assert_same_pixels(out, own, p.width, p.height, refocus_method_name(method));
    }
    for (int full = 0; full < 2; full++) {
        struct refocus_settings s = refocus_settings_default(0.3f, full ? 300 : 127);

        s.render.rays = REFOCUS_RAYS_FULL;
        assert_int_equal(refocus_render_settings(r, &s, &to), REFOCUS_OK);
    }
    refocus_renderer_destroy(&r);
    limits.max_blur_radius = REFOCUS_MAX_BLUR_RADIUS + 1;
    assert_int_equal(refocus_renderer_create(&r, &limits), REFOCUS_ERR_ARGUMENT);
    picture_free(&p);
}
