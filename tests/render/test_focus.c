/* test_focus.c: focus beyond a plain lens: the signed blur against the formulas in double
 * precision, and what equals a plain lens against that lens, byte for byte. */
#include "focus/focus.h"
#include "pictures.h"

enum { W = 93, H = 58 };

static uint8_t grey[31 * 17];
static uint16_t deep[W * H];

static struct refocus_disparity grey_map(void)
{
    return refocus_disparity8(grey, 31, 17, 31);
}

/* A map's value at a pixel by bilinear interpolation. */
static double map_at(const struct refocus_disparity *map, int x, int y)
{
    const double fx = fmin(fmax((x + 0.5) * map->width / W - 0.5, 0), map->width - 1);
    const double fy = fmin(fmax((y + 0.5) * map->height / H - 0.5, 0), map->height - 1);
    double sum = 0;

    for (int j = 0; j < map->height; j++) {
        for (int i = 0; i < map->width; i++) {
            const double part = fmax(0, 1 - fabs(fx - i)) * fmax(0, 1 - fabs(fy - j));
            const uint8_t *row = (const uint8_t *)map->samples + j * map->stride;

            sum += part * (map->bits == 8 ? row[i] / 255.0
                                          : ((const uint16_t *)(const void *)row)[i] / 65535.0);
        }
    }
    return sum;
}

static double shortened(double e, double width, double transition)
{
    const double a = fabs(e);

    if (a <= width)
        return 0;
    return a >= width + transition ? a : (a - width) * (width + transition) / transition;
}

static double lens(const struct refocus_settings *p, int x, int y, double d)
{
    const double df = p->focus.map ? map_at(p->focus.map, x, y) : p->render.focus_disparity;
    const double tilt = p->focus.tilt_across * ((x + 0.5) / W - p->focus.tilt_x) +
                        p->focus.tilt_down * ((y + 0.5) / H - p->focus.tilt_y);
    double least =
        shortened(p->focus.depth_share * (df - d) + tilt, p->focus.half_width, p->focus.transition);

    for (int i = 0; i < p->focus.bands; i++)
        least =
            fmin(least, shortened(p->focus.depth_share * (p->focus.band[i].disparity - d) + tilt,
                                  p->focus.band[i].half_width, p->focus.band[i].transition));
    return least;
}

static double field(const struct refocus_settings *p, int x, int y, double d)
{
    const double fx = (x + 0.5) / W - p->field.x;
    const double fy = (y + 0.5 - (double)p->field.y * H) / W, fd = d - p->field.disparity;
    const double angle = p->field.angle * 3.14159265358979 / 180;
    double distance = sqrt(fx * fx + fy * fy + fd * fd);

    if (p->field.shape == REFOCUS_FIELD_PICTURE)
        return map_at(p->field.map, x, y);
    if (p->field.shape == REFOCUS_FIELD_CYLINDER)
        distance = hypot(fx, fd);
    if (p->field.shape == REFOCUS_FIELD_PLUS)
        distance = fmin(fabs(fx), fabs(fd));
    if (p->field.shape == REFOCUS_FIELD_PLANE)
        distance = fabs(fx * cos(angle) + fd * sin(angle));
    return fmin(1, fmax(0, (distance - p->field.radius) / p->field.falloff));
}

static double expected(const struct refocus_settings *p, int x, int y, double d)
{
    double r;

    d = fmin(fmax(d, p->focus.least_disparity), p->focus.most_disparity);
    r = p->field.shape == REFOCUS_FIELD_LENS ? lens(p, x, y, d) : field(p, x, y, d);
    r = fmin(p->render.max_blur_radius * fmin(r, 1), p->focus.blur_limit);
    return p->focus.sharp_map ? r * (1 - map_at(p->focus.sharp_map, x, y)) : r;
}

