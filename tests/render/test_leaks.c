/* test_leaks.c: surfaces are closed: nothing of the background shows through a smooth subject,
 * whatever codes its map has and wherever its blur crosses from one slab of the sweep to the
 * next. */
#include "pictures.h"
#include "yuv_pictures.h"

enum {
    WIDTH = 300,
    HEIGHT = 220,
    LEFT = 40,
    TOP = 30,
    DARK = 40,
    WHITE = 250,
    MOST = 2,
    FAINT = 20
};

/* A wavy dark subject, disparity 0.70 to 0.93, before a far white wall. Its slope is at most 58
 * codes of 65535 a pixel down and 20 across: 0.16 pixels of blur at K = 127. */
static struct picture wavy(void)
{
    struct picture p = picture_flat(WIDTH, HEIGHT, (const uint8_t[]){WHITE, WHITE, WHITE}, 1311);

    for (int y = TOP; y < HEIGHT; y++)
        for (int x = LEFT; x < WIDTH; x++) {
            const double across = 1900 * sin(x * 0.0105);
            const double down = 58.0 * y + 200 * sin((x + y) * 0.0126);

            p.disparity[y * WIDTH + x] = (uint16_t)(46500 + across + down);
            memset(p.rgb + 3 * (y * WIDTH + x), DARK, 3);
        }
    return p;
}

/* The codes of a map of 8 bits. */
static void to_8_bits(struct picture *p)
{
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        p->disparity[i] = (uint16_t)((p->disparity[i] + 128) / 257 * 257);
}

/* Pixels of the subject that are brighter than it by more than `by`, though no blur of its edge
 * reaches them. */
static int leaks(const struct picture *p, const uint8_t *rgb, float focus, float blur, int by)
{
    float most = 0;
    int count = 0;

    for (int i = 0; i < WIDTH * HEIGHT; i++)
        if (p->rgb[3 * i] == DARK)
            most = fmaxf(most, fabsf(p->disparity[i] / 65535.0f - focus) * blur);
    for (int y = TOP + (int)most + 4; y < HEIGHT; y++)
        for (int x = LEFT + (int)most + 4; x < WIDTH; x++)
            count += rgb[3 * (y * WIDTH + x)] > DARK + by;
    return count;
}

static void expect_none(const struct picture *p, const struct refocus_disparity *map, int strips,
                        const char *what)
{
    static const float blurs[] = {20, 40, 60, 80, 100, 127};
    const struct refocus_image photo = picture_image(p);
    uint8_t *rgb = malloc(3 * WIDTH * HEIGHT);
    const struct refocus_image out =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, rgb, WIDTH, HEIGHT, 3 * WIDTH);

    assert_non_null(rgb);
    for (int i = 0; i < (int)(sizeof blurs / sizeof *blurs); i++) {
        struct refocus_renderer_params limits =
            refocus_renderer_params_default(WIDTH, HEIGHT, blurs[i]);
        struct refocus_renderer *renderer;

        limits.in_place = (uint32_t)strips;
        assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_OK);
        assert_int_equal(refocus_prepare(renderer, &photo, map), REFOCUS_OK);
        for (int f = 0; f < 10; f++) {
            const float focus = 0.68f + 0.03f * (float)f;
            struct refocus_settings lens = refocus_settings_default(focus, blurs[i]);
            int found;

            lens.highlights.gain = 1;
            assert_int_equal(refocus_render_settings(renderer, &lens, &out), REFOCUS_OK);
            found = leaks(p, rgb, focus, blurs[i], MOST);
            if (found)
                fail_msg("%s, K = %g, focus %g: %d pixels", what, (double)blurs[i], (double)focus,
                         found);
        }
        refocus_renderer_destroy(&renderer);
    }
    free(rgb);
}

TEST(of_16_bits)
{
    struct picture p = wavy();
    const struct refocus_disparity map = picture_disparity(&p);

    expect_none(&p, &map, 0, "16 bits");
    picture_free(&p);
}

TEST(of_8_bits)
{
    struct picture p = wavy();
    const struct refocus_disparity map = picture_disparity(&p);

    to_8_bits(&p);
    expect_none(&p, &map, 0, "8 bits");
    expect_none(&p, &map, 1, "8 bits in strips");
    picture_free(&p);
}

