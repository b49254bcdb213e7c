/* test_deep_light.c: light above white is drawn with all that it has, by each aperture. */
#include "deep_pictures.h"

enum { W = 300, H = 300, CX = W / 2, CY = H / 2 };

/* How highlights are drawn: as discs, by sweep and search; met by rays; as masks, discs with bright
 * edges, cat's eyes, hexagons with colour fringes. */
enum way { DISC, SEARCHED, RAYS, MASK, BUBBLE, CAT_EYE, FRINGE, WAYS };

/* The aperture of a way, which sets the look too; NULL: a disc. */
static struct refocus_aperture *aperture_of(enum way way, struct refocus_look_params *look)
{
    static const uint8_t mask[9] = {0, 255, 255, 120, 255, 255, 0, 255, 0};
    struct refocus_aperture_params shape = refocus_aperture_params_default();
    struct refocus_aperture *aperture;

    /* Rings through a cat's eye are left to the rays; this eye cuts next to nothing off. */
    shape.hole = way == RAYS ? 0.02 : 0;
    shape.mask = way == MASK ? mask : NULL;
    shape.mask_width = shape.mask_height = shape.mask_stride = way == MASK ? 3 : 0;
    shape.edge_behind = way == BUBBLE ? 0.6 : 0;
    shape.blades = way == FRINGE ? 6 : 0;
    look->cat_eye = way == RAYS ? 0.001f : way == CAT_EYE ? 0.7f : 0;
    look->fringe = way == FRINGE ? 0.2f : 0;
    if (way == DISC || way == SEARCHED || way == CAT_EYE)
        return NULL;
    assert_int_equal(refocus_aperture_create(&aperture, &shape), REFOCUS_OK);
    return aperture;
}

/* Renders a photo all of which lies at disparity 0, out of focus by `blur`. */
static struct deep render_flat(const struct deep *photo, uint32_t format, float blur, enum way way)
{
    struct deep out = deep_make(format, photo->image.width, photo->image.height);
    struct refocus_settings params = refocus_settings_default(1, blur);
    struct refocus_renderer *renderer = deep_prepare_flat(&photo->image, blur);
    struct refocus_aperture *aperture = aperture_of(way, &params.look);

    params.render.aperture = aperture;
    params.render.method = way == SEARCHED ? REFOCUS_METHOD_SEARCH : REFOCUS_METHOD_SWEEP;
    assert_int_equal(refocus_render_settings(renderer, &params, &out.image), REFOCUS_OK);
    refocus_aperture_destroy(&aperture);
    refocus_renderer_destroy(&renderer);
    return out;
}

/* A lamp of `side` pixels, `times` white, at (x, y) of a dim picture, rendered. */
static struct deep render_lamp(int x, int y, int side, float times, float around, float blur,
                               enum way way)
{
    struct deep photo = deep_make(REFOCUS_FORMAT_RGB_FLOAT, W, H), out;

    deep_fill(&photo, around);
    for (int i = 0; i < 3 * side * side; i++)
        deep_put(&photo, x - side / 2 + i / 3 % side, y - side / 2 + i / 3 / side, i % 3, times);
    out = render_flat(&photo, REFOCUS_FORMAT_RGB_FLOAT, blur, way);
    free(photo.memory);
    return out;
}

/* The light that it adds, as a part of what it has. */
static double flux(int side, float times, float blur, enum way way)
{
    const float around = 512 / 4095.0f; /* no part of a step, which discs would round */
    struct deep out = render_lamp(CX, CY, side, times, around, blur, way);
    double sum = 0;

    for (int i = 0; i < W * H; i++)
        sum += (double)deep_get(&out, i % W, i / W, 1) - (double)around;
    free(out.memory);
    return sum / (side * side * (double)(times - around));
}

/* Lamps have all of their light, drawn or met by rays, up to means of 4 times white. */
TEST(lamps)
{
    static const struct {
        int side;
        float times, blur;
        double within;
    } lamps[] = {{1, 3, 10, 0.01},    {1, 64, 10, 0.01},   {1, 8, 60, 0.01},    {1, 16, 60, 0.01},
                 {1, 64, 127, 0.01},  {9, 3, 10, 0.005},   {9, 8, 60, 0.005},   {9, 16, 60, 0.005},
                 {9, 8, 127, 0.02},   {9, 16, 127, 0.01},  {40, 3, 10, 0.005},  {40, 8, 60, 0.005},
                 {40, 16, 60, 0.005}, {40, 8, 127, 0.005}, {40, 16, 127, 0.005}};

    for (size_t i = 0; i < sizeof lamps / sizeof *lamps; i++)
        for (enum way way = DISC; way < (i < 7 ? WAYS : RAYS + 1); way++) {
            const double got = flux(lamps[i].side, lamps[i].times, lamps[i].blur, way);
            const double within = way == FRINGE ? 0.02 : lamps[i].within;

            if (fabs(got - 1) > within)
                fail_msg("a lamp of %d pixels, %g times white, has %.4f of its light at a blur of "
                         "%g, drawn by way %d",
                         lamps[i].side, (double)lamps[i].times, got, (double)lamps[i].blur, way);
        }
    /* The bound that refocus/render.h states. */
    assert_true(fabs(flux(9, 336, 127, DISC) - 1) < 0.01);
}

