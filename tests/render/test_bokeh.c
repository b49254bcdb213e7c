/* test_bokeh.c: the look of the blur: discs of single highlights, measured in linear light; star
 * filter. */
#include "pictures.h"
#include "things.h"

enum { W = 144, H = 112 };

static uint8_t out[3 * W * H];
static const struct refocus_image image = {.struct_size = sizeof(struct refocus_image),
                                           .format = REFOCUS_FORMAT_RGB8,
                                           .width = W,
                                           .height = H,
                                           .plane = {out},
                                           .stride = {3 * W}};

/* A light of 5 x 5 pixels in the dark, in front of nothing, at disparity d. With a skirt it is
 * surely one that has lost light. */
static struct refocus_renderer *prepare_highlight(int x, int y, uint16_t d, double skirt)
{
    struct picture p = picture_flat(W, H, (uint8_t[3]){0, 0, 0}, d);
    struct refocus_renderer *renderer;

    draw_skirt(&p, x, y, 25, (const double[3]){8, 8, 8}, skirt);
    for (int j = y - 2; j <= y + 2; j++)
        memset(p.rgb + 3 * (j * W + x - 2), 255, 15);
    renderer = prepared(&p, 30, 2);
    picture_free(&p);
    return renderer;
}

static struct refocus_renderer *highlight_at(int x, int y, uint16_t d)
{
    return prepare_highlight(x, y, d, 0);
}

/* Behind the focus at 0.5, or as far before it: 12 pixels of blur. */
enum { BEHIND = 6554, BEFORE = 58982 };

static struct refocus_settings twelve(void)
{
    struct refocus_settings params = refocus_settings_default(0.5f, 30);

    params.render.rays = 512;
    params.render.prefilter = 0;
    return params;
}

/* Light about a place: sum, mean place, mean squares. */
struct disc {
    double all, x, y, xx, yy, above;
};

static struct disc disc_at(int x, int y, int channel)
{
    struct disc d = {0, 0, 0, 0, 0, 0};

    for (int j = 0; j < H; j++) {
        for (int i = 0; i < W; i++) {
            const double l = picture_light(out[3 * (j * W + i) + channel]);

            d.all += l;
            d.x += l * (i - x);
            d.y += l * (j - y);
            d.xx += l * (i - x) * (i - x);
            d.yy += l * (j - y) * (j - y);
            d.above += j < y ? l : 0;
        }
    }
    d.x /= d.all;
    d.y /= d.all;
    d.xx /= d.all;
    d.yy /= d.all;
    d.above /= d.all;
    return d;
}

static struct disc render_highlight(int x, int y, uint16_t depth,
                                    const struct refocus_settings *params, int channel)
{
    struct refocus_renderer *renderer = highlight_at(x, y, depth);

    assert_int_equal(refocus_render_settings(renderer, params, &image), REFOCUS_OK);
    refocus_renderer_destroy(&renderer);
    return disc_at(x, y, channel);
}

static struct disc highlight_through(const struct refocus_aperture_params *aperture, uint16_t depth)
{
    struct refocus_settings params = twelve();
    struct refocus_aperture *a;
    struct disc disc;

    assert_int_equal(refocus_aperture_create(&a, aperture), REFOCUS_OK);
    params.render.aperture = a;
    disc = render_highlight(W / 2, H / 2, depth, &params, 1);
    refocus_aperture_destroy(&a);
    return disc;
}

static void about(const char *what, double is, double wanted, double part)
{
    if (!(fabs(is - wanted) <= part * fabs(wanted)))
        fail_msg("%s is %g, should be %g", what, is, wanted);
}

/* A heart is upright behind the focus and upside down before it. */
TEST(hearts)
{
    struct refocus_aperture_params p = refocus_aperture_params_default();
    struct disc behind, before;

    p.figure = REFOCUS_FIGURE_HEART;
    behind = highlight_through(&p, BEHIND);
    before = highlight_through(&p, BEFORE);
    assert_true(behind.above > 0.55 && before.above < 0.45);
    about("light of a heart", behind.all, 25, 0.03);
    about("light of a heart before the focus", before.all, 25, 0.03);
    about("its place", before.y, -behind.y, 0.1);
}

/* Discs have bright edges behind the focus, and fade before it. */
TEST(sides)
{
    struct refocus_aperture_params p = refocus_aperture_params_default();
    const double highlight = 2 * 2.0; /* mean squares of 5 x 5 pixels */

    p.edge_behind = 0.6;
    p.edge_before = -0.6;
    const struct disc behind = highlight_through(&p, BEHIND),
                      before = highlight_through(&p, BEFORE);
    about("a disc with a bright edge", behind.xx + behind.yy - highlight, 144 * (0.5 + 0.6 / 3),
          0.04);
    about("a disc that fades", before.xx + before.yy - highlight, 144 * (0.5 - 0.6 / 6), 0.04);
}

