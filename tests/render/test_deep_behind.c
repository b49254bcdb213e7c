/* test_deep_behind.c: a sky brighter than white is as bright beside what stands before it as it is
 * elsewhere, which of both is in focus: what is inpainted is brighter than white, too. A lamp is
 * not spread there, and is blurred as far as it is away where something before it hides half of it.
 */
#include "deep_pictures.h"

enum { W = 240, H = 240 };
static const float sky = 2.5f, dark = 0.125f;

/* The square of the photo that stands in focus begins at (x, y). */
struct square {
    int x, y, side;
};

static bool is_before(const struct square *square, int x, int y)
{
    return x >= square->x && x < square->x + square->side && y >= square->y &&
           y < square->y + square->side;
}

/* A disparity in focus, and how the lens and what is hidden are made. */
struct lens {
    float focus, blur;
    int blades;
    uint32_t inpaint;
};

/* Renders `photo`, of which a square is near. */
static struct deep render(const struct deep *photo, const struct square *square, struct lens lens)
{
    struct deep out = deep_make(REFOCUS_FORMAT_RGB_FLOAT, W, H);
    static uint16_t map[W * H];
    const struct refocus_disparity disparity = refocus_disparity16(map, W, H, 2 * W);
    struct refocus_settings params = refocus_settings_default(lens.focus, lens.blur);
    struct refocus_aperture_params shape = refocus_aperture_params_default();
    struct refocus_renderer *renderer = deep_renderer(W, H, lens.blur, 2);
    struct refocus_aperture *aperture;

    for (int i = 0; i < W * H; i++)
        map[i] = is_before(square, i % W, i / W) ? 65535 : 0;
    shape.blades = lens.blades;
    assert_int_equal(refocus_aperture_create(&aperture, &shape), REFOCUS_OK);
    params.render.aperture = aperture;
    params.render.inpaint = lens.inpaint;
    assert_int_equal(refocus_prepare(renderer, &photo->image, &disparity), REFOCUS_OK);
    assert_int_equal(refocus_render_settings(renderer, &params, &out.image), REFOCUS_OK);
    refocus_aperture_destroy(&aperture);
    refocus_renderer_destroy(&renderer);
    return out;
}

/* Renders a dark square, `times` as bright, before `photo`. */
static struct deep render_before(const struct deep *photo, const struct square *square, float times,
                                 struct lens lens)
{
    for (int i = 0; i < W * H; i++)
        for (int c = 0; c < 3 && is_before(square, i % W, i / W); c++)
            deep_put(photo, i % W, i / W, c, times * dark);
    return render(photo, square, lens);
}

/* Compares what lies up to 30 pixels beside the square with the sky. */
static void expect_sky(struct square square, float blur, int blades)
{
    struct deep photo = deep_make(REFOCUS_FORMAT_RGB_FLOAT, W, H), out;
    double worst = 0;

    deep_fill(&photo, sky);
    out = render_before(&photo, &square, 1, (struct lens){1, blur, blades, 0});
    for (int i = 0; i < W * H; i++) {
        const int x = i % W, y = i / W;
        const double off = fabs((double)deep_get(&out, x, y, 1) / (double)sky - 1);

        if (is_before(&square, x, y))
            assert_true(deep_get(&out, x, y, 1) == dark);
        else if (x >= square.x - 30 && x < square.x + square.side + 30 && y >= square.y - 30 &&
                 y < square.y + square.side + 30)
            worst = off > worst ? off : worst;
    }
    if (worst > 0.05)
        fail_msg("beside a square at (%d, %d) the sky is off by %.3f at a blur of %g, %d blades",
                 square.x, square.y, worst, (double)blur, blades);
    free(photo.memory);
    free(out.memory);
}

/* Squares that tiles begin with, and others; one at a side of the photo, where light is left to the
 * rays. */
