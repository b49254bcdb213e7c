/* test_yuv_alike.c: photos of Y, U and V come out as the same photos of R, G and B do. */
#include "yuv_pictures.h"

/* Both renderings of a picture whose colours are the same over 2 x 2 pixels. */
struct pair {
    struct refocus_renderer *renderer;
    struct picture photo;
    uint8_t *rgb; /* the result of R, G and B */
};

static struct pair pair_of(const struct picture *photo, float blur)
{
    struct refocus_renderer_params limits =
        refocus_renderer_params_default(photo->width, photo->height, blur);
    struct pair pair = {.photo = *photo};

    limits.threads = 2;
    pair.rgb = malloc(3 * (size_t)photo->width * (size_t)photo->height);
    assert_non_null(pair.rgb);
    assert_int_equal(refocus_renderer_create(&pair.renderer, &limits), REFOCUS_OK);
    return pair;
}

static void pair_free(struct pair *pair)
{
    refocus_renderer_destroy(&pair->renderer);
    free(pair->rgb);
    picture_free(&pair->photo);
}

static void render_rgb(const struct pair *pair, const struct refocus_settings *settings)
{
    const int w = pair->photo.width, h = pair->photo.height;
    const struct refocus_image in = picture_image(&pair->photo);
    const struct refocus_image out =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, pair->rgb, w, h, 3 * (ptrdiff_t)w);
    const struct refocus_disparity map = picture_disparity(&pair->photo);

    assert_int_equal(refocus_prepare(pair->renderer, &in, &map), REFOCUS_OK);
    assert_int_equal(refocus_render_settings(pair->renderer, settings, &out), REFOCUS_OK);
}

static void render_yuv(const struct pair *pair, const struct refocus_settings *settings,
                       const struct yuv_picture *in, const struct yuv_picture *out)
{
    const struct refocus_disparity map = picture_disparity(&pair->photo);

    assert_int_equal(refocus_prepare(pair->renderer, &in->image, &map), REFOCUS_OK);
    assert_int_equal(refocus_render_settings(pair->renderer, settings, &out->image), REFOCUS_OK);
}

/* A plane of grey noise, far out of focus: where chroma is neutral a mean may equal what the
 * pre-filter made of the pixel's own luma, and the pixel's code is no mean then. */
TEST(grey_texture)
{
    enum { W = 192, H = 144, K = 16, WITHIN = 4 };
    uint32_t seed = 9;
    struct picture texture = picture_flat(W, H, (const uint8_t[3]){0, 0, 0}, 0);
    struct pair pair;
    struct refocus_settings settings = refocus_settings_default(1, K);

    for (int i = 0; i < W * H; i++)
        memset(texture.rgb + 3 * i, (int)(noise(&seed) % 256), 3);
    pair = pair_of(&texture, K);
    for (int m = 0; m < 2; m++) {
        settings.render.method = m ? REFOCUS_METHOD_SEARCH : REFOCUS_METHOD_SWEEP;
        render_rgb(&pair, &settings);
        for (int i = 0; i < 4; i++) {
            struct yuv_picture in = yuv_make(yuv_formats[i], W, H, 0);
            struct yuv_picture out = yuv_make(yuv_formats[i], W, H, 0);

            in.image.range = REFOCUS_RANGE_FULL;
            for (int at = 0; at < W * H; at++)
                for (int c = 0; c < 3; c++)
                    *yuv_sample(&in.image, c, at % W, at / W) = c ? 128 : texture.rgb[3 * at];
            render_yuv(&pair, &settings, &in, &out);
            for (int at = 0; at < W * H; at++) {
                const int is = *yuv_sample(&out.image, 0, at % W, at / W);

                if (abs(is - pair.rgb[3 * at]) > WITHIN)
                    fail_msg("format %d, method %d: Y of (%d, %d) is %d, by R, G, B %d",
                             (int)yuv_formats[i], (int)settings.render.method, at % W, at / W, is,
                             pair.rgb[3 * at]);
            }
            yuv_free(&in);
            yuv_free(&out);
        }
    }
    pair_free(&pair);
}