/* One of many ways to focus; false after the last. */
static bool make_way(int i, struct refocus_settings *p, const struct refocus_disparity *small,
                     const struct refocus_disparity *full)
{
    p->focus.tilt_across = i % 3 ? 0.7f : 0;
    p->focus.tilt_down = i % 2 ? -1.4f : 0;
    p->focus.tilt_y = 0.3f;
    p->focus.depth_share = i == 3 ? 0.35f : i == 4 ? 0 : 1;
    p->focus.half_width = i > 4 && i % 2 ? 0.06f : 0;
    p->focus.transition = i == 5 ? 0.1f : 0;
    p->focus.bands = i == 6 ? 3 : i == 7 ? REFOCUS_MAX_BANDS - 1 : 0;
    for (int k = 0; k < p->focus.bands; k++)
        p->focus.band[k] =
            (struct refocus_band){(float)(k % 8) / 8, 0.01f * (float)(k + 1), k % 2 ? 0 : 0.05f};
    p->focus.map = i == 8 ? small : i == 9 ? full : NULL;
    p->focus.sharp_map = i == 10 ? small : i == 11 ? full : NULL;
    p->focus.least_disparity = i == 12 ? 0.25f : 0;
    p->focus.most_disparity = i == 12 ? 0.5f : 1;
    p->focus.blur_limit = i == 13 ? 3.3f : 127;
    p->field.shape = i > 13 ? (uint32_t)(i - 13) : 0;
    p->field.map = p->field.shape == REFOCUS_FIELD_PICTURE ? small : NULL;
    p->field.x = 0.6f;
    p->field.y = 0.45f;
    p->field.disparity = 0.4f;
    p->field.angle = 37;
    return i <= 13 + REFOCUS_FIELD_PICTURE;
}

TEST(formulas)
{
    struct picture p = picture_make(W, H, 5);
    struct refocus_renderer *renderer = prepared(&p, 18.5f, 2);
    const struct refocus_disparity small = grey_map();
    const struct refocus_disparity full = refocus_disparity16(deep, W, H, 2 * W);
    struct refocus_settings params = refocus_settings_default(0.37f, 18.5f);
    static uint8_t out[3 * W * H];
    static uint16_t blur[W * H];
    const struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, out, W, H, 3 * W);

    params.render.method = REFOCUS_METHOD_SEARCH; /* sweep moves single edges */
    params.render.rays = 1;
    for (int i = 0; make_way(i, &params, &small, &full); i++) {
        double worst = 0;

        assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
        assert_int_equal(refocus_get_view(renderer, REFOCUS_VIEW_BLUR, blur, 2 * W), 0);
        for (int k = 0; k < W * H; k++) {
            const double d = p.disparity[k] / 65535.0;
            double off = 1e9;

            /* a step of a band may fall to either side of a disparity */
            for (int side = -1; side <= 1; side++)
                off = fmin(
                    off, fabs(blur[k] / 256.0 - expected(&params, k % W, k / W, d + side * 2e-5)));
            worst = fmax(worst, off);
        }
        if (worst > 2.5 / 256)
            fail_msg("way %d is off by %g pixels", i, worst);
    }
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

static void check_same(struct refocus_renderer *renderer, const struct refocus_settings *params,
                       const char *what)
{
    static uint8_t is[3 * W * H], wanted[3 * W * H];
    struct refocus_settings plain =
        refocus_settings_default(params->render.focus_disparity, params->render.max_blur_radius);
    struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, is, W, H, 3 * W);

    plain.render.method = params->render.method;
    assert_int_equal(refocus_render_settings(renderer, params, &image), REFOCUS_OK);
    image.plane[0] = wanted;
    assert_int_equal(refocus_render_settings(renderer, &plain, &image), REFOCUS_OK);
    assert_same_pixels(is, wanted, W, H, what);
}