TEST(squeezed)
{
    struct refocus_aperture_params p = refocus_aperture_params_default();

    p.squeeze = 0.55;
    const struct disc oval = highlight_through(&p, BEHIND);
    about("width / height of an oval", sqrt((oval.xx - 2) / (oval.yy - 2)), 0.55, 0.03);
    about("light of an oval", oval.all, 25, 0.02);
}

/* Discs at the side are narrower across, as the areas common to two circles; whole in the
 * middle, and no light is lost. */
TEST(cat_eye)
{
    struct refocus_settings params = twelve();
    const int x = W - 18, y = H / 2;
    double sum = 0, xx = 0, yy = 0;
    struct disc disc;

    params.look.cat_eye = 0.8f;
    disc = render_highlight(W / 2, H / 2, BEHIND, &params, 1);
    about("the middle's disc", sqrt((disc.xx - 2) / (disc.yy - 2)), 1, 0.03);
    disc = render_highlight(x, y, BEHIND, &params, 1);
    const double pushed = 0.8 * pow(x + 0.5 - W / 2.0, 2) / (W * W / 4.0 + H * H / 4.0);
    for (int i = -500; i < 500; i++) {
        const double at = (i + 0.5) / 500, h = 1 - pow(fabs(at) + pushed, 2);

        if (h > 0 && fabs(at) < 1 - pushed) {
            sum += sqrt(h);
            xx += at * at * sqrt(h);
            yy += h * sqrt(h) / 3;
        }
    }
    about("how much narrower", sqrt((disc.xx - 2) / (disc.yy - 2)), sqrt(xx / yy), 0.05);
    about("width squared", disc.xx - 2, 144 * xx / sum, 0.08);
    about("light of a cat's eye", disc.all, 25, 0.04);
}

/* An aperture loses no more than its amount where the middle of the last tile lies beyond the
 * corner: of a width of 1 pixel and a height of 4.4 that is left, no pixel keeps a half. */
TEST(cat_eye_in_the_corner)
{
    enum { SIDE = 36, AT = SIDE - 3 };
    static const uint8_t black[3];
    static uint8_t codes[3 * SIDE * SIDE];
    struct picture p = picture_flat(SIDE, SIDE, black, 0);
    struct refocus_renderer *renderer;
    const struct refocus_image small =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, codes, SIDE, SIDE, 3 * SIDE);

    memset(p.rgb + 3 * (AT * SIDE + AT), 255, 3);
    renderer = prepared(&p, 5, 1);
    for (int blades = 0; blades <= 6; blades += 6) {
        struct refocus_settings params = refocus_settings_default(1, 5);
        struct refocus_aperture *aperture = NULL;

        if (blades)
            assert_int_equal(refocus_aperture_create_polygon(&aperture, blades, 0), 0);
        params.render.aperture = aperture;
        params.render.blend = REFOCUS_BLEND_STORED;
        params.render.rays = 512;
        params.render.prefilter = 0;
        params.highlights.gain = 1;
        params.look.cat_eye = 0.9f;
        assert_int_equal(refocus_render_settings(renderer, &params, &small), REFOCUS_OK);
        assert_in_range(codes[3 * (AT * SIDE + AT)], 20, 127);
        refocus_aperture_destroy(&aperture);
    }
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

TEST(fringes)
{
    struct refocus_settings params = twelve();

    for (int sign = -1; sign <= 1; sign += 2) {
        params.look.fringe = 0.25f * (float)sign;
        for (int before = 0; before < 2; before++) {
            const uint16_t depth = before ? BEFORE : BEHIND;
            const struct disc red = render_highlight(W / 2, H / 2, depth, &params, 0);
            const struct disc green = disc_at(W / 2, H / 2, 1), blue = disc_at(W / 2, H / 2, 2);
            const bool green_is_wider = (sign > 0) != (before == 1);
            const double ratio = sqrt((green.xx - 2) / (red.xx - 2));

            about("green / red", ratio, green_is_wider ? 1 / 0.75 : 0.75, 0.04);
            about("blue / red", sqrt((blue.xx - 2) / (red.xx - 2)), 1, 0.001);
            about("light of a fringed disc", green.all, 25, 0.03);
        }
    }
}

