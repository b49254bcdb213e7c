/* test_yuv.c: photos of Y, U and V: what comes back as it went in, what agrees with what, what
 * is refused. */
#include "yuv_pictures.h"

static struct refocus_renderer *renderer_for(int width, int height, float blur, int threads)
{
    struct refocus_renderer_params limits = refocus_renderer_params_default(width, height, blur);
    struct refocus_renderer *renderer;

    limits.threads = threads;
    limits.papers = refocus_papers();
    assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_OK);
    return renderer;
}

static void prepare(struct refocus_renderer *renderer, const struct yuv_picture *photo,
                    const struct picture *depth)
{
    const struct refocus_disparity map = picture_disparity(depth);

    assert_int_equal(refocus_prepare(renderer, &photo->image, &map), REFOCUS_OK);
}

static void render(struct refocus_renderer *renderer, const struct refocus_settings *params,
                   const struct yuv_picture *out)
{
    assert_int_equal(refocus_render_settings(renderer, params, &out->image), REFOCUS_OK);
}

/* Every style of the methods that take Y, U and V, one after another. */
static const struct style *yuv_style(int *at)
{
    while (*at < style_count)
        if (refocus_method_traits(styles[(*at)++].method) & REFOCUS_METHOD_TAKES_YUV)
            return &styles[*at - 1];
    return NULL;
}

static void render_style_yuv(struct refocus_renderer *renderer, const struct style *style,
                             float focus, float blur, float gain, const struct yuv_picture *out)
{
    struct refocus_settings params = style_params(style, focus, blur);
    struct refocus_aperture *aperture = style_aperture(style);

    params.render.aperture = aperture;
    params.highlights.gain = gain;
    render(renderer, &params, out);
    refocus_aperture_destroy(&aperture);
}

/* Any code of Y, U and V, be it a colour or not, comes back from a picture of nothing else. */
TEST(one_colour)
{
    static const uint8_t codes[][3] = {
        {0, 0, 0},       {255, 255, 255}, {16, 128, 128}, {17, 128, 128}, {15, 127, 129},
        {235, 128, 128}, {254, 1, 254},   {0, 255, 0},    {81, 90, 240},  {41, 240, 110},
        {145, 54, 34},   {126, 128, 129}, {20, 0, 255},   {240, 16, 16},  {1, 128, 127}};
    enum { W = 37, H = 21 };
    struct picture deep = picture_make(W, H, 31);
    struct refocus_renderer *renderer = renderer_for(W, H, 11, 2);

    for (int i = 0; i < 15 * 4; i++) {
        const uint8_t *code = codes[i / 4];
        struct yuv_picture photo = yuv_make(yuv_formats[i % 4], W, H, 3);
        struct yuv_picture out = yuv_make(yuv_formats[i % 4], W, H, 0);
        const struct style *style;

        photo.image.matrix = (uint32_t)i / 4 % 2;
        photo.image.range = (uint32_t)i / 8 % 2;
        for (int y = 0; y < H; y++)
            for (int x = 0; x < W; x++)
                for (int k = 0; k < 3; k++)
                    *yuv_sample(&photo.image, k, x, y) = code[k];
        prepare(renderer, &photo, &deep);
        for (int s = 0; (style = yuv_style(&s));) {
            if (left_out(s + i, 4))
                continue;
            render_style_yuv(renderer, style, 0.35f, 11, s % 2 ? 1 : 4, &out);
            assert_same_yuv(&out.image, &photo.image, style->name);
        }
        yuv_free(&photo);
        yuv_free(&out);
    }
    refocus_renderer_destroy(&renderer);
    picture_free(&deep);
}

