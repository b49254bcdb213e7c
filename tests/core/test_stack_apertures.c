/* test_stack_apertures.c: depth of frames of one focus and several apertures, which are drawn. */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "unit_test.h"
#include <refocus/stack.h>

enum {
    W = 360,
    H = 100,
    PIXELS = W * H,
    PARTS = 3,
    PART = W / PARTS,
    MOST = 3,
    BORDER = 20, /* pixels at the sides of a part that are not looked at */
    LAMP_X = 300,
    LAMP_Y = 50,
};

/* How frames are drawn. Each part of a frame is a plane of its own: its texture goes on beyond it.
 */
struct scene {
    int frames;
    double blur[MOST][PARTS]; /* radii in pixels, from the narrowest aperture on */
    double exposure;          /* factor of the light of the wider frames; 0 is 1 */
    double falloff;           /* light that they lose in the corners, 0 to 1 */
    double shift;             /* pixels to the right, of the wider frames */
    int coarse;               /* pixels of a grain of the texture */
    int lamp;                 /* a clipped square in the last part, which is a disc in wider ones */
};

static uint8_t frame[MOST][3 * PIXELS], photo[3 * PIXELS], confidence[PIXELS];
static uint16_t disparity[PIXELS];

/* Light of a texture at whole places, 0 to 1: each grain has its own. */
static double texture(int x, int y, int coarse)
{
    const int u = (x + 4000) / coarse, v = (y + 4000) / coarse;
    uint32_t n = (uint32_t)u * 7919u + (uint32_t)v * 104729u;

    n = (n ^ n >> 13) * 2654435761u;
    n = (n ^ n >> 15) * 2246822519u;
    return 0.08 + 0.5 * ((n >> 16) & 255) / 255;
}

static double light_at(const struct scene *scene, int x, int y)
{
    if (scene->lamp && abs(x - LAMP_X) < 3 && abs(y - LAMP_Y) < 3)
        return 60;
    return texture(x, y, scene->coarse);
}

/* The mean over a disc. */
static double blurred(const struct scene *scene, int x, int y, double radius)
{
    const int reach = (int)ceil(radius);
    double sum = 0;
    int all = 0;

    for (int v = -reach; v <= reach; v++)
        for (int u = -reach; u <= reach; u++)
            if (u * u + v * v <= (radius + 0.5) * (radius + 0.5)) {
                sum += light_at(scene, x + u, y + v);
                all++;
            }
    return sum / all;
}

static uint8_t code_of(double light)
{
    const double clipped = light < 1 ? light : 1;
    const double code =
        clipped <= 0.0031308 ? 12.92 * clipped : 1.055 * pow(clipped, 1 / 2.4) - 0.055;

    return (uint8_t)(255 * code + 0.5);
}

static void draw(const struct scene *scene)
{
    for (int k = 0; k < scene->frames; k++)
        for (int i = 0; i < PIXELS; i++) {
            const double u = (double)(i % W) / W - 0.5;
            const double gain =
                k ? (scene->exposure > 0 ? scene->exposure : 1) * (1 - 4 * scene->falloff * u * u)
                  : 1;
            const int x = i % W - (k ? (int)scene->shift : 0);
            const int part = x < PART ? 0 : x < 2 * PART ? 1 : 2;
            const double light = gain * blurred(scene, x, i / W, scene->blur[k][part]);

            for (int c = 0; c < 3; c++)
                frame[k][3 * i + c] = code_of(light * (10 - 2 * c) / 10);
        }
}

static struct refocus_stack_params params_of(int frames, uint32_t kind)
{
    struct refocus_stack_params params = refocus_stack_params_default(W, H, frames);

    params.kind = kind;
    return params;
}

static struct refocus_image image_of(int k)
{
    return refocus_image_packed(REFOCUS_FORMAT_RGB8, frame[k], W, H, 3 * W);
}

/* Frames in an order, with the diameters of their apertures (NULL: none), through a stack. */
static struct refocus_stack_result run(const struct refocus_stack_params *params, const int *order,
                                       const double *diameter)
{
    struct refocus_stack_result result = refocus_stack_result_default();
    struct refocus_stack *stack = NULL;

    result.photo = photo;
    result.photo_stride = 3 * W;
    result.disparity = disparity;
    result.disparity_stride = 2 * W;
    result.confidence = confidence;
    result.confidence_stride = W;
    assert_int_equal(refocus_stack_create(&stack, params), REFOCUS_OK);
    for (int i = 0; i < params->frames; i++) {
        const int k = order ? order[i] : i;
        const struct refocus_image image = image_of(k);

        assert_int_equal(refocus_stack_add(stack, &image, diameter ? diameter[k] : (double)NAN),
                         REFOCUS_OK);
    }
    assert_int_equal(refocus_stack_finish(stack, &result), REFOCUS_OK);
    refocus_stack_destroy(&stack);
    return result;
}