/* Discs of highlights are as bright as the gain says. */
TEST(stops)
{
    struct refocus_renderer *renderer = prepare_highlight(W / 2, H / 2, BEHIND, 0.04);
    struct refocus_settings params = twelve();

    for (int weighted = 0; weighted < 2; weighted++) {
        double plain = 0;

        params.render.sigma = weighted ? 1e5f : INFINITY; /* all weights nearly the same */
        for (int gain = 1; gain <= 16; gain *= 2) {
            double all;

            params.highlights.gain = (float)gain;
            assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
            all = disc_at(W / 2, H / 2, 1).all;
            if (gain == 1)
                plain = all - 25; /* the skirt's */
            about("light of a highlight", all - plain, 25 * gain, 0.03);
        }
    }
    refocus_renderer_destroy(&renderer);
}

TEST(star)
{
    struct refocus_settings params = refocus_settings_default(0.1f, 30);
    const int x = W / 2, y = H / 2;
    static uint8_t plain[3 * W * H];
    struct refocus_renderer *renderer = highlight_at(x, y, BEHIND);
    double added = 0;

    assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
    memcpy(plain, out, sizeof out);
    params.look.star_spikes = 4;
    params.look.star_length = 30;
    params.look.star_strength = 0.5f;
    assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
    refocus_renderer_destroy(&renderer);
    for (int l = 5; l < 25; l++) {
        const int at[4] = {y * W + x + l, y * W + x - l, (y + l) * W + x, (y - l) * W + x};

        for (int k = 0; k < 4; k++)
            assert_true(out[3 * at[k]] > 20);
        assert_int_equal(out[3 * ((y + l) * W + x + l)], 0);
    }
    assert_int_equal(out[3 * (y * W + x + 32)], 0);
    for (int i = 0; i < W * H; i++)
        added += picture_light(out[3 * i]) - picture_light(plain[3 * i]);
    /* half of 25 lights, less the part that falls on the light itself, which is white already */
    assert_true(added > 12.5 * 0.6 && added < 12.5);
}

/* Every effect: a part of the picture is that part of the whole. */
TEST(regions)
{
    enum { X = 37, Y = 21, PW = 61, PH = 50 };
    static uint8_t part[3 * PW * PH];
    const struct refocus_image small =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, part, PW, PH, 3 * PW);
    struct picture p = picture_make(W, H, 9);
    struct refocus_renderer *renderer;
    struct refocus_settings params;
    const char *name;

    for (int i = 0; i < 3 * W * H; i++)
        p.rgb[i] = p.rgb[i] < 250 ? p.rgb[i] / 4 : 255;
    renderer = prepared(&p, 10, 3);
    for (int i = 0; effect_params(i, 0.5f, 10, &params, &name); i++) {
        struct refocus_aperture *aperture = effect_aperture(i);

        params.render.aperture = aperture;
        assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
        params.render.region_x = X, params.render.region_y = Y;
        params.render.region_width = PW, params.render.region_height = PH;
        assert_int_equal(refocus_render_settings(renderer, &params, &small), REFOCUS_OK);
        for (int y = 0; y < PH; y++)
            if (memcmp(part + 3 * y * PW, out + 3 * ((y + Y) * W + X), 3 * PW))
                fail_msg("%s: row %d of the region differs", name, y);
        refocus_aperture_destroy(&aperture);
    }
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

/* A night of 300 x 260 pixels with lights, larger than a block of strip mode. */
enum { NIGHT_W = 300, NIGHT_H = 260 };

static struct picture dark_street(void)
{
    struct picture p = picture_make(NIGHT_W, NIGHT_H, 9);

    for (int i = 0; i < NIGHT_W * NIGHT_H; i++)
        for (int c = 0; c < 3; c++)
            p.rgb[3 * i + c] =
                i % NIGHT_W % 37 < 4 && i / NIGHT_W % 41 < 4 ? 255 : p.rgb[3 * i + c] / 5;
    return p;
}

static struct refocus_renderer *of_night(const struct picture *p, uint32_t in_place)
{
    struct refocus_renderer_params limits = refocus_renderer_params_default(NIGHT_W, NIGHT_H, 9);
    const struct refocus_image photo = picture_image(p);
    const struct refocus_disparity disparity = picture_disparity(p);
    struct refocus_renderer *renderer;

    limits.threads = 3;
    limits.in_place = limits.highlights = in_place;
    limits.papers = refocus_papers();
    limits.methods = in_place ? 0 : REFOCUS_METHODS_ALL;
    assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_OK);
    assert_int_equal(refocus_prepare(renderer, &photo, &disparity), REFOCUS_OK);
    return renderer;
}

