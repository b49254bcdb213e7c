/* test_matte_camera.c: mattes as cameras give them, wider than what they are of: src/thin/given.c.
 */
#include "pictures.h"

enum { WIDTH = 160, HEIGHT = 96, PIXELS = WIDTH * HEIGHT, EDGE = 80 };
enum { NEAREST = 60000, NEAR = 45000, FAR = 8000 };
static const float K = 20;

struct scene {
    uint8_t rgb[3 * PIXELS], matte[PIXELS];
    uint16_t disparity[PIXELS];
};

/* A subject up to EDGE before a wall, and its matte, which falls off over the 40 pixels beyond. */
static void draw(struct scene *s, bool (*is_dark)(int x, int y))
{
    for (int i = 0; i < PIXELS; i++) {
        const int x = i % WIDTH, y = i / WIDTH;
        const int beyond = x - EDGE;

        memset(s->rgb + (ptrdiff_t)3 * i, is_dark(x, y) ? 30 : x < EDGE ? 120 : 210, 3);
        s->disparity[i] = x < EDGE ? NEAR : FAR;
        s->matte[i] = (uint8_t)(beyond < 0 ? 255 : beyond < 40 ? 90 * (40 - beyond) / 40 : 0);
    }
}

static bool is_print(int x, int y)
{
    return x >= EDGE && (x / 5 + y / 5) % 2 != 0;
}

static bool is_strand(int x, int y)
{
    return y % 9 < 2 && x < EDGE + 34;
}

/* Renders with the subject in focus. */
static void render(const struct scene *s, bool with_matte, uint8_t *out)
{
    struct refocus_renderer_params limits = refocus_renderer_params_default(WIDTH, HEIGHT, K);
    const struct refocus_image photo = refocus_image_packed(REFOCUS_FORMAT_RGB8, (uint8_t *)s->rgb,
                                                            WIDTH, HEIGHT, 3 * (ptrdiff_t)WIDTH);
    const struct refocus_disparity map =
        refocus_disparity16(s->disparity, WIDTH, HEIGHT, 2 * (ptrdiff_t)WIDTH);
    const struct refocus_disparity matte = refocus_disparity8(s->matte, WIDTH, HEIGHT, WIDTH);
    struct refocus_scene scene = refocus_scene_default(&photo, &map);
    const struct refocus_render_params params = refocus_render_params_default(NEAR / 65535.0f, K);
    const struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, out, WIDTH, HEIGHT, 3 * (ptrdiff_t)WIDTH);
    struct refocus_renderer *renderer;

    limits.thin = 1;
    scene.matte = with_matte ? &matte : NULL;
    assert_int_equal(refocus_renderer_create(&renderer, &limits), REFOCUS_OK);
    assert_int_equal(refocus_prepare_scene(renderer, &scene), REFOCUS_OK);
    assert_int_equal(refocus_render(renderer, &params, &image), REFOCUS_OK);
    refocus_renderer_destroy(&renderer);
}

/* How much a picture varies from pixel to pixel, in codes, beyond the subject. */
static double variation(const uint8_t *rgb)
{
    double sum = 0;
    int count = 0;

    for (int y = 10; y < HEIGHT - 10; y++)
        for (int x = EDGE + 10; x < EDGE + 36; x++, count++)
            sum += abs(rgb[3 * (y * WIDTH + x)] - rgb[3 * ((y + 1) * WIDTH + x)]);
    return sum / count;
}

static struct scene s;
static uint8_t out[3 * PIXELS], expected[3 * PIXELS];

/* Print behind the subject is blurred where the matte has a little of the subject, too. */
TEST(print)
{
    double sharp, blurred;

    draw(&s, is_print);
    render(&s, true, out);
    sharp = variation(s.rgb);
    blurred = variation(out);
    if (blurred > 0.06 * sharp)
        fail_msg("print varies by %.2f codes of %.2f", blurred, sharp);
}

/* Strands of hair before a plain wall stay: the pattern is the subject's there. Little alpha cannot
 * hold all of them. */
TEST(strands)
{
    double sharp, kept;

    draw(&s, is_strand);
    render(&s, true, out);
    sharp = variation(s.rgb);
    kept = variation(out);
    if (kept < 0.25 * sharp)
        fail_msg("strands vary by %.2f codes of %.2f", kept, sharp);
}

/* A matte that has a little of a thing before the subject, as noise does, leaves it as it is. */
TEST(in_front)
{
    enum { LEFT = 95, RIGHT = 150, TOP = 30, BOTTOM = 70, INSIDE = 16 };

    draw(&s, is_print);
    for (int y = TOP; y < BOTTOM; y++)
        for (int x = LEFT; x < RIGHT; x++) {
            const int i = y * WIDTH + x;

            memset(s.rgb + (ptrdiff_t)3 * i, 60 + 20 * ((x + y) / 4 % 2), 3);
            s.disparity[i] = NEAREST;
            s.matte[i] = 25;
        }
    render(&s, false, expected);
    render(&s, true, out);
    for (int y = TOP + INSIDE; y < BOTTOM - INSIDE; y++)
        assert_memory_equal(out + (ptrdiff_t)3 * (y * WIDTH + LEFT + INSIDE),
                            expected + (ptrdiff_t)3 * (y * WIDTH + LEFT + INSIDE),
                            3 * (RIGHT - LEFT - 2 * INSIDE));
}