/* Lamps of many hues by night, all of them clipped in one channel or two, few in luma. Each has a
 * skirt of scattered light around it. */
static struct picture lamps(int width, int height)
{
    static const uint8_t hue[][3] = {{255, 220, 120}, {255, 205, 60},  {230, 255, 200},
                                     {200, 225, 255}, {255, 200, 200}, {255, 255, 255}};
    struct picture p = picture_flat(width, height, (const uint8_t[3]){10, 10, 16}, 0);

    for (int n = 0; n < 24; n++) {
        const int cx = 2 * (width * (2 * (n % 6) + 1) / 24),
                  cy = 2 * (height * (2 * (n / 6) + 1) / 16);

        for (int y = cy - 12; y < cy + 12; y++)
            for (int x = cx - 12; x < cx + 12; x++) {
                const int u = x / 2 * 2 + 1 - cx, v = y / 2 * 2 + 1 - cy, r2 = u * u + v * v;
                uint8_t *const at = p.rgb + 3 * (y * width + x);

                for (int c = 0; c < 3; c++)
                    at[c] =
                        r2 < 9
                            ? hue[n % 6][c]
                            : (uint8_t)(at[c] + hue[n % 6][c] * 2 / (r2 < 120 ? 3 + r2 / 8 : 99));
            }
    }
    return p;
}

/* Lamps, whose lost light is estimated and given back, come out as R, G, B give them: Y, U and V
 * are off by this part of what that light changes of them, as roots of mean squares. */
static void lamps_by(uint32_t method, float sigma, const double within[3])
{
    enum { W = 240, H = 160, K = 10 };
    const struct picture night = lamps(W, H);
    static uint8_t without[3 * W * H];
    struct pair pair = pair_of(&night, K);
    struct refocus_settings settings = refocus_settings_default(1, K);

    settings.render.method = method;
    settings.render.sigma = sigma;
    render_rgb(&pair, &settings);
    memcpy(without, pair.rgb, sizeof without);
    settings.highlights.estimate = 1;
    render_rgb(&pair, &settings);
    for (int i = 0; i < 4; i++) {
        struct yuv_picture in = yuv_make(yuv_formats[i], W, H, 0);
        struct yuv_picture out = yuv_make(yuv_formats[i], W, H, 0);
        struct yuv_picture should = yuv_make(yuv_formats[i], W, H, 0);
        struct yuv_picture unlit = yuv_make(yuv_formats[i], W, H, 0);
        double sum[3] = {0}, light[3] = {0};

        yuv_from_picture(&in, &pair.photo);
        yuv_from_picture(&unlit, &(struct picture){W, H, without, NULL});
        yuv_from_picture(&should, &(struct picture){W, H, pair.rgb, NULL});
        render_yuv(&pair, &settings, &in, &out);
        for (int at = 0; at < 3 * W * H; at++) {
            const int c = at % 3, x = at / 3 % W, y = at / 3 / W;
            const int lit = *yuv_sample(&should.image, c, x, y);
            const int d = *yuv_sample(&out.image, c, x, y) - lit;
            const int l = lit - *yuv_sample(&unlit.image, c, x, y);

            sum[c] += d * d;
            light[c] += l * l;
        }
        for (int c = 0; c < 3; c++) {
            print_message("%s, sigma %g, format %d: %c off by %.2f codes, light by %.2f\n",
                          refocus_method_name(method), (double)sigma, (int)yuv_formats[i], "YUV"[c],
                          sqrt(sum[c] / (W * H)), sqrt(light[c] / (W * H)));
            assert_true(sum[c] <= within[c] * within[c] * light[c]);
        }
        yuv_free(&in);
        yuv_free(&out);
        yuv_free(&should);
        yuv_free(&unlit);
    }
    pair_free(&pair);
}

/* The light of 9.6 to 13, 1.2 to 4.3 and 1.0 to 2.7 codes of Y, U and V. When it was estimated of
 * luma alone and given back to that, 0.30, 1.8 and 1.4 of it were off by the sweep, 0.30, 1.1
 * and 1.1 by the search, and 0.80, 1.9 and 1.4 where eq. 5 weighs: it
 * weighs Y, U and V otherwise than R, G and B, so that there chroma is as far off as it has light.
 */
