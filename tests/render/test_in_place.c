/* test_in_place.c: strip mode: the photo stays with the caller, and the bytes are those of the
 * whole. */
#include "pictures.h"

static struct refocus_renderer *create(const struct picture *p, float blur, int in_place)
{
    struct refocus_renderer_params limits =
        refocus_renderer_params_default(p->width, p->height, blur);
    const struct refocus_image photo = picture_image(p);
    const struct refocus_disparity disparity = picture_disparity(p);
    struct refocus_renderer *renderer;

    limits.threads = 2;
    limits.in_place = limits.highlights = (uint32_t)in_place;
    limits.papers = refocus_papers();
    assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_OK);
    assert_int_equal(refocus_prepare(renderer, &photo, &disparity), REFOCUS_OK);
    return renderer;
}

static int is_quick(const struct style *style)
{
    return style->method == REFOCUS_METHOD_SWEEP && style->rays != REFOCUS_RAYS_FULL &&
           style->rays <= 64;
}

/* Bars before what is far, with noise in depth and light. */
static void draw_bars(struct picture *p, int bars)
{
    uint32_t state = 4;

    for (int i = 0; i < p->width * p->height; i++) {
        const uint32_t depth = noise(&state) % 3000;

        p->disparity[i] = (uint16_t)(i % p->width / bars % 2 ? 65535 - depth : depth);
        for (int c = 0; c < 3; c++)
            p->rgb[3 * i + c] = (uint8_t)noise(&state);
    }
}

/* Pictures of one and of several blocks come out the same, at whose sides the photo ends in all
 * ways. */
TEST(same_bytes)
{
    static const struct {
        int width, height;
        float blur;
        int bars; /* width of the bars of every other picture; 0: what picture_make() draws */
    } views[] = {{203, 190, 6, 0},  {1, 1, 6, 1},       {1, 700, 6, 0},      {700, 1, 6, 11},
                 {160, 160, 6, 0},  {161, 175, 6, 13},  {191, 333, 6, 0},    {193, 17, 6, 9},
                 {640, 480, 20, 0}, {650, 301, 40, 71}, {322, 481, 0.5f, 0}, {560, 290, 20, 39},
                 {70, 50, 127, 0},  {700, 90, 127, 99}, {403, 299, 6, 0},    {601, 290, 33, 61}};

    for (size_t v = 0; v < sizeof views / sizeof views[0]; v++) {
        const size_t size = 3 * (size_t)views[v].width * (size_t)views[v].height;
        struct refocus_renderer *whole, *strips;
        uint8_t *expected, *out;
        struct picture p;

        if (left_out(size > 3 * 403 * 299,
                     2)) /* a short run leaves out what has more than 3 x 2 blocks */
            continue;
        p = picture_make(views[v].width, views[v].height, 3);
        expected = malloc(size), out = malloc(size);
        assert_true(expected && out);
        if (views[v].bars)
            draw_bars(&p, views[v].bars);
        whole = create(&p, views[v].blur, 0);
        strips = create(&p, views[v].blur, 1);
        for (int i = 0; i < style_count; i++) {
            if (styles[i].method > REFOCUS_METHOD_JITTERED &&
                styles[i].method != REFOCUS_METHOD_BLUR)
                continue;
            if (v > 0 && !is_quick(&styles[i]))
                continue;
            /* the slow ones, that look at every pixel, of one focus */
            for (int f = is_quick(&styles[i]) ? 0 : 2; f < 3; f++) {
                if (v > 0 && left_out((int)v + i + f, 3))
                    continue;
                render_style(whole, &p, &styles[i], 0.5f * (float)f, views[v].blur, expected);
                memset(out, 0x5a, size);
                render_style(strips, &p, &styles[i], 0.5f * (float)f, views[v].blur, out);
                assert_same_pixels(out, expected, p.width, p.height, styles[i].name);
            }
        }
        refocus_renderer_destroy(&whole);
        refocus_renderer_destroy(&strips);
        free(expected);
        free(out);
        picture_free(&p);
    }
}

/* Lamps that few rays would hit, cut off by margins of blocks: how wide they are, and what lies
 * beside them, is known in all blocks. */
TEST(wide_lamps)
{
    enum { W = 700, H = 170, BLUR = 40 };
    struct picture p = picture_flat(W, H, (uint8_t[3]){20, 25, 30}, 3000);
    struct refocus_settings params = refocus_settings_default(1, BLUR);
    static uint8_t out[3][3 * W * H];

    for (int y = 70; y < 90; y++)
        for (int i = 0; i < 3 * W; i++)
            if (i / 3 % 100 > 25)
                p.rgb[3 * y * W + i] = (uint8_t)(i / 3 % 100 == 26 ? 90 : 255);
    params.render.rays = 24;
    for (int k = 0; k < 3; k++) {
        const struct refocus_image image =
            refocus_image_packed(REFOCUS_FORMAT_RGB8, out[k], W, H, 3 * W);
        struct refocus_renderer *renderer = create(&p, BLUR, k == 1);

        params.highlights.gain = k < 2 ? 8 : 1;
        assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_OK);
        refocus_renderer_destroy(&renderer);
    }
    assert_same_pixels(out[1], out[0], W, H, "in strips");
    assert_true(memcmp(out[0], out[2], sizeof out[0]) != 0);
    picture_free(&p);
}