/* Discs of a lamp in a corner are even in their middle. */
static void expect_even(int side, float times, enum way way)
{
    struct deep out = render_lamp(200, 210, side, times, 0.0625f, 60, way);
    float least = 100, most = 0;

    for (int i = 0; i < 21 * 21; i++) {
        const float light = deep_get(&out, 190 + i % 21, 190 + i / 21, 1);

        least = light < least ? light : least;
        most = light > most ? light : most;
    }
    if (most > least * 1.004f)
        fail_msg("a lamp of %d pixels, drawn by way %d, is between %.4f and %.4f", side, way,
                 (double)least, (double)most);
    free(out.memory);
}

/* Small ones, and ones that few rays would hit. */
TEST(even_lamps)
{
    static const enum way ways[] = {DISC, CAT_EYE, FRINGE};

    expect_even(9, 16, MASK);
    for (int i = 0; i < 3; i++) {
        expect_even(9, 16, ways[i]);
        expect_even(40, 2, ways[i]);
    }
}

/* Large areas above white keep their light: plain ones, and ones with stripes, which are more runs
 * than lists hold. Nothing shows where one way of drawing them ends. */
static void expect_area(int step)
{
    struct deep photo = deep_make(REFOCUS_FORMAT_RGB_FLOAT, W, H), out;

    deep_fill(&photo, 0.25f);
    for (int i = 0; i < 3 * W * H; i++)
        if (i / 3 % W < CX && i / 3 % W % step == 0)
            deep_put(&photo, i / 3 % W, i / 3 / W, i % 3, 3);
    out = render_flat(&photo, REFOCUS_FORMAT_RGB_FLOAT, 12, DISC);
    for (int i = 0; i < W * H; i++) {
        const int x = i % W;
        /* the part of a disc left of x */
        const double u = (CX - 0.5 - x) / 12;
        const double part = u <= -1  ? 0
                            : u >= 1 ? 1
                                     : 0.5 + (u * sqrt(1 - u * u) + asin(u)) / acos(-1);
        const double got = (double)deep_get(&out, x, i / W, 0),
                     expected = 0.25 + 2.75 / step * part;

        if (i / W < 16 || i / W >= H - 16 ||
            x < 24 * (step - 1)) /* beyond the sides there is but what rays find there */
            continue;
        if (fabs(got - expected) > (part > 0 && part < 1 ? 0.1 : step > 1 ? 0.12 : 0.03))
            fail_msg("stripes of %d: pixel (%d, %d) is %.4f, expected %.4f", step, x, i / W, got,
                     expected);
    }
    free(photo.memory);
    free(out.memory);
}

TEST(large_areas)
{
    expect_area(1);
    expect_area(2);
}

/* Light that is left to the rays is the same at a blur of 1.5 pixels, whatever the largest is,
 * which blurs are stored by. */
static double mean_of_stripes(float most, uint32_t method)
{
    struct refocus_settings params = refocus_settings_default(1.5f / most, most);
    struct deep photo = deep_make(REFOCUS_FORMAT_RGB_FLOAT, W, H);
    struct deep out = deep_make(REFOCUS_FORMAT_RGB_FLOAT, W, H);
    struct refocus_renderer *renderer;
    double sum = 0;

    deep_fill(&photo, 0.25f);
    for (int i = 0; i < 3 * W * H; i++)
        if (i / 3 % 2 == 0)
            deep_put(&photo, i / 3 % W, i / 3 / W, i % 3, 3);
    renderer = deep_prepare_flat(&photo.image, most);
    params.render.method = method;
    assert_int_equal(refocus_render_settings(renderer, &params, &out.image), REFOCUS_OK);
    for (int i = 0; i < 100 * 100; i++)
        sum += (double)deep_get(&out, 100 + i % 100, 100 + i / 100, 1) / (100 * 100);
    refocus_renderer_destroy(&renderer);
    free(photo.memory);
    free(out.memory);
    return sum;
}