TEST(coloured_lamps)
{
    lamps_by(REFOCUS_METHOD_SWEEP, 1e30f, (const double[3]){0.1, 0.5, 0.4});
    lamps_by(REFOCUS_METHOD_SEARCH, 1e30f, (const double[3]){0.1, 0.2, 0.25});
    lamps_by(REFOCUS_METHOD_SWEEP, 200, (const double[3]){0.73, 1.2, 1.1});
}

/* A red figure in focus before a grey wall ends between the pixels that share samples of chroma:
 * the wall that it hides, and the rays beside it see, is grey. */
TEST(no_tint)
{
    enum { W = 160, H = 128, K = 14, LEFT = 41, TOP = 33, RIGHT = 101, BOTTOM = 91, WITHIN = 3 };
    struct picture p = picture_flat(W, H, (const uint8_t[3]){60, 60, 60}, 9000);
    struct refocus_settings settings = refocus_settings_default(1, K);
    struct pair pair;

    for (int y = TOP; y < BOTTOM; y++)
        for (int x = LEFT; x < RIGHT; x++) {
            memcpy(p.rgb + 3 * (y * W + x), (const uint8_t[3]){250, 90, 40}, 3);
            p.disparity[y * W + x] = 65535;
        }
    pair = pair_of(&p, K);
    for (int i = 0; i < 4; i++) {
        struct yuv_picture in = yuv_make(yuv_formats[i], W, H, 0);
        struct yuv_picture out = yuv_make(yuv_formats[i], W, H, 0);

        yuv_from_picture(&in, &p);
        render_yuv(&pair, &settings, &in, &out);
        for (int at = 0; at < W * H; at++) {
            const int x = at % W, y = at / W;

            if (x > LEFT - 2 && x <= RIGHT && y > TOP - 2 && y <= BOTTOM)
                continue;
            for (int c = 1; c < 3; c++)
                if (abs(*yuv_sample(&out.image, c, x, y) - 128) > WITHIN)
                    fail_msg("format %d: chroma %d of (%d, %d) is %d", (int)yuv_formats[i], c, x, y,
                             *yuv_sample(&out.image, c, x, y));
        }
        yuv_free(&in);
        yuv_free(&out);
    }
    pair_free(&pair);
}

/* The red of half-covered pixels of the wall beside a figure counts the same, whether the
 * lowest bit of the wall's blur, which the inpainted background has, is set or not. */
TEST(lowest_bit)
{
    enum { W = 96, H = 64, K = 14, WALL = 9000, LEFT = 31, RIGHT = 64, WITHIN = 1 };
    struct refocus_settings settings = refocus_settings_default(0.2f, K);

    for (int i = 0; i < 4; i++) {
        struct yuv_picture out[2];

        for (int odd = 0; odd < 2; odd++) { /* a 256th of a pixel of blur is 18 of disparity */
            struct picture p =
                picture_flat(W, H, (const uint8_t[3]){60, 60, 60}, (uint16_t)(WALL + 18 * odd));
            struct yuv_picture in = yuv_make(yuv_formats[i], W, H, 0);
            struct pair pair;

            for (int at = 0; at < W * H; at++) {
                const int x = at % W;

                if (x >= LEFT - 1 && x <= RIGHT)
                    memcpy(p.rgb + 3 * at, (const uint8_t[3]){155, 75, 50}, 3);
                if (x < LEFT || x >= RIGHT)
                    continue;
                memcpy(p.rgb + 3 * at, (const uint8_t[3]){250, 90, 40}, 3);
                p.disparity[at] = 65535;
            }
            pair = pair_of(&p, K);
            out[odd] = yuv_make(yuv_formats[i], W, H, 0);
            yuv_from_picture(&in, &p);
            render_yuv(&pair, &settings, &in, &out[odd]);
            yuv_free(&in);
            pair_free(&pair);
        }
        for (int at = 0; at < 3 * W * H; at++) {
            const int c = at % 3, x = at / 3 % W, y = at / 3 / W;
            const int even = *yuv_sample(&out[0].image, c, x, y);

            if (abs(*yuv_sample(&out[1].image, c, x, y) - even) > WITHIN)
                fail_msg("format %d: %c of (%d, %d) is %d, or %d", (int)yuv_formats[i], "YUV"[c], x,
                         y, even, *yuv_sample(&out[1].image, c, x, y));
        }
        yuv_free(&out[0]);
        yuv_free(&out[1]);
    }
}