/* A map of few codes: slopes are made of its steps, whose neighbours may lie in other blocks. */
TEST(few_codes)
{
    static const struct {
        int width, height;
        float blur;
    } views[] = {{330, 290, 9}, {403, 170, 40}, {161, 350, 1}};

    for (size_t v = 0; v < sizeof views / sizeof views[0]; v++) {
        struct picture p = picture_make(views[v].width, views[v].height, 5);
        const size_t size = 3 * (size_t)p.width * (size_t)p.height;
        struct refocus_settings params = refocus_settings_default(0.4f, views[v].blur);
        uint8_t *out[2] = {malloc(size), malloc(size)};
        uint16_t *slopes[2] = {malloc(size), malloc(size)};

        assert_true(out[0] && out[1] && slopes[0] && slopes[1]);
        params.look.grain = 1;
        for (int i = 0; i < p.width * p.height; i++) {
            const int x = i % p.width, y = i / p.width;
            const int slope = 60 * x + 37 * y + (x / 19 % 3 == 2) * 30000;

            p.disparity[i] = (uint16_t)(slope / 500 * 500);
        }
        for (int in_place = 0; in_place < 2; in_place++) {
            const struct refocus_image to = refocus_image_packed(REFOCUS_FORMAT_RGB8, out[in_place],
                                                                 p.width, p.height, 3 * p.width);
            struct refocus_renderer *renderer = create(&p, views[v].blur, in_place);

            assert_int_equal(refocus_render_settings(renderer, &params, &to), REFOCUS_OK);
            assert_int_equal(
                refocus_get_view(renderer, REFOCUS_VIEW_DISPARITY, slopes[in_place], 2 * p.width),
                REFOCUS_OK);
            refocus_renderer_destroy(&renderer);
        }
        assert_memory_equal(out[0], out[1], size);
        assert_memory_equal(slopes[0], slopes[1], size * 2 / 3);
        assert_memory_not_equal(slopes[0], p.disparity, size * 2 / 3);
        for (int i = 0; i < 2; i++) {
            free(out[i]);
            free(slopes[i]);
        }
        picture_free(&p);
    }
}

/* Formats, strides, 8-bit disparities, alpha, the views. */
TEST(formats)
{
    enum { W = 330, H = 240 };
    struct picture p = picture_make(W, H, 8);
    uint8_t *photo = malloc(5 * W * H), *map = malloc(W * H);
    uint8_t *out[2] = {calloc(1, 5 * W * H), calloc(1, 5 * W * H)};
    uint16_t *view[2] = {calloc(4, W * H), calloc(4, W * H)};
    struct refocus_renderer_params limits = refocus_renderer_params_default(W, H, 9);
    const struct refocus_settings params = refocus_settings_default(0.3f, 9);
    /* bottom up */
    struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_BGRA8, photo + 5 * W * (H - 1), W, H, -5 * W);
    const struct refocus_disparity disparity = refocus_disparity8(map, W, H, W);

    assert_true(photo && map && out[0] && out[1] && view[0] && view[1]);
    for (int i = 0; i < W * H; i++) {
        map[i] = (uint8_t)(p.disparity[i] >> 8);
        for (int c = 0; c < 4; c++)
            photo[i / W * 5 * W + i % W * 4 + c] = c < 3 ? p.rgb[3 * i + c] : (uint8_t)i;
    }
    for (int in_place = 0; in_place < 2; in_place++) {
        struct refocus_renderer *renderer;
        const struct refocus_image to =
            refocus_image_packed(REFOCUS_FORMAT_RGBA8, out[in_place], W, H, 5 * W);

        limits.in_place = limits.highlights = (uint32_t)in_place;
        limits.papers = refocus_papers();
        assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_OK);
        assert_int_equal(refocus_prepare(renderer, &image, &disparity), REFOCUS_OK);
        assert_int_equal(refocus_render_settings(renderer, &params, &to), REFOCUS_OK);
        for (uint32_t i = 0; i < 2; i++)
            assert_int_equal(refocus_get_view(renderer, i, view[in_place] + i * W * H, 2 * W),
                             REFOCUS_OK);
        refocus_renderer_destroy(&renderer);
    }
    assert_memory_equal(out[0], out[1], 5 * W * H);
    assert_memory_equal(view[0], view[1], 4 * W * H);
    for (int i = 0; i < 2; i++) {
        free(out[i]);
        free(view[i]);
    }
    free(photo);
    free(map);
    picture_free(&p);
}

TEST(refused)
{
    struct picture p = picture_make(40, 30, 8);
    const struct refocus_image photo = picture_image(&p);
    uint8_t small[6] = {0};
    const struct refocus_disparity coarse = refocus_disparity8(small, 3, 2, 3);
    const struct refocus_disparity full = refocus_disparity8(p.rgb, 40, 30, 40);
    struct refocus_renderer_params limits = refocus_renderer_params_default(40, 30, 9);
    struct refocus_settings params = refocus_settings_default(0.3f, 9);
    struct refocus_renderer *renderer;
    uint8_t out[3 * 40 * 30];
    const struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, out, 40, 30, 120);

    limits.in_place = 2;
    assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_ERR_ARGUMENT);
    limits.in_place = 1;
    limits.papers = refocus_papers();
    limits.methods = REFOCUS_METHOD_BIT(REFOCUS_METHOD_SCATTER);
    assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_ERR_ARGUMENT);
    limits.methods = 0;
    assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_OK);
    assert_int_equal(refocus_prepare(renderer, &photo, &coarse), REFOCUS_ERR_UNSUPPORTED);
    assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_ERR_STATE);
    params.render.method = REFOCUS_METHOD_SCATTER;
    assert_int_equal(refocus_prepare(renderer, &photo, &full), REFOCUS_OK);
    assert_int_equal(refocus_render_settings(renderer, &params, &image), REFOCUS_ERR_ARGUMENT);
    refocus_renderer_destroy(&renderer);
    picture_free(&p);
}