/* The mean blur of the middle of a part that the map tells, in pixels of the widest frame. */
static double blur_of(const struct refocus_stack_result *result, int part, bool nearest)
{
    double sum = 0;
    int all = 0;

    for (int y = BORDER; y < H - BORDER; y++)
        for (int x = part * PART + BORDER; x < (part + 1) * PART - BORDER; x++, all++) {
            const double d = disparity[y * W + x] / 65535.0;

            sum += (nearest ? 1 - d : d) * (double)result->blur;
        }
    return sum / all;
}

static const struct scene pair = {.frames = 2, .blur = {{0}, {0, 4, 10}}, .coarse = 3};

/* Whether the parts have the blur that a scene was drawn with, within so many pixels. */
static void has_blur(const struct refocus_stack_result *result, const struct scene *scene,
                     double within)
{
    for (int part = 0; part < PARTS; part++)
        assert_true(fabs(blur_of(result, part, true) - scene->blur[scene->frames - 1][part]) <
                    within);
}

TEST(finds_blur)
{
    struct refocus_stack_params params = params_of(2, REFOCUS_STACK_APERTURE_NEAREST);
    static const int reversed[] = {1, 0};
    struct refocus_stack_result result;

    draw(&pair);
    result = run(&params, NULL, NULL);
    has_blur(&result, &pair, 0.6);
    assert_true(result.measured > 0.9f);
    assert_true(result.moved == 0 && result.moving == 0);
    assert_int_equal(result.reference, 1);
    assert_memory_equal(photo, frame[0], sizeof photo);
    /* The other way round, the sharper one is the photo, too. */
    result = run(&params, reversed, NULL);
    has_blur(&result, &pair, 0.6);
    assert_int_equal(result.reference, 2);
    assert_int_equal(result.order[0], 2);
    assert_memory_equal(photo, frame[0], sizeof photo);
    params.kind = REFOCUS_STACK_APERTURE_FARTHEST;
    result = run(&params, NULL, NULL);
    for (int part = 0; part < PARTS; part++)
        assert_true(fabs(blur_of(&result, part, false) - pair.blur[1][part]) < 0.6);
}

/* With diameters 1, 2 and 4 radii are in these proportions; the narrowest is blurred, too. */
TEST(takes_several_apertures)
{
    static const struct scene scene = {
        .frames = 3, .blur = {{0, 1, 3}, {0, 2, 6}, {0, 4, 12}}, .coarse = 3};
    static const double diameter[] = {1, 2, 4};
    static const int order[] = {1, 2, 0};
    const struct refocus_stack_params params = params_of(3, REFOCUS_STACK_APERTURE_NEAREST);
    struct refocus_stack_result result;

    draw(&scene);
    result = run(&params, order, diameter);
    has_blur(&result, &scene, 1);
    assert_int_equal(result.reference, 3);
    assert_memory_equal(photo, frame[0], sizeof photo);
}

/* Other exposures, dark corners and a hand that moves are undone. */
TEST(takes_frames_as_lenses_make_them)
{
    const struct refocus_stack_params params = params_of(2, REFOCUS_STACK_APERTURE_NEAREST);
    struct scene scene = pair;
    struct refocus_stack_result result;

    scene.exposure = 1.3;
    draw(&scene);
    result = run(&params, NULL, NULL);
    has_blur(&result, &pair, 0.7);
    scene.exposure = 0.8;
    scene.falloff = 0.4;
    draw(&scene);
    result = run(&params, NULL, NULL);
    has_blur(&result, &pair, 0.7);
    scene = pair;
    scene.shift = 3;
    draw(&scene);
    result = run(&params, NULL, NULL);
    has_blur(&result, &pair, 1);
    assert_true(fabs((double)result.moved - 3) < 0.5);
}

/* More blur than labels have: samples become larger. */
TEST(takes_large_blur)
{
    static const struct scene scene = {.frames = 2, .blur = {{0}, {0, 15, 30}}, .coarse = 6};
    const struct refocus_stack_params params = params_of(2, REFOCUS_STACK_APERTURE_NEAREST);
    struct refocus_stack_result result;

    draw(&scene);
    result = run(&params, NULL, NULL);
    has_blur(&result, &scene, 3);
}

/* The disc of a clipped lamp tells nothing, and the place is as what is around it. */
TEST(leaves_clipped_lamps)
{
    const struct refocus_stack_params params = params_of(2, REFOCUS_STACK_APERTURE_NEAREST);
    struct scene scene = pair;
    struct refocus_stack_result result;

    scene.lamp = 1;
    draw(&scene);
    assert_true(frame[1][3 * (LAMP_Y * W + LAMP_X)] == 255);
    result = run(&params, NULL, NULL);
    has_blur(&result, &pair, 0.8);
    assert_true(confidence[LAMP_Y * W + LAMP_X] < 128);
}