/* Without blur any bytes come back, whatever the size, and no others are written. */
TEST(no_blur)
{
    static const int sizes[][2] = {{61, 34}, {1, 1}, {2, 1}, {1, 2}, {17, 33}, {16, 16}, {3, 50}};

    for (int i = 0; i < 7 * 4; i++) {
        const int w = sizes[i / 4][0], h = sizes[i / 4][1];
        struct picture deep = picture_make(w, h, 21);
        struct yuv_picture photo = yuv_make(yuv_formats[i % 4], w, h, 5);
        struct yuv_picture out = yuv_make(yuv_formats[i % 4], w, h, 9);
        struct refocus_renderer *renderer = renderer_for(w, h, 3, 2);
        const struct style *style;

        yuv_noise(&photo, 17);
        prepare(renderer, &photo, &deep);
        for (int s = 0; (style = yuv_style(&s));) {
            render_style_yuv(renderer, style, 0.5f, 0, 1, &out);
            assert_same_yuv(&out.image, &photo.image, style->name);
            render_style_yuv(renderer, style, 0.5f, 0.98f, 1, &out); /* r <= 0.49 */
            assert_same_yuv(&out.image, &photo.image, style->name);
            render_style_yuv(renderer, style, 0.5f, 3, 1, &out);
            assert_margins(&out, style->name);
        }
        refocus_renderer_destroy(&renderer);
        yuv_free(&photo);
        yuv_free(&out);
        picture_free(&deep);
    }
}

/* A half near and the other far, the border at column `edge`: columns from `from` to `to` stay as
 * they are, chroma where all its pixels do. */
static void columns_stay(float focus, int edge, int from, int to)
{
    enum { W = 96, H = 40, K = 9 };
    struct picture deep = picture_make(W, H, 71);
    struct refocus_renderer *renderer = renderer_for(W, H, K, 2);

    for (int i = 0; i < W * H; i++)
        deep.disparity[i] = i % W < edge ? 65535 : 0;
    for (int i = 0; i < 4; i++) {
        struct yuv_picture photo = yuv_make(yuv_formats[i], W, H, 0);
        struct yuv_picture out = yuv_make(yuv_formats[i], W, H, 0);
        const struct style *style;

        yuv_from_picture(&photo, &deep);
        prepare(renderer, &photo, &deep);
        for (int s = 0; (style = yuv_style(&s));) {
            int changed = 0;

            if (style->method != REFOCUS_METHOD_SWEEP) /* a search may see what is not in focus */
                continue;
            render_style_yuv(renderer, style, focus, K, 1, &out);
            for (int at = 0; at < W * H * 3; at++) {
                const int x = at / 3 % W, y = at / 3 / W, c = at % 3;
                const int same =
                    *yuv_sample(&out.image, c, x, y) == *yuv_sample(&photo.image, c, x, y);
                const int left = c ? x & ~1 : x, right = c ? x | 1 : x;

                if (left >= from && right < to && !same)
                    fail_msg("%s: %c of (%d, %d) is in focus and changed", style->name, "YUV"[c], x,
                             y);
                changed += !same;
            }
            assert_true(changed > W * H / 4 || style->rays == 1);
        }
        yuv_free(&photo);
        yuv_free(&out);
    }
    refocus_renderer_destroy(&renderer);
    picture_free(&deep);
}

TEST(in_focus)
{
    columns_stay(1, 48, 0, 48);
    columns_stay(1, 47, 0, 47);
    columns_stay(0, 48, 48 + 9 + 3, 96);
    columns_stay(0, 49, 49 + 9 + 3, 96);
}

/* NV12, NV21 and I420, rows upside down and gaps between them give one result, into whichever of
 * them. */
