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
static void grey_texture(void **state)
{
    enum { W = 192, H = 144, K = 16, WITHIN = 4 };
    uint32_t seed = 9;
    struct picture texture = picture_flat(W, H, (const uint8_t[3]){0, 0, 0}, 0);
    struct pair pair;
    struct refocus_settings settings = refocus_settings_default(1, K);

    (void)state;
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

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(grey_texture)};

    return cmocka_run_group_tests(tests, NULL, NULL);
}