/* Half-covered pixels of an antialiased red beam in focus are told by their luminance: the grey
 * wall beside them has no halo, nor is it tinted; and a region is that part of the whole. */
TEST(no_halo)
{
    enum { W = 160, H = 128, K = 14, LEFT = 64, TOP = 32, WIDE = 64, HIGH = 48 };
    const uint8_t wall[3] = {40, 40, 40};
    struct refocus_renderer_params limits = refocus_renderer_params_default(W, H, K);
    struct picture p = picture_flat(W, H, wall, 9000), share = picture_flat(W, H, wall, 9000);
    struct refocus_renderer *renderer;

    picture_line(&p, 60, 0, 0.4, 1, 40, 220);
    picture_line(&share, 60, 0, 0.4, 1, 46, 220);
    for (int at = 0; at < W * H; at++) {
        p.rgb[3 * at + 1] = (uint8_t)(40 + (p.rgb[3 * at] - 40) / 3);
        p.rgb[3 * at + 2] = 40;
    }
    limits.threads = 2;
    limits.thin = 1;
    assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_OK);
    for (int i = 0; i < 4; i++) {
        struct yuv_picture in = yuv_make(yuv_formats[i], W, H, 0);
        struct yuv_picture out[2] = {yuv_make(yuv_formats[i], W, H, 0),
                                     yuv_make(yuv_formats[i], W, H, 0)};
        struct yuv_picture part = yuv_make(yuv_formats[i], WIDE, HIGH, 0);
        const struct refocus_disparity map = picture_disparity(&p);
        struct refocus_settings settings =
            refocus_settings_default(p.disparity[H / 2 * W + 86] / 65535.0f, K);
        double sum[2][3] = {{0}};

        yuv_from_picture(&in, &p);
        assert_int_equal(refocus_prepare(renderer, &in.image, &map), REFOCUS_OK);
        for (int thin = 0; thin < 2; thin++) {
            settings.thin.enabled = (uint32_t)thin;
            assert_int_equal(refocus_render_settings(renderer, &settings, &out[thin].image),
                             REFOCUS_OK);
            for (int at = 0; at < W * H; at++)
                for (int c = 0; c < 3 && share.rgb[3 * at] == wall[0]; c++)
                    sum[thin][c] += abs(*yuv_sample(&out[thin].image, c, at % W, at / W) -
                                        *yuv_sample(&in.image, c, at % W, at / W));
        }
        printf("format %d: Y, U, V off by %.0f %.0f %.0f, by rays %.0f %.0f %.0f\n",
               (int)yuv_formats[i], sum[1][0], sum[1][1], sum[1][2], sum[0][0], sum[0][1],
               sum[0][2]);
        for (int c = 0; c < 3; c++)
            assert_true(sum[1][c] < sum[0][c] / 3);
        settings.render.region_x = LEFT;
        settings.render.region_y = TOP;
        settings.render.region_width = WIDE;
        settings.render.region_height = HIGH;
        assert_int_equal(refocus_prepare(renderer, &in.image, &map), REFOCUS_OK);
        assert_int_equal(refocus_render_settings(renderer, &settings, &part.image), REFOCUS_OK);
        for (int at = 0; at < WIDE * HIGH; at++)
            for (int c = 0; c < 3; c++)
                assert_int_equal(*yuv_sample(&part.image, c, at % WIDE, at / WIDE),
                                 *yuv_sample(&out[1].image, c, LEFT + at % WIDE, TOP + at / WIDE));
        yuv_free(&in);
        yuv_free(&out[0]);
        yuv_free(&out[1]);
        yuv_free(&part);
    }
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
    picture_free(&share);
}