TEST(layouts)
{
    enum { W = 75, H = 53 };
    struct picture deep = picture_make(W, H, 5);
    struct refocus_renderer *renderer = renderer_for(W, H, 12, 2);
    struct yuv_picture first = yuv_make(REFOCUS_FORMAT_NV12, W, H, 0);
    const struct style *style;

    for (int s = 0; (style = yuv_style(&s));) {
        for (int i = 0; i < 9; i++) {
            struct yuv_picture photo = yuv_make(yuv_formats[i / 3], W, H, i);
            struct yuv_picture out = yuv_make(yuv_formats[i % 3], W, H, 2 * i);

            for (int p = 0; i % 2 && p < refocus_format_planes(photo.image.format); p++) {
                const int rows = refocus_plane_rows(photo.image.format, p, H);

                photo.image.plane[p] += (rows - 1) * photo.image.stride[p];
                photo.image.stride[p] = -photo.image.stride[p];
            }
            yuv_from_picture(&photo, &deep);
            prepare(renderer, &photo, &deep);
            render_style_yuv(renderer, style, 0.4f, 12, 2, i ? &out : &first);
            if (i) {
                assert_same_yuv(&out.image, &first.image, style->name);
                assert_margins(&out, style->name);
            }
            yuv_free(&photo);
            yuv_free(&out);
        }
    }
    yuv_free(&first);
    refocus_renderer_destroy(&renderer);
    picture_free(&deep);
}

/* Grey stays grey, and its luma is that of the same picture in R, G, B, to one code. Up to 64 rays
 * what is deepest in view of half a tile, or of all of it, is taken from the background, so
 * that more rays are needed for that. */
static void grey_by(uint32_t method)
{
    enum { W = 90, H = 70 };
    struct picture p = picture_make(W, H, 8);
    struct refocus_renderer *renderer = renderer_for(W, H, 10, 1);
    struct refocus_settings params = refocus_settings_default(0.45f, 10);
    static uint8_t rgb[3 * W * H];
    const struct refocus_image out_rgb =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, rgb, W, H, 3 * W);
    const struct refocus_disparity map = picture_disparity(&p);
    struct refocus_image photo_rgb;

    params.render.method = method;
    params.render.rays = 96;
    for (int i = 0; i < W * H; i++)
        p.rgb[3 * i] = p.rgb[3 * i + 2] = p.rgb[3 * i + 1];
    photo_rgb = picture_image(&p);
    assert_int_equal(refocus_prepare(renderer, &photo_rgb, &map), REFOCUS_OK);
    assert_int_equal(refocus_render_settings(renderer, &params, &out_rgb), REFOCUS_OK);
    for (int i = 0; i < 4; i++) {
        struct yuv_picture photo = yuv_make(yuv_formats[i], W, H, 0);
        struct yuv_picture out = yuv_make(yuv_formats[i], W, H, 0);

        photo.image.range = REFOCUS_RANGE_FULL;
        for (int at = 0; at < W * H; at++) {
            *yuv_sample(&photo.image, 0, at % W, at / W) = p.rgb[3 * at];
            for (int c = 1; c < 3; c++)
                *yuv_sample(&photo.image, c, at % W, at / W) = 128;
        }
        prepare(renderer, &photo, &p);
        render(renderer, &params, &out);
        for (int at = 0; at < W * H; at++) {
            assert_in_range(1 + *yuv_sample(&out.image, 0, at % W, at / W), rgb[3 * at],
                            rgb[3 * at] + 2);
            assert_int_equal(*yuv_sample(&out.image, 1, at % W, at / W), 128);
            assert_int_equal(*yuv_sample(&out.image, 2, at % W, at / W), 128);
        }
        yuv_free(&photo);
        yuv_free(&out);
    }
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

TEST(grey)
{
    grey_by(REFOCUS_METHOD_SWEEP);
    grey_by(REFOCUS_METHOD_SEARCH);
}