TEST(plain_lens)
{
    enum { BLUR = 30 }; /* Lens and field have bins of a quarter pixel with it. */
    static uint16_t map[W * H];
    const struct refocus_disparity picture = refocus_disparity16(map, W, H, 2 * W);
    struct picture p = picture_make(W, H, 6);
    struct refocus_renderer *renderer = prepared(&p, BLUR, 2);

    for (uint32_t method = 0; method < REFOCUS_METHOD_COUNT; method++) {
        const struct refocus_settings plain = refocus_settings_default(0.45f, BLUR);
        const int df = (int)floor((double)plain.render.focus_disparity * 65535 + 0.5);
        struct refocus_settings params = plain;
        struct refocus_focus_plane plane;

        if (!(refocus_method_traits(method) & REFOCUS_METHOD_ANY_FOCUS))
            continue;
        params.render.method = method;
        params.field.shape = REFOCUS_FIELD_PLANE;
        params.field.angle = 90;
        params.field.radius = 0;
        params.field.falloff = 1;
        check_same(renderer, &params, "a plane that faces the lens");

        params.field.shape = REFOCUS_FIELD_PICTURE;
        params.field.map = &picture;
        for (int i = 0; i < W * H; i++)
            map[i] = (uint16_t)abs(p.disparity[i] - df);
        check_same(renderer, &params, "a picture of the lens's blur");

        params = plain;
        params.render.method = method;
        params.focus.map = &picture;
        for (int i = 0; i < W * H; i++)
            map[i] = (uint16_t)df;
        check_same(renderer, &params, "a level surface in focus");

        params.focus.map = NULL;
        params.focus.sharp_map = &picture;
        memset(map, 0, sizeof map);
        check_same(renderer, &params, "an empty mask");

        params = plain;
        params.render.method = method;
        params.focus.transition = 0.3f;
        params.focus.bands = 1;
        params.focus.band[0] = (struct refocus_band){params.render.focus_disparity, 0, 0.2f};
        check_same(renderer, &params, "bands without a width");

        params = plain;
        params.render.method = method;
        assert_int_equal(
            refocus_focus_plane_of_points(
                &plane,
                (struct refocus_focus_point[3]){{0.1f, 0.2f, params.render.focus_disparity},
                                                {0.9f, 0.3f, params.render.focus_disparity},
                                                {0.4f, 0.8f, params.render.focus_disparity}}),
            REFOCUS_OK);
        assert_true(plane.across == 0 && plane.down == 0);
        params.focus.tilt_x = plane.x;
        params.focus.tilt_y = plane.y;
        params.focus.tilt_across = plane.across;
        params.focus.tilt_down = plane.down;
        params.render.focus_disparity = plane.focus_disparity;
        check_same(renderer, &params, "a plane that is not tilted");
    }
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

/* Everything sharp by a mask: nothing is changed. */
TEST(masked)
{
    static const uint8_t white = 255;
    static uint8_t out[3 * W * H];
    const struct refocus_disparity all = refocus_disparity8(&white, 1, 1, 1);
    const struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, out, W, H, 3 * W);
    struct picture p = picture_make(W, H, 7);
    struct refocus_renderer *renderer = prepared(&p, 20, 1);
    struct refocus_settings params = refocus_settings_default(0, 20);

    params.focus.sharp_map = &all;
    assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
    assert_same_pixels(out, p.rgb, W, H, "under a mask");
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

/* Between two bands nothing spreads over the nearer one. */
TEST(near_band_is_clean)
{
    enum { SIDE = 96 };
    struct picture p = picture_flat(SIDE, SIDE, (uint8_t[3]){200, 30, 30}, 0);
    struct refocus_settings params = refocus_settings_default(0.9f, 20);
    static uint8_t out[3 * SIDE * SIDE];
    const struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, out, SIDE, SIDE, 3 * SIDE);
    struct refocus_renderer *renderer;

    for (int i = 0; i < SIDE * SIDE; i++) { /* far, in between, near */
        const int x = i % SIDE;

        p.disparity[i] = x < 32 ? 6554 : x < 64 ? 26214 : 58982;
        if (x >= 64)
            memcpy(p.rgb + 3 * i, (uint8_t[3]){10, 10, 250}, 3);
    }
    renderer = prepared(&p, 20, 1);
    params.focus.bands = 1;
    params.focus.band[0] = (struct refocus_band){0.1f, 0, 0};
    assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
    for (int i = 0; i < SIDE * SIDE; i++)
        if (i % SIDE >= 64 && memcmp(out + 3 * i, p.rgb + 3 * i, 3))
            fail_msg("(%d, %d) is in focus and changed", i % SIDE, i / SIDE);
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

/* A field in the highest photo there can be: the lengths are not beyond what fixed point holds. */
TEST(highest_photo)
{
    enum { TALL = 65535 };
    struct rf_settings settings = {.field = REFOCUS_FIELD_SPHERE,
                                   .field_y = 1,
                                   .field_falloff = 4,
                                   .blur_limit = 127,
                                   .depth_share = 1,
                                   .most_disparity = 1};
    const uint16_t disparity = 0;
    struct rf_focus_plan plan;
    int16_t last, before, first;

    rf_focus_plan_make(&plan, &settings, rf_focus_of(0, 100), 1, TALL);
    rf_focus_row(&plan, &last, &disparity, 0, TALL - 1, 1);
    rf_focus_row(&plan, &before, &disparity, 0, TALL - 3, 1);
    rf_focus_row(&plan, &first, &disparity, 0, 0, 1);
    /* 1/2 of a width from the centre both ways, of 4: 0.177 of 100 pixels; 2 1/2 down, 1/2 across
     */
    assert_true(abs(last - 4525) <= 3);
    assert_true(abs(before - 16316) <= 3);
    assert_int_equal(first, 100 * 256);
}

/* Methods that know plain lenses only say so. */
TEST(refused)
{
    struct picture p = picture_make(W, H, 8);
    struct refocus_renderer *renderer = prepared(&p, 6, 1);
    const struct refocus_disparity small = grey_map(),
                                   full = refocus_disparity16(deep, W, H, 2 * W);
    static uint8_t out[3 * W * H];
    const struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, out, W, H, 3 * W);

    for (uint32_t method = 0; method < REFOCUS_METHOD_COUNT; method++) {
        const bool takes = refocus_method_traits(method) & REFOCUS_METHOD_ANY_FOCUS;
        struct refocus_settings params = refocus_settings_default(0.5f, 6);

        params.render.method = method;
        params.render.rays = 4;
        for (int i = 1; make_way(i, &params, &small, &full); i++)
            assert_int_equal(refocus_render_settings(renderer, &params, &image),
                             takes ? REFOCUS_OK : REFOCUS_ERR_ARGUMENT);
    }
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

/* Blurs beyond 127 pixels are told in pixels, too, up to what 16 bits hold. */
TEST(large_blurs_in_a_view)
{
    struct picture p = picture_make(W, H, 7);
    static uint8_t out[3 * W * H];
    static uint16_t blur[W * H];
    const struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, out, W, H, 3 * W);

    for (int i = 0; i < 2; i++) {
        const float most = i ? 600 : 250, apart = most / 65535;
        struct refocus_renderer *renderer = prepared(&p, most, 1);
        struct refocus_render_params params = refocus_render_params_default(0, most);

        params.rays = 4;
        assert_int_equal(refocus_render(renderer, &params, &image), REFOCUS_OK);
        assert_int_equal(refocus_get_view(renderer, REFOCUS_VIEW_BLUR, blur, 2 * W), REFOCUS_OK);
        for (int k = 0; k < W * H; k++) {
            const float wanted = fminf(apart * (float)p.disparity[k], 65535 / 256.0f);

            if (fabsf((float)blur[k] / 256 - wanted) > most / 4096)
                fail_msg("K = %g: the blur at %d is %d, not %g pixels", (double)most, k, blur[k],
                         (double)wanted);
        }
        refocus_renderer_destroy(&renderer);
    }
    picture_free(&p);
}

int main(void)
{
    uint32_t state = 3;

    for (size_t i = 0; i < sizeof grey; i++)
        grey[i] = (uint8_t)noise(&state);
    for (size_t i = 0; i < W * H; i++)
        deep[i] = (uint16_t)noise(&state);
    return unit_test_run(NULL, NULL);
}
