/* test_renderers.c: a picture is that of its photo and settings, whichever renderer makes it, and
 * whatever that has made before.
 */
#include "pictures.h"

enum { W = 200, H = 150 };
static const float K = 9;

static uint8_t expected[3 * W * H], out[3 * W * H];

/* Memory that holds what was there before. */
static void *allocate(void *user, size_t size)
{
    void *const memory = malloc(size);

    if (memory)
        memset(memory, *(const int *)user, size);
    return memory;
}

static void release(void *user, void *memory)
{
    (void)user;
    free(memory);
}

/* A photo whose every third pixel is clipped, with depth that varies as much. */
static void draw(uint8_t *rgb, uint16_t *disparity)
{
    uint32_t state = 11;

    for (int i = 0; i < W * H; i++) {
        const int x = i % W, y = i / W;

        disparity[i] = (uint16_t)((x / 6 + y / 4) % 3 * 21000 + noise(&state) % 900);
        for (int c = 0; c < 3; c++)
            rgb[3 * i + c] = (uint8_t)(noise(&state) % 3 ? 20 + noise(&state) % 60 : 255);
    }
}

/* Renders a photo of W x H pixels of any format. */
static void render_by(const struct refocus_renderer_params *limits,
                      const struct refocus_image *photo, const uint16_t *disparity,
                      const struct refocus_settings *settings, uint8_t *to)
{
    const struct refocus_disparity map = refocus_disparity16(disparity, W, H, 2 * W);
    const struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, to, W, H, 3 * W);
    struct refocus_renderer *renderer;

    memset(to, 0, 3 * W * H);
    assert_int_equal(refocus_renderer_create(&renderer, limits), REFOCUS_OK);
    assert_int_equal(refocus_prepare(renderer, photo, &map), REFOCUS_OK);
    assert_int_equal(refocus_render_settings(renderer, settings, &image), REFOCUS_OK);
    refocus_renderer_destroy(&renderer);
}

/* Renderers for larger photos, for larger blurs, and for photos with light above white. */
TEST(larger_ones)
{
    static uint8_t rgb[3 * W * H];
    static uint16_t disparity[W * H];
    static const float blurs[] = {9, 127};
    const struct refocus_image photo = refocus_image_packed(REFOCUS_FORMAT_RGB8, rgb, W, H, 3 * W);

    draw(rgb, disparity);
    for (int i = 0; i < 8; i++) {
        const float blur = blurs[i & 1];
        struct refocus_renderer_params limits = refocus_renderer_params_default(W, H, blur);
        struct refocus_settings settings = refocus_settings_default(0.1f, blur);

        settings.render.rays = 16;
        settings.render.method = i & 2 ? REFOCUS_METHOD_SEARCH : REFOCUS_METHOD_SWEEP;
        settings.highlights.estimate = i & 4 ? 1 : 0;
        render_by(&limits, &photo, disparity, &settings, expected);
        limits.max_width = 2 * W;
        limits.max_height = 3 * H;
        render_by(&limits, &photo, disparity, &settings, out);
        assert_same_pixels(out, expected, W, H, "of a renderer for larger photos");
        limits.deep = 1;
        render_by(&limits, &photo, disparity, &settings, out);
        assert_same_pixels(out, expected, W, H, "of a renderer for light above white");
        limits.deep = 0;
        limits.max_blur_radius = blur + 73; /* 200 has another table than 127 */
        render_by(&limits, &photo, disparity, &settings, out);
        assert_same_pixels(out, expected, W, H, "of a renderer for larger blurs");
    }
}

static float light[3 * W * H];

/* Light up to `most` times white, in patches. */
static struct refocus_image bright_photo(float most, uint16_t *disparity)
{
    uint32_t state = 5;

    for (int i = 0; i < W * H; i++) {
        const bool near = i % W > 60 && i % W < 130 && i / W > 40;

        disparity[i] = near ? 50000 : 8000;
        for (int c = 0; c < 3; c++)
            light[3 * i + c] =
                (noise(&state) % 29 ? 0.5f : most) * (float)(noise(&state) % 256) / 255;
    }
    return refocus_image_packed(REFOCUS_FORMAT_RGB_FLOAT, light, W, H, 12 * W);
}