/* A region is that part of the whole; one that splits samples is refused. */
TEST(regions)
{
    enum { W = 83, H = 61 };
    static const int good[][4] = {
        {0, 0, 2, 2}, {10, 6, 40, 32}, {32, 16, 51, 45}, {82, 60, 1, 1}, {16, 48, 66, 13}};
    static const int bad[][4] = {{1, 0, 4, 4}, {2, 2, 5, 4}};
    struct picture deep = picture_make(W, H, 6);
    struct refocus_renderer *renderer = renderer_for(W, H, 9, 2);

    for (int j = 0; j < 8; j++) {
        const int i = j / 2;
        struct refocus_settings params = refocus_settings_default(0.3f, 9);
        struct yuv_picture photo = yuv_make(yuv_formats[i], W, H, 0);
        struct yuv_picture whole = yuv_make(yuv_formats[i], W, H, 0);

        params.render.method = j % 2 ? REFOCUS_METHOD_SEARCH : REFOCUS_METHOD_SWEEP;
        params.highlights.gain = 3;
        yuv_from_picture(&photo, &deep);
        prepare(renderer, &photo, &deep);
        render(renderer, &params, &whole);
        for (int k = 0; k < 7; k++) {
            const int *at = k < 5 ? good[k] : bad[k - 5];
            struct yuv_picture out = yuv_make(yuv_formats[i], at[2], at[3], 7);
            const int status =
                (params.render.region_x = at[0], params.render.region_y = at[1],
                 params.render.region_width = at[2], params.render.region_height = at[3],
                 refocus_render_settings(renderer, &params, &out.image));

            assert_int_equal(status, k < 5 ? REFOCUS_OK : REFOCUS_ERR_ARGUMENT);
            assert_margins(&out, "region");
            for (int p = 0; k < 5 && p < at[2] * at[3] * 3; p++) {
                const int x = p / 3 % at[2], y = p / 3 / at[2], c = p % 3;

                assert_int_equal(*yuv_sample(&out.image, c, x, y),
                                 *yuv_sample(&whole.image, c, at[0] + x, at[1] + y));
            }
            yuv_free(&out);
        }
        params = refocus_settings_default(0.3f, 9);
        params.render.region_y = 1;
        params.render.region_width = params.render.region_height = 2;
        struct yuv_picture out = yuv_make(yuv_formats[i], 2, 2, 0);
        assert_int_equal(refocus_render_settings(renderer, &params, &out.image),
                         yuv_formats[i] == REFOCUS_FORMAT_YUYV ? REFOCUS_OK : REFOCUS_ERR_ARGUMENT);
        yuv_free(&out);
        yuv_free(&photo);
        yuv_free(&whole);
    }
    refocus_renderer_destroy(&renderer);
    picture_free(&deep);
}

/* R, G, B and Y, U, V by turns, and blends: nothing is left over from before. */
TEST(by_turns)
{
    enum { W = 66, H = 47 };
    struct picture p = picture_make(W, H, 12);
    const struct refocus_image rgb = picture_image(&p);
    const struct refocus_disparity map = picture_disparity(&p);
    struct refocus_renderer *used = renderer_for(W, H, 9, 2);
    static uint8_t out_rgb[3 * W * H], expected_rgb[3 * W * H];
    const struct refocus_image to_rgb =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, out_rgb, W, H, 3 * W);

    for (int i = 0; i < 24; i++) {
        struct refocus_settings params = refocus_settings_default(0.6f, 9);
        struct yuv_picture photo = yuv_make(yuv_formats[i % 4], W, H, 0);
        struct yuv_picture out = yuv_make(yuv_formats[i % 4], W, H, 0);
        struct yuv_picture expected = yuv_make(yuv_formats[i % 4], W, H, 0);
        struct refocus_renderer *fresh = renderer_for(W, H, 9, 1);

        params.highlights.gain = i % 2 ? 4 : 1;
        params.render.sigma = i % 3 ? 1e30f : 60;
        params.render.method = i / 4 % 2 ? REFOCUS_METHOD_SEARCH : REFOCUS_METHOD_SWEEP;
        params.search.background = i / 8 % 2;
        yuv_from_picture(&photo, &p);
        photo.image.range = (uint32_t)i / 2 % 2;
        photo.image.matrix = (uint32_t)i % 2;
        prepare(used, &photo, &p);
        for (int blend = 2; blend >= 0; blend--) {
            params.render.blend = (uint32_t)(blend + i) % 3;
            render(used, &params, &out);
        }
        prepare(fresh, &photo, &p);
        render(fresh, &params, &expected);
        assert_same_yuv(&out.image, &expected.image, "by turns");
        assert_int_equal(refocus_prepare(used, &rgb, &map), REFOCUS_OK);
        assert_int_equal(refocus_render_settings(used, &params, &to_rgb), REFOCUS_OK);
        assert_int_equal(refocus_prepare(fresh, &rgb, &map), REFOCUS_OK);
        refocus_renderer_destroy(&fresh);
        fresh = renderer_for(W, H, 9, 1);
        assert_int_equal(refocus_prepare(fresh, &rgb, &map), REFOCUS_OK);
        const struct refocus_image to_expected =
            refocus_image_packed(REFOCUS_FORMAT_RGB8, expected_rgb, W, H, 3 * W);
        assert_int_equal(refocus_render_settings(fresh, &params, &to_expected), REFOCUS_OK);
        assert_same_pixels(out_rgb, expected_rgb, W, H, "R, G, B after Y, U, V");
        refocus_renderer_destroy(&fresh);
        yuv_free(&photo);
        yuv_free(&out);
        yuv_free(&expected);
    }
    refocus_renderer_destroy(&used);
    picture_free(&p);
}