TEST(skies)
{
    static const struct square squares[] = {{96, 96, 64}, {90, 85, 61}, {96, 0, 64}, {90, 0, 61}};

    for (size_t i = 0; i < sizeof squares / sizeof *squares; i++) {
        expect_sky(squares[i], 6, 0);
        expect_sky(squares[i], 20, 0);
        expect_sky(squares[i], 60, 6);
    }
}

/* A blurred square before a sky in focus: the picture of a fifth of the light, which is not above
 * white, is a fifth as bright. */
static void expect_alike(const struct square *square, float blur, uint32_t inpaint)
{
    const struct lens lens = {0, blur, 0, inpaint};
    struct deep photo = deep_make(REFOCUS_FORMAT_RGB_FLOAT, W, H), bright, fifth;

    deep_fill(&photo, sky);
    bright = render_before(&photo, square, 1, lens);
    deep_fill(&photo, sky / 5);
    fifth = render_before(&photo, square, 0.2f, lens);
    for (int k = 0; k < W * H; k++) {
        const float got = deep_get(&bright, k % W, k / W, 1);
        const float expected = 5 * deep_get(&fifth, k % W, k / W, 1);

        if (fabsf(got - expected) > 0.1f)
            fail_msg("a square at (%d, %d), a blur of %g, inpaint %u: (%d, %d) is %.3f, "
                     "expected %.3f",
                     square->x, square->y, (double)blur, (unsigned)inpaint, k % W, k / W,
                     (double)got, (double)expected);
    }
    free(bright.memory);
    free(fifth.memory);
    free(photo.memory);
}

TEST(blurred_before_a_sky)
{
    static const struct square squares[] = {{96, 96, 64}, {90, 85, 61}, {90, 0, 61}};

    for (size_t i = 0; i < sizeof squares / sizeof *squares; i++)
        for (int blur = 6; blur <= 60; blur *= 3) {
            expect_alike(&squares[i], (float)blur, REFOCUS_INPAINT_SMOOTH);
            expect_alike(&squares[i], (float)blur, REFOCUS_INPAINT_TEXTURED);
        }
}

/* A lamp that is beside the square, three pixels wide, adds no more than its own light. */
TEST(lamps)
{
    const struct square square = {96, 96, 64};
    struct deep photo = deep_make(REFOCUS_FORMAT_RGB_FLOAT, W, H), out;
    double sum = 0;

    deep_fill(&photo, dark);
    for (int i = 0; i < 3 * 9; i++)
        deep_put(&photo, 90 + i / 3 % 3, 120 + i / 9, i % 3, 30);
    out = render_before(&photo, &square, 1, (struct lens){1, 20, 0, 0});
    for (int i = 0; i < W * H; i++)
        sum += (double)deep_get(&out, i % W, i / W, 1) - (double)dark;
    assert_true(sum < 9 * 30);
    free(photo.memory);
    free(out.memory);
}

/* A photo that mixes a lamp of 4 rows at the right edge of the square, `near`, with what is behind,
 * `far`; what is in focus of it is the square. Returns the light of both pixels of a row. */
static void light_at_edge(float before, float near, float far, float light[2])
{
    const struct square square = {96, 96, 64};
    struct deep photo = deep_make(REFOCUS_FORMAT_RGB_FLOAT, W, H), out;

    deep_fill(&photo, dark);
    for (int i = 0; i < 3 * W * H; i++)
        if (is_before(&square, i / 3 % W, i / 3 / W))
            deep_put(&photo, i / 3 % W, i / 3 / W, i % 3, before);
    for (int i = 0; i < 3 * 4; i++) {
        deep_put(&photo, 159, 120 + i / 3, i % 3, near);
        deep_put(&photo, 160, 120 + i / 3, i % 3, far);
    }
    out = render(&photo, &square, (struct lens){1, 10, 0, 0});
    light[0] = deep_get(&out, 159, 121, 1);
    light[1] = deep_get(&out, 160, 121, 1);
    free(photo.memory);
    free(out.memory);
}