TEST(stripes)
{
    static const float most[] = {12, 127, 128, 300, 500};

    for (size_t i = 0; i < sizeof most / sizeof *most; i++)
        for (uint32_t method = REFOCUS_METHOD_SWEEP; method <= REFOCUS_METHOD_SEARCH; method++) {
            double mean;

            if (method == REFOCUS_METHOD_SEARCH && most[i] > REFOCUS_PLAIN_BLUR_RADIUS)
                continue;
            mean = mean_of_stripes(most[i], method);
            if (fabs(mean - 1.625) > 0.05)
                fail_msg("by %s, with blurs of up to %g pixels, stripes have a mean of %.3f, not "
                         "1.625",
                         refocus_method_name(method), (double)most[i], mean);
        }
}

/* Light of a sky, 1.5 times white, whose left half has squares of 2.5, of eight pixels: so that it
 * shows where runs of pixels are drawn with their mean. */
static float sky(int x, int y)
{
    return 1.5f + (x < CX && (x / 8 + y / 8) % 2 ? 1 : 0);
}

/* Hardly out of focus, a sky has the light that it has in focus, to its sides, and its texture. */
TEST(hardly_blurred)
{
    for (float blur = 0.4f; blur < 3; blur += 0.2f)
        for (enum way way = DISC; way <= SEARCHED; way++) {
            struct deep photo = deep_make(REFOCUS_FORMAT_RGB_FLOAT, W, H), out;

            for (int i = 0; i < 3 * W * H; i++)
                deep_put(&photo, i / 3 % W, i / 3 / W, i % 3, sky(i / 3 % W, i / 3 / W));
            out = render_flat(&photo, REFOCUS_FORMAT_RGB_FLOAT, blur, way);
            for (int i = 0; i < W * H; i++) {
                const int x = i % W, y = i / W;
                const float light = deep_get(&out, x, y, 1);

                /* Squares have their own light as far from their sides as blur reaches. */
                if (x < CX && (abs(x % 8 - 3) > 1 || abs(y % 8 - 3) > 1 || blur > 2.1f))
                    continue;
                if (fabsf(light - sky(x, y)) > 0.04f * sky(x, y) && abs(x - CX) > 8)
                    fail_msg("way %d, blur %g: (%d, %d) is %.3f, should be %.3f", way, (double)blur,
                             x, y, (double)light, (double)sky(x, y));
            }
            free(photo.memory);
            free(out.memory);
        }
}

/* How much of the disc of a pixel at (x, y), of that radius, is in the pixel at (u, v). */
static double covered(int x, int y, double radius, int u, int v)
{
    const double reach = radius - hypot(u - x, v - y) + 0.5;

    return reach <= 0 ? 0 : reach >= 1 ? 1 : reach;
}

/* A flame brighter by far in its core than around it, `times` white there: its disc is round and
 * where the core is, not spread as the flame. */
static void expect_core(float times, float blur)
{
    enum { LEFT = CX - 5, TOP = CY - 5, SIDE = 15, CORE = 3 }; /* the core is at the left */
    struct deep photo = deep_make(REFOCUS_FORMAT_RGB_FLOAT, W, H), out;
    const double pi = 3.14159265358979, each = 1 / (pi * (double)blur * (double)blur);
    double worst = 0;

    deep_fill(&photo, 0.0625f);
    for (int i = 0; i < 3 * SIDE * SIDE; i++) {
        const int x = i / 3 % SIDE, y = i / 3 / SIDE;
        const bool core = x < CORE && y >= 6 && y < 6 + CORE;

        deep_put(&photo, LEFT + x, TOP + y, i % 3, core ? times : 2);
    }
    out = render_flat(&photo, REFOCUS_FORMAT_RGB_FLOAT, blur, DISC);
    for (int i = 0; i < W * H; i++) {
        const int u = i % W, v = i / W;
        double light = 0.0625, off;

        for (int k = 0; k < SIDE * SIDE; k++) {
            const int x = LEFT + k % SIDE, y = TOP + k / SIDE;

            light += ((double)deep_get(&photo, x, y, 1) - 0.0625) * each *
                     covered(x, y, (double)blur, u, v);
        }
        off = fabs((double)deep_get(&out, u, v, 1) - light);
        worst = off > worst ? off : worst;
    }
    worst /= (double)times * CORE * CORE * each;
    if (worst > 0.2)
        fail_msg("at a blur of %g the disc of a core %g times white is off by %.2f of its light",
                 (double)blur, (double)times, worst);
    free(photo.memory);
    free(out.memory);
}

TEST(flames)
{
    expect_core(16, 8);
    expect_core(16, 20);
    expect_core(100, 40);
    expect_core(100, 60);
    expect_core(100, 100);
}