TEST(refused)
{
    enum { W = 20, H = 20 };
    struct picture p = picture_make(W, H, 3);
    const struct refocus_disparity map = picture_disparity(&p);
    struct refocus_renderer *renderer = renderer_for(W, H, 5, 1);
    struct refocus_settings params = refocus_settings_default(0.5f, 5);
    const struct refocus_image rgb = picture_image(&p);
    struct yuv_picture nv12 = yuv_make(REFOCUS_FORMAT_NV12, W, H, 0);
    struct yuv_picture yuyv = yuv_make(REFOCUS_FORMAT_YUYV, W, H, 0);
    struct yuv_picture i420 = yuv_make(REFOCUS_FORMAT_I420, W, H, 0);
    struct refocus_image wrong;

    assert_int_equal(refocus_prepare(renderer, &nv12.image, &map), REFOCUS_OK);
    assert_int_equal(refocus_render_settings(renderer, &params, &rgb), REFOCUS_ERR_UNSUPPORTED);
    assert_int_equal(refocus_render_settings(renderer, &params, &yuyv.image),
                     REFOCUS_ERR_UNSUPPORTED);
    assert_int_equal(refocus_render_settings(renderer, &params, &i420.image), REFOCUS_OK);
    params.render.method = REFOCUS_METHOD_RAYTRACE;
    assert_int_equal(refocus_render_settings(renderer, &params, &i420.image),
                     REFOCUS_ERR_UNSUPPORTED);
    params.render.method = REFOCUS_METHOD_SWEEP;
    assert_int_equal(refocus_prepare(renderer, &yuyv.image, &map), REFOCUS_OK);
    assert_int_equal(refocus_render_settings(renderer, &params, &nv12.image),
                     REFOCUS_ERR_UNSUPPORTED);
    assert_int_equal(refocus_prepare(renderer, &rgb, &map), REFOCUS_OK);
    assert_int_equal(refocus_render_settings(renderer, &params, &nv12.image),
                     REFOCUS_ERR_UNSUPPORTED);
    for (int i = 0; i < 6; i++) {
        wrong = i420.image;
        if (i < 3)
            wrong.plane[i] = NULL;
        if (i == 3)
            wrong.stride[2] = W / 2 - 1;
        if (i == 4)
            wrong.matrix = 2;
        if (i == 5)
            wrong.range = 2;
        assert_int_equal(refocus_prepare(renderer, &wrong, &map), REFOCUS_ERR_ARGUMENT);
        assert_int_equal(refocus_render_settings(renderer, &params, &rgb), REFOCUS_ERR_STATE);
    }
    yuv_free(&nv12);
    yuv_free(&yuyv);
    yuv_free(&i420);
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

static double luma_of(const uint8_t *rgb)
{
    return 16 + (65.481 * rgb[0] + 128.553 * rgb[1] + 24.966 * rgb[2]) / 255;
}

/* Colours that are the same over blocks as large as samples: luma close to what R, G, B give. */
static void like_rgb_by(uint32_t method)
{
    enum { W = 160, H = 120 };
    struct picture p = picture_make(W, H, 44);
    struct refocus_renderer *renderer = renderer_for(W, H, 10, 2);
    struct refocus_settings params = refocus_settings_default(0.2f, 10);
    const struct refocus_disparity map = picture_disparity(&p);
    static uint8_t rgb[3 * W * H];
    const struct refocus_image out_rgb =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, rgb, W, H, 3 * W);
    const struct refocus_image photo_rgb = picture_image(&p);

    params.render.method = method;
    for (int i = 0; i < W * H; i++)
        memcpy(p.rgb + 3 * i, p.rgb + 3 * (i / W / 2 * 2 * W + i % W / 2 * 2), 3);
    assert_int_equal(refocus_prepare(renderer, &photo_rgb, &map), REFOCUS_OK);
    assert_int_equal(refocus_render_settings(renderer, &params, &out_rgb), REFOCUS_OK);
    for (int i = 0; i < 4; i++) {
        struct yuv_picture photo = yuv_make(yuv_formats[i], W, H, 0);
        struct yuv_picture out = yuv_make(yuv_formats[i], W, H, 0);
        double sum = 0, bias = 0;

        yuv_from_picture(&photo, &p);
        prepare(renderer, &photo, &p);
        render(renderer, &params, &out);
        for (int at = 0; at < W * H; at++) {
            const double d = *yuv_sample(&out.image, 0, at % W, at / W) - luma_of(rgb + 3 * at);

            sum += d * d;
            bias += d;
        }
        print_message("luma of format %d: rms %.3f, bias %.3f codes\n", (int)yuv_formats[i],
                      sqrt(sum / (W * H)), bias / (W * H));
        assert_true(sum / (W * H) < 2 * 2);
        assert_true(fabs(bias / (W * H)) < 0.6);
        yuv_free(&photo);
        yuv_free(&out);
    }
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}