TEST(tells_frames_that_are_alike)
{
    static const struct scene scene = {.frames = 2, .blur = {{0}, {0}}, .coarse = 2};
    const struct refocus_stack_params params = params_of(2, REFOCUS_STACK_APERTURE_NEAREST);
    struct refocus_stack_result result;

    draw(&scene);
    result = run(&params, NULL, NULL);
    /* All is in focus: the range is the least there is. */
    assert_true(result.blur <= 1);
    for (int part = 0; part < PARTS; part++)
        assert_true(blur_of(&result, part, true) < 0.1);
    memset(frame, 90, sizeof frame);
    assert_true(run(&params, NULL, NULL).measured == 0);
}

TEST(refuses_what_is_no_aperture)
{
    struct refocus_stack_params params = params_of(3, REFOCUS_STACK_APERTURE_FARTHEST);
    const struct refocus_image image = image_of(0);
    struct refocus_stack *stack = NULL;

    params.reference = 1;
    assert_int_equal(refocus_stack_create(&stack, &params), REFOCUS_ERR_ARGUMENT);
    params.reference = 0;
    params.kind = REFOCUS_STACK_KIND_COUNT;
    assert_int_equal(refocus_stack_create(&stack, &params), REFOCUS_ERR_ARGUMENT);
    params.kind = REFOCUS_STACK_APERTURE_FARTHEST;
    assert_int_equal(refocus_stack_create(&stack, &params), REFOCUS_OK);
    assert_int_equal(refocus_stack_add(stack, &image, (double)NAN), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_stack_add(stack, &image, 0), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_stack_add(stack, &image, -1), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_stack_add(stack, &image, (double)INFINITY), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_stack_add(stack, &image, 0.5), REFOCUS_OK);
    assert_int_equal(refocus_stack_add(stack, &image, 0.5), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_stack_add(stack, &image, 0.25), REFOCUS_OK);
    refocus_stack_destroy(&stack);
}

/* Frames of all sides from the least on, of noise: what is found has its bounds. */
TEST(takes_any_size)
{
    static const int side[][2] = {{16, 16}, {17, 240}, {240, 19}, {63, 64}, {65, 70}};

    draw(&pair);
    for (size_t i = 0; i < sizeof side / sizeof *side; i++) {
        struct refocus_stack_params params =
            refocus_stack_params_default(side[i][0], side[i][1], 2);
        struct refocus_stack_result result = refocus_stack_result_default();
        struct refocus_stack *stack = NULL;

        params.kind = REFOCUS_STACK_APERTURE_NEAREST;
        result.disparity = disparity;
        result.disparity_stride = 2 * W;
        assert_int_equal(refocus_stack_create(&stack, &params), REFOCUS_OK);
        for (int k = 0; k < 2; k++) {
            /* Not of its own shape: each row is as long as it is. */
            const struct refocus_image image =
                refocus_image_packed(REFOCUS_FORMAT_RGB8, frame[k], side[i][0], side[i][1],
                                     3 * (ptrdiff_t)(side[i][1] > H ? side[i][0] : W));

            assert_int_equal(refocus_stack_add(stack, &image, (double)NAN), REFOCUS_OK);
        }
        if (side[i][1] > H)
            result.disparity_stride = 2 * (ptrdiff_t)side[i][0];
        assert_int_equal(refocus_stack_finish(stack, &result), REFOCUS_OK);
        refocus_stack_destroy(&stack);
        assert_true(result.blur >= 1 && result.blur < 256);
    }
}

TEST(is_the_same_everywhere)
{
    struct refocus_stack_params params = params_of(2, REFOCUS_STACK_APERTURE_NEAREST);
    uint32_t hash = 0x811c9dc5u;

    /* Drawn without pow(), whose last bit differs between libraries. */
    for (int i = 0; i < 3 * PIXELS; i++) {
        const int x = i / 3 % W, y = i / 3 / W;

        frame[0][i] = (uint8_t)(255 * texture(x, y, 2));
        frame[1][i] =
            x < PART ? frame[0][i] : (uint8_t)(255 * blurred(&pair, x, y, x < 2 * PART ? 3 : 7));
    }
    for (params.threads = 1; params.threads <= 5; params.threads += 2) {
        static uint16_t first[PIXELS];

        run(&params, NULL, NULL);
        if (params.threads == 1)
            memcpy(first, disparity, sizeof first);
        assert_memory_equal(first, disparity, sizeof first);
    }
    for (int i = 0; i < PIXELS; i++)
        hash = (hash ^ disparity[i]) * 0x01000193u;
    for (int i = 0; i < PIXELS; i++)
        hash = (hash ^ confidence[i]) * 0x01000193u;
    assert_int_equal(hash, 0x653eeab8);
}