/* A lamp behind the square is a disc, also what the photo has of it on the square, as it is
 * brighter beyond. What is brightest on the square is the square's, and so is what is hardly
 * brighter than the rest of it. */
TEST(lamps_at_edges)
{
    float light[2];

    light_at_edge(dark, 6, 8, light);
    assert_true(light[0] < 1 && light[1] < 1);
    light_at_edge(dark, 8, 6, light);
    assert_true(light[0] == 8);
    light_at_edge(1.25f, 1.5f, 8, light);
    assert_true(light[0] == 1.5f);
}

/* One thread and four, the whole and a part, after another focus and at once: the same. */
TEST(same_bytes)
{
    enum { WIDE = 600, HIGH = 400, X = 230, Y = 150, PART = 70 };
    struct deep photo = deep_make(REFOCUS_FORMAT_RGB_FLOAT, WIDE, HIGH);
    struct deep one = deep_make(REFOCUS_FORMAT_RGB_FLOAT, WIDE, HIGH);
    struct deep other = deep_make(REFOCUS_FORMAT_RGB_FLOAT, WIDE, HIGH);
    struct deep part = deep_make(REFOCUS_FORMAT_RGB_FLOAT, PART, PART);
    uint16_t *const map = malloc(sizeof *map * WIDE * HIGH);
    const struct refocus_disparity disparity = refocus_disparity16(map, WIDE, HIGH, 2 * WIDE);
    const struct square square = {250, 100, 90};
    struct refocus_renderer *single = deep_renderer(WIDE, HIGH, 8, 1);
    struct refocus_renderer *many = deep_renderer(WIDE, HIGH, 8, 4);
    struct refocus_settings region = refocus_settings_default(1, 8);
    uint32_t seed = 3;

    assert_non_null(map);
    for (int i = 0; i < WIDE * HIGH; i++) {
        map[i] = is_before(&square, i % WIDE, i / WIDE) ? 65535 : (uint16_t)(i / WIDE * 20);
        for (int c = 0; c < 3; c++) {
            seed = seed * 1664525 + 1013904223;
            deep_put(&photo, i % WIDE, i / WIDE, c,
                     map[i] == 65535 ? dark : sky * (float)(seed >> 24) / 128);
        }
    }
    assert_int_equal(refocus_prepare(single, &photo.image, &disparity), REFOCUS_OK);
    assert_int_equal(refocus_prepare(many, &photo.image, &disparity), REFOCUS_OK);
    assert_int_equal(deep_render(single, 1, 8, &one.image), REFOCUS_OK);
    assert_int_equal(deep_render(many, 0.2f, 5, &other.image), REFOCUS_OK);
    assert_int_equal(deep_render(many, 1, 8, &other.image), REFOCUS_OK);
    assert_memory_equal(one.memory, other.memory, one.size);
    assert_int_equal(deep_render(single, 0, 8, &one.image), REFOCUS_OK);
    assert_int_equal(deep_render(many, 0, 8, &other.image), REFOCUS_OK);
    assert_memory_equal(one.memory, other.memory, one.size);
    region = refocus_settings_default(0, 8);
    region.render.region_x = X;
    region.render.region_y = Y;
    region.render.region_width = region.render.region_height = PART;
    assert_int_equal(refocus_prepare(many, &photo.image, &disparity), REFOCUS_OK);
    assert_int_equal(refocus_render_settings(many, &region, &part.image), REFOCUS_OK);
    for (int y = 0; y < PART; y++)
        assert_memory_equal(deep_at(&one, X, Y + y, 0), deep_at(&part, 0, y, 0), PART * 12);
    refocus_renderer_destroy(&single);
    refocus_renderer_destroy(&many);
    free(photo.memory);
    free(one.memory);
    free(other.memory);
    free(part.memory);
    free(map);
}