TEST(like_rgb)
{
    like_rgb_by(REFOCUS_METHOD_SWEEP);
    like_rgb_by(REFOCUS_METHOD_SEARCH);
}

/* The disparities of a photo with a map of any size do not depend on the largest blur, by which
 * planes lie closer together or farther apart: no picture of colours is written over while it is
 * looked at. */
TEST(same_depth_at_any_reach)
{
    enum { W = 61, H = 46 };
    static const int maps[][2] = {{30, 22}, {64, 48}, {W, H}};
    static uint16_t view[2][W * H];

    for (uint32_t edges = 0; edges <= REFOCUS_DEPTH_EDGES_STEADY; edges++) {
        for (int m = 0; m < 3; m++) {
            struct picture colours = picture_make(W, H, 5);
            struct picture depth = picture_make(maps[m][0], maps[m][1], 6);
            struct yuv_picture photo = yuv_make(yuv_formats[0], W, H, 0);

            yuv_from_picture(&photo, &colours);
            for (int k = 0; k < 2; k++) {
                struct refocus_renderer_params limits =
                    refocus_renderer_params_default(64, 48, k ? 90 : 6);
                const struct refocus_disparity map = picture_disparity(&depth);
                struct refocus_scene scene = refocus_scene_default(&photo.image, &map);
                struct refocus_renderer *renderer;

                limits.depth_edges = scene.depth_edges = edges;
                assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_OK);
                assert_int_equal(refocus_prepare_scene(renderer, &scene), REFOCUS_OK);
                refocus_get_view(renderer, REFOCUS_VIEW_DISPARITY, view[k], 2 * W);
                refocus_renderer_destroy(&renderer);
            }
            for (int at = 0; at < W * H; at++)
                if (view[0][at] != view[1][at])
                    fail_msg("edges %d, map %d: disparity %d or %d at %d,%d", (int)edges, m,
                             view[0][at], view[1][at], at % W, at / W);
            yuv_free(&photo);
            picture_free(&depth);
            picture_free(&colours);
        }
    }
}