/* Every third sample of each third row. */
TEST(of_8_bits_and_small)
{
    enum { COLUMNS = WIDTH / 3, ROWS = HEIGHT / 3 };
    struct picture p = wavy();
    uint8_t *small = malloc(COLUMNS * ROWS);
    struct refocus_disparity map = refocus_disparity16(NULL, COLUMNS, ROWS, COLUMNS);

    assert_non_null(small);
    for (int i = 0; i < COLUMNS * ROWS; i++)
        small[i] =
            (uint8_t)((p.disparity[(3 * (i / COLUMNS) + 1) * WIDTH + 3 * (i % COLUMNS) + 1] + 128) /
                      257);
    map.bits = 8;
    map.samples = small;
    expect_none(&p, &map, 0, "8 bits, a third of the size");
    free(small);
    picture_free(&p);
}

/* A dark subject before a white wall that turns away towards its left edge, over so many pixels, by
 * `slope` pixels of blur a pixel at K = 40: as a soft map has it. */
static struct picture turned(double slope)
{
    enum { TURNED = 40 };
    struct picture p = picture_flat(WIDTH, HEIGHT, (const uint8_t[]){WHITE, WHITE, WHITE}, 1311);

    for (int y = TOP; y < HEIGHT; y++)
        for (int x = LEFT; x < WIDTH; x++) {
            const double away = fmax(LEFT + TURNED - x, 0);

            p.disparity[y * WIDTH + x] = (uint16_t)(58982 - away * slope / 40 * 65535);
            memset(p.rgb + 3 * (y * WIDTH + x), DARK, 3);
        }
    return p;
}

/* The slabs of a steep surface overlap enough; only where it begins to turn, a few rays pass. */
TEST(of_steep_surfaces)
{
    static const double slopes[] = {0.55, 0.65, 0.75};
    uint8_t *rgb = malloc(3 * WIDTH * HEIGHT);
    const struct refocus_image out =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, rgb, WIDTH, HEIGHT, 3 * WIDTH);

    assert_non_null(rgb);
    for (int i = 0; i < 3; i++) {
        struct picture p = turned(slopes[i]);
        struct refocus_renderer *renderer = prepared(&p, 40, 1);

        for (float focus = 0.88f; focus < 0.95f; focus += 0.01f) {
            struct refocus_settings lens = refocus_settings_default(focus, 40);
            int found;

            lens.highlights.gain = 1;
            assert_int_equal(refocus_render_settings(renderer, &lens, &out), REFOCUS_OK);
            found = leaks(&p, rgb, focus, 40, FAINT);
            if (found)
                fail_msg("slope %g, focus %g: %d pixels", slopes[i], (double)focus, found);
        }
        refocus_renderer_destroy(&renderer);
        picture_free(&p);
    }
    free(rgb);
}

/* Nothing shows through in the luma of a photo of Y, U and V either. */
TEST(of_luma)
{
    struct picture p = wavy();
    struct refocus_disparity map;
    struct yuv_picture in = yuv_make(REFOCUS_FORMAT_NV12, WIDTH, HEIGHT, 0);
    struct yuv_picture out = yuv_make(REFOCUS_FORMAT_NV12, WIDTH, HEIGHT, 0);
    struct refocus_renderer_params limits = refocus_renderer_params_default(WIDTH, HEIGHT, 127);
    struct refocus_renderer *renderer;
    uint8_t *rgb = malloc(3 * WIDTH * HEIGHT);

    assert_non_null(rgb);
    to_8_bits(&p);
    map = picture_disparity(&p);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        *yuv_sample(&in.image, 0, i % WIDTH, i / WIDTH) = p.rgb[3 * i];
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        for (int c = 1; c < 3; c++)
            *yuv_sample(&in.image, c, i % WIDTH, i / WIDTH) = 128;
    assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_OK);
    assert_int_equal(refocus_prepare(renderer, &in.image, &map), REFOCUS_OK);
    for (float focus = 0.69f; focus < 0.96f; focus += 0.05f) {
        struct refocus_settings lens = refocus_settings_default(focus, 127);

        lens.highlights.gain = 1;
        assert_int_equal(refocus_render_settings(renderer, &lens, &out.image), REFOCUS_OK);
        for (int i = 0; i < WIDTH * HEIGHT; i++)
            rgb[3 * i] = *yuv_sample(&out.image, 0, i % WIDTH, i / WIDTH);
        assert_int_equal(leaks(&p, rgb, focus, 127, MOST), 0);
    }
    refocus_renderer_destroy(&renderer);
    free(rgb);
    yuv_free(&in);
    yuv_free(&out);
    picture_free(&p);
}