static void render_effect(struct refocus_renderer *renderer, int i, uint8_t *to)
{
    const struct refocus_image whole =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, to, NIGHT_W, NIGHT_H, 3 * NIGHT_W);
    struct refocus_aperture *aperture = effect_aperture(i);
    struct refocus_settings params;
    const char *name;

    assert_true(effect_params(i, 0.5f, 9, &params, &name));
    params.render.aperture = aperture;
    assert_int_equal(refocus_render_settings(renderer, &params, &whole), REFOCUS_OK);
    refocus_aperture_destroy(&aperture);
}

/* Every effect: in strips as of the whole, and whatever was rendered before it. */
TEST(strips_and_sequences)
{
    static uint8_t is[3 * NIGHT_W * NIGHT_H], wanted[3 * NIGHT_W * NIGHT_H];
    struct picture p = dark_street();
    struct refocus_renderer *used = of_night(&p, 0), *strips = of_night(&p, 1);
    struct refocus_settings params;
    const char *name;

    for (int i = 0; effect_params(i, 0.5f, 9, &params, &name); i++) {
        struct refocus_renderer *fresh;

        if (left_out(i, 3))
            continue;
        fresh = of_night(&p, 0);
        render_effect(fresh, i, wanted);
        render_effect(used, i, is);
        assert_same_pixels(is, wanted, NIGHT_W, NIGHT_H, name);
        render_effect(used, (i * 7 + 3) % 30, is); /* something else in between */
        render_effect(used, i, is);
        assert_same_pixels(is, wanted, NIGHT_W, NIGHT_H, name);
        render_effect(used, i, is);
        assert_same_pixels(is, wanted, NIGHT_W, NIGHT_H, name);
        if (params.render.method != REFOCUS_METHOD_DIFFUSION) {
            render_effect(strips, i, is);
            assert_same_pixels(is, wanted, NIGHT_W, NIGHT_H, name);
        }
        refocus_renderer_destroy(&fresh);
    }
    refocus_renderer_destroy(&used);
    refocus_renderer_destroy(&strips);
    picture_free(&p);
}

/* A map that is another at the same address. */
TEST(changed_map)
{
    static uint8_t is[3 * NIGHT_W * NIGHT_H], wanted[3 * NIGHT_W * NIGHT_H];
    struct picture p = dark_street();
    struct refocus_renderer *used = of_night(&p, 0), *fresh = of_night(&p, 0);
    struct refocus_image whole =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, is, NIGHT_W, NIGHT_H, 3 * NIGHT_W);
    struct refocus_settings params = refocus_settings_default(0.5f, 9);
    uint8_t level = 200;
    const struct refocus_disparity map = refocus_disparity8(&level, 1, 1, 1);

    params.focus.map = &map;
    assert_int_equal(refocus_render_settings(used, &params, &whole), REFOCUS_OK);
    level = 20;
    assert_int_equal(refocus_render_settings(used, &params, &whole), REFOCUS_OK);
    whole.plane[0] = wanted;
    assert_int_equal(refocus_render_settings(fresh, &params, &whole), REFOCUS_OK);
    assert_same_pixels(is, wanted, NIGHT_W, NIGHT_H, "a changed map");
    refocus_renderer_destroy(&used);
    refocus_renderer_destroy(&fresh);
    picture_free(&p);
}

/* Methods and sets of rays that cannot do it say so. */
TEST(refused)
{
    struct refocus_aperture_params p = refocus_aperture_params_default();
    struct refocus_renderer *renderer = highlight_at(W / 2, H / 2, BEHIND);
    struct refocus_aperture *a;

    p.edge_behind = 0.5;
    assert_int_equal(refocus_aperture_create(&a, &p), REFOCUS_OK);
    for (uint32_t method = REFOCUS_METHOD_SWEEP; method < REFOCUS_METHOD_COUNT; method++) {
        for (int i = 0; i < 3; i++) {
            struct refocus_settings params = refocus_settings_default(0.5f, 2);

            params.render.method = method;
            params.render.rays = 8;
            params.look.cat_eye = i == 0 ? 0.1f : 0;
            params.look.fringe = i == 1 ? -0.1f : 0;
            params.render.aperture = i == 2 ? a : NULL;
            assert_int_equal(refocus_render_settings(renderer, &params, &image),
                             method == REFOCUS_METHOD_SWEEP ? REFOCUS_OK : REFOCUS_ERR_ARGUMENT);
            params.render.rays = REFOCUS_RAYS_FULL;
            if (i == 2)
                assert_int_equal(refocus_render_settings(renderer, &params, &image),
                                 REFOCUS_ERR_ARGUMENT);
        }
    }
    refocus_aperture_destroy(&a);
    refocus_renderer_destroy(&renderer);
}