/* Photos of 16 bits, one after the other, whose edges of depth are placed. */
TEST(one_after_the_other)
{
    enum { WIDTH = 480, HEIGHT = 360 };
    static uint16_t code[3 * WIDTH * HEIGHT], disparity[WIDTH * HEIGHT];
    static uint8_t first[3 * WIDTH * HEIGHT], again[3 * WIDTH * HEIGHT];
    const struct refocus_image photo =
        refocus_image_packed(REFOCUS_FORMAT_RGB16, code, WIDTH, HEIGHT, 6 * WIDTH);
    const struct refocus_disparity map = refocus_disparity16(disparity, WIDTH, HEIGHT, 2 * WIDTH);
    struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, first, WIDTH, HEIGHT, 3 * WIDTH);
    struct refocus_scene scene = refocus_scene_default(&photo, &map);
    struct refocus_renderer_params limits = refocus_renderer_params_default(WIDTH, HEIGHT, 4);
    const struct refocus_settings settings = refocus_settings_default(0.9f, 4);
    struct refocus_renderer *renderer;

    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const int x = i % WIDTH, y = i / WIDTH;

        disparity[i] = x > 150 && x < 300 && y > 80 ? 50000 : 8000;
        for (int c = 0; c < 3; c++)
            code[3 * i + c] = (uint16_t)(20000 + (x * 37 + y * 91 + c * 50) % 20000);
    }
    limits.deep = 1;
    limits.depth_edges = scene.depth_edges = REFOCUS_DEPTH_EDGES_AUTO;
    assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_OK);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(refocus_prepare_scene(renderer, &scene), REFOCUS_OK);
        assert_int_equal(refocus_render_settings(renderer, &settings, &image), REFOCUS_OK);
        image.plane[0] = again;
        if (i > 0)
            assert_same_pixels(again, first, WIDTH, HEIGHT, "of a photo that is prepared again");
    }
    refocus_renderer_destroy(&renderer);
    assert_in_range(first[0], 70, 160); /* 20000 and more of 65535 */
}

/* Background that is continued as texture, of a photo with much light above white. */
TEST(whatever_memory_held)
{
    static const int held[] = {0, 0x55, 0xff};
    static uint16_t disparity[W * H];
    const struct refocus_image photo = bright_photo(8, disparity);
    struct refocus_renderer_params limits = refocus_renderer_params_default(W, H, K);
    struct refocus_settings settings = refocus_settings_default(0.2f, K);

    for (int i = 0; i < W * H; i++)
        disparity[i] = (uint16_t)((i % W / 6 + i / W / 4) % 3 * 21000);
    limits.deep = limits.textured = 1;
    settings.render.inpaint = REFOCUS_INPAINT_TEXTURED;
    for (int i = 0; i < 3; i++) {
        limits.allocator = (struct refocus_allocator){allocate, release, (void *)&held[i]};
        render_by(&limits, &photo, disparity, &settings, i == 0 ? expected : out);
        if (i > 0)
            assert_same_pixels(out, expected, W, H, "whatever memory held");
    }
}

/* A loop of the renderer's that cancels it. */
struct canceller {
    struct refocus_renderer *renderer;
    int left; /* loops until then */
};

static void loop(void *user, void (*work)(void *context, int32_t item), void *context,
                 int32_t items)
{
    struct canceller *canceller = user;

    if (canceller->left-- == 0)
        refocus_cancel(canceller->renderer);
    for (int32_t i = 0; i < items; i++)
        work(context, i);
}

/* A render that was cancelled leaves nothing behind that the next one takes for its own. */
TEST(after_a_cancelled_one)
{
    static uint16_t disparity[W * H];
    const struct refocus_image photo = bright_photo(6, disparity);
    const struct refocus_disparity map = refocus_disparity16(disparity, W, H, 2 * W);
    const struct refocus_image image = refocus_image_packed(REFOCUS_FORMAT_RGB8, out, W, H, 3 * W);
    struct canceller canceller = {NULL, -1};
    struct refocus_renderer_params limits = refocus_renderer_params_default(W, H, K);
    struct refocus_settings settings = refocus_settings_default(0.8f, K);
    int status = REFOCUS_ERR_CANCELLED, count = 0;

    limits.deep = 1;
    limits.threads = 2;
    limits.parallel = (struct refocus_parallel){loop, &canceller};
    assert_int_equal(refocus_renderer_create(&canceller.renderer, &limits), REFOCUS_OK);
    for (settings.render.method = 0; settings.render.method < 2; settings.render.method++) {
        canceller.left = -1;
        assert_int_equal(refocus_prepare(canceller.renderer, &photo, &map), REFOCUS_OK);
        assert_int_equal(refocus_render_settings(canceller.renderer, &settings, &image),
                         REFOCUS_OK);
        memcpy(expected, out, sizeof out);
        status = REFOCUS_ERR_CANCELLED;
        for (int i = 0; status == REFOCUS_ERR_CANCELLED; i++, count++) {
            canceller.left = -1;
            assert_int_equal(refocus_prepare(canceller.renderer, &photo, &map), REFOCUS_OK);
            canceller.left = i;
            status = refocus_render_settings(canceller.renderer, &settings, &image);
            canceller.left = -1;
            assert_int_equal(refocus_render_settings(canceller.renderer, &settings, &image),
                             REFOCUS_OK);
            assert_same_pixels(out, expected, W, H, "after a cancelled one");
        }
        assert_int_equal(status, REFOCUS_OK);
    }
    assert_true(count > 10);
    refocus_renderer_destroy(&canceller.renderer);
}
