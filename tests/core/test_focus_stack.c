/* test_focus_stack.c: depth and the photo in focus everywhere, of focus stacks that are drawn.
 *
 * Surfaces carry sums of sines, which a blur of standard deviation s only makes weaker, by
 * exp(-s^2 f^2 / 2): so a frame is drawn in closed form, at any place and focus. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>
#include <refocus/stack.h>

enum { W = 144, H = 96, FRAMES = 5, WAVES = 20, PIXELS = W * H };

/* How a stack is drawn: where the surfaces lie, in frames, and how frames were moved. */
struct scene {
    double left, right;             /* focus of the surface on either side of the middle */
    double scale, shift_x, shift_y; /* frame k: by 1 + k scale, k shift */
    int flat;                       /* a square without texture in the right one */
    int noise;                      /* codes of noise in the square, either way */
    int lamp;                       /* a clipped disc on the left one */
    int walks;                      /* a grey disc crosses the photo, a frame after the other */
};

static uint8_t frame[FRAMES][3 * PIXELS], photo[3 * PIXELS], confidence[PIXELS];
static uint16_t disparity[PIXELS];
static double wave[2][WAVES][4]; /* frequencies, phase, height */

static uint32_t next(uint32_t *seed)
{
    return (*seed = *seed * 1664525u + 1013904223u) >> 8;
}

static void make_waves(void)
{
    uint32_t seed = 7;

    for (int side = 0; side < 2; side++)
        for (int i = 0; i < WAVES; i++) {
            const double angle = next(&seed) % 6283 / 1000.0;
            const double f = 0.4 + next(&seed) % 1000 / 700.0;

            wave[side][i][0] = f * cos(angle);
            wave[side][i][1] = f * sin(angle);
            wave[side][i][2] = next(&seed) % 6283 / 1000.0;
            wave[side][i][3] = 14;
        }
}

static int is_flat(const struct scene *scene, double x, double y)
{
    return scene->flat && x > 84 && x < 130 && y > 20 && y < 76;
}

static double code_at(const struct scene *scene, double x, double y, double k)
{
    const int side = x >= W / 2.0;
    const double away = k - (side ? scene->right : scene->left);
    const double s = fabs(away);
    double sum = 120;

    if (is_flat(scene, x, y))
        return 120;
    if (scene->lamp) {
        /* Brighter than white, so that its disc of any focus is clipped. */
        const double u = x - 36, v = y - 48, r = 3 + 2 * s;

        if (u * u + v * v < r * r)
            return 255;
    }
    if (scene->walks) {
        const double u = x - (20 + 26 * k), v = y - 48;

        if (u * u + v * v < 14 * 14)
            return 230;
    }
    for (int i = 0; i < WAVES; i++) {
        const double *w = wave[side][i];
        const double f2 = w[0] * w[0] + w[1] * w[1];

        sum += w[3] * exp(-s * s * f2 / 2) * sin(w[0] * x + w[1] * y + w[2]);
    }
    return sum < 0 ? 0 : sum > 240 ? 240 : sum;
}

static void draw(const struct scene *scene)
{
    uint32_t seed = 1;

    for (int k = 0; k < FRAMES; k++) {
        const double scale = 1 + (k - FRAMES / 2) * scene->scale;
        const double mx = (W - 1) / 2.0, my = (H - 1) / 2.0;

        for (int i = 0; i < PIXELS; i++) {
            const double x = (i % W - mx - (k - FRAMES / 2) * scene->shift_x) / scale + mx;
            const double y = (i / W - my - (k - FRAMES / 2) * scene->shift_y) / scale + my;
            const int codes = is_flat(scene, i % W, i / W) ? scene->noise : 0;
            const double noise = (next(&seed) % 5 - 2.0) / 2 * (codes ? codes : 1);
            const double code = code_at(scene, x, y, k) + noise;
            const int rounded = (int)(code < 0 ? 0 : code > 255 ? 255 : code + 0.5);

            memset(frame[k] + 3 * i, rounded, 3);
        }
    }
}

static struct refocus_image image_of(int k)
{
    return refocus_image_packed(REFOCUS_FORMAT_RGB8, frame[k], W, H, 3 * W);
}

/* Frames in an order, with positions (NULL: none), through the stack. */
static struct refocus_stack_result run(const int *order, const double *position, uint32_t align)
{
    struct refocus_stack_params params = refocus_stack_params_default(W, H, FRAMES);
    struct refocus_stack_result result = refocus_stack_result_default();
    struct refocus_stack *stack = NULL;

    params.align = align;
    result.photo = photo;
    result.photo_stride = 3 * W;
    result.disparity = disparity;
    result.disparity_stride = 2 * W;
    result.confidence = confidence;
    result.confidence_stride = W;
    assert_int_equal(refocus_stack_create(&stack, &params), REFOCUS_OK);
    for (int i = 0; i < FRAMES; i++) {
        const int k = order ? order[i] : i;
        const struct refocus_image image = image_of(k);

        assert_int_equal(refocus_stack_add(stack, &image, position ? position[k] : (double)NAN),
                         REFOCUS_OK);
    }
    assert_int_equal(refocus_stack_finish(stack, &result), REFOCUS_OK);
    refocus_stack_destroy(&stack);
    assert_null(stack);
    return result;
}

/* Share of the pixels, but those near the middle and the sides, whose disparity is right. */
static double right_share(const struct scene *scene)
{
    int right = 0, all = 0;

    for (int i = 0; i < PIXELS; i++) {
        const int x = i % W, y = i / W;
        const double d = (x < W / 2 ? scene->left : scene->right) / (FRAMES - 1);

        if (abs(x - W / 2) < 8 || x < 6 || y < 6 || x >= W - 6 || y >= H - 6)
            continue;
        all++;
        right += fabs(disparity[i] / 65535.0 - d) < 0.06;
    }
    return (double)right / all;
}

/* Root mean square error of the photo against the scene in focus, away from the middle. */
static double photo_error(const struct scene *scene)
{
    double sum = 0;
    int all = 0;

    for (int i = 0; i < PIXELS; i++) {
        const int x = i % W, y = i / W;

        if (abs(x - W / 2) < 8 || x < 6 || y < 6 || x >= W - 6 || y >= H - 6)
            continue;
        const double e =
            photo[3 * i + 1] - code_at(scene, x, y, x < W / 2 ? scene->left : scene->right);

        sum += e * e;
        all++;
    }
    return sqrt(sum / all);
}

static void finds_surfaces(void **state)
{
    static const struct scene scenes[] = {
        {.left = 0, .right = 4}, {.left = 1, .right = 3}, {.left = 2.4, .right = 0.5}};

    (void)state;
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        struct refocus_stack_result result;

        draw(&scenes[i]);
        result = run(NULL, NULL, REFOCUS_STACK_ALIGN_SIMILARITY);
        assert_true(right_share(&scenes[i]) > 0.99);
        assert_true(photo_error(&scenes[i]) < (i < 2 ? 1.5 : 8));
        assert_true(result.measured > 0.95f);
        assert_true(result.moved == 0);
    }
}

static void takes_positions(void **state)
{
    static const struct scene scene = {.left = 1, .right = 3};
    static const int order[FRAMES] = {3, 0, 4, 2, 1};
    static const double even[FRAMES] = {0.5, 1, 1.5, 2, 2.5}, uneven[FRAMES] = {0, 1, 2, 6, 10};
    static uint8_t photo_before[3 * PIXELS];
    static uint16_t before[PIXELS];

    (void)state;
    draw(&scene);
    run(NULL, NULL, REFOCUS_STACK_ALIGN_NONE);
    memcpy(before, disparity, sizeof before);
    memcpy(photo_before, photo, sizeof photo_before);
    run(order, even, REFOCUS_STACK_ALIGN_NONE);
    assert_memory_equal(before, disparity, sizeof before);
    assert_memory_equal(photo_before, photo, sizeof photo_before);
    run(order, uneven, REFOCUS_STACK_ALIGN_NONE);
    assert_true(fabs(disparity[48 * W + 36] / 65535.0 - 0.1) < 0.02);
    assert_true(fabs(disparity[48 * W + 108] / 65535.0 - 0.6) < 0.03);
}

static void tells_disorder(void **state)
{
    static const struct scene scene = {.left = 1, .right = 3, .scale = 0.003};
    static const int order[FRAMES] = {3, 0, 4, 2, 1}, reversed[FRAMES] = {4, 3, 2, 1, 0};

    (void)state;
    draw(&scene);
    assert_true(run(NULL, NULL, REFOCUS_STACK_ALIGN_SIMILARITY).disorder < 0.05f);
    assert_true(run(reversed, NULL, REFOCUS_STACK_ALIGN_SIMILARITY).disorder < 0.05f);
    assert_true(run(order, NULL, REFOCUS_STACK_ALIGN_SIMILARITY).disorder > 0.5f);
}

static void undoes_breathing_and_shake(void **state)
{
    static const struct scene scenes[] = {
        {.left = 1, .right = 3, .scale = 0.0075},
        {.left = 1, .right = 3, .shift_x = 1.3, .shift_y = -0.8},
        {.left = 3, .right = 1, .scale = -0.005, .shift_x = -0.6, .shift_y = 0.4}};

    (void)state;
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        const struct scene *s = &scenes[i];
        /* The way of the corners of the first and the last frame. */
        const double x = 2 * (fabs(s->scale) * (W - 1) / 2 + fabs(s->shift_x));
        const double y = 2 * (fabs(s->scale) * (H - 1) / 2 + fabs(s->shift_y));
        struct refocus_stack_result result;

        draw(s);
        result = run(NULL, NULL, REFOCUS_STACK_ALIGN_SIMILARITY);
        assert_true(fabs((double)result.moved - sqrt(x * x + y * y)) < 0.25);
        assert_true(right_share(s) > 0.97);
        assert_true(photo_error(s) < 6);
        run(NULL, NULL, REFOCUS_STACK_ALIGN_NONE);
        assert_true(photo_error(s) > 12);
    }
}

/* The first frame is sharp on the left, but shows nothing of the first six columns, nor the second
 * one of the first three: these are as in the reference, not smeared from beside. */
static void covers_the_border(void **state)
{
    static const struct scene scene = {.left = 0, .right = 3, .shift_x = 3};
    int wrong = 0;

    (void)state;
    draw(&scene);
    run(NULL, NULL, REFOCUS_STACK_ALIGN_SIMILARITY);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < 2; x++)
            wrong += abs(photo[3 * (y * W + x)] - frame[FRAMES / 2][3 * (y * W + x)]) > 1;
    assert_true(wrong < H / 10);
}

static void fills_what_is_flat(void **state)
{
    static const struct scene scene = {.left = 1, .right = 3, .flat = 1};

    (void)state;
    draw(&scene);
    run(NULL, NULL, REFOCUS_STACK_ALIGN_NONE);
    assert_true(right_share(&scene) > 0.98);
    assert_true(confidence[48 * W + 108] < 64);
    assert_int_equal(confidence[48 * W + 20], 255);
}

static void makes_no_blob_of_a_lamp(void **state)
{
    static const struct scene scene = {.left = 1, .right = 3, .lamp = 1};

    (void)state;
    draw(&scene);
    run(NULL, NULL, REFOCUS_STACK_ALIGN_NONE);
    assert_true(right_share(&scene) > 0.98);
}

/* Noise is as sharp in each frame. */
static void takes_no_noise_for_texture(void **state)
{
    static const struct scene scene = {.left = 1, .right = 3, .flat = 1, .noise = 12};

    (void)state;
    draw(&scene);
    run(NULL, NULL, REFOCUS_STACK_ALIGN_NONE);
    assert_true(right_share(&scene) > 0.98);
}

/* A disc that walks is in the photo once, where the reference has it, and changes no depth where it
 * was in other frames. */
static void shows_what_moves_once(void **state)
{
    static const struct scene scene = {.left = 1, .right = 3, .walks = 1},
                              without = {.left = 1, .right = 3};
    struct refocus_stack_result result;
    int wrong = 0, right = 0;

    (void)state;
    draw(&scene);
    result = run(NULL, NULL, REFOCUS_STACK_ALIGN_NONE);
    for (int i = 0; i < PIXELS; i++) {
        const int x = i % W, y = i / W;
        const int in_reference = (x - 72) * (x - 72) + (y - 48) * (y - 48) < 14 * 14;

        right += in_reference && abs(photo[3 * i] - 230) < 4;
        wrong += !in_reference && abs(x - W / 2) > 8 &&
                 fabs(photo[3 * i] - code_at(&without, x, y, x < W / 2 ? 1 : 3)) > 100;
    }
    assert_true(right > 590);
    assert_true(wrong < 40);
    assert_true(result.moving > 0.2f && result.moving < 0.9f);
    draw(&without);
    assert_true(run(NULL, NULL, REFOCUS_STACK_ALIGN_NONE).moving == 0);
}

static void says_when_frames_are_alike(void **state)
{
    struct refocus_stack_result result;

    (void)state;
    for (int k = 0; k < FRAMES; k++)
        for (int i = 0; i < 3 * PIXELS; i++)
            frame[k][i] = (uint8_t)(i * 37 % 251);
    result = run(NULL, NULL, REFOCUS_STACK_ALIGN_SIMILARITY);
    assert_true(result.measured == 0);
    memset(frame, 90, sizeof frame);
    result = run(NULL, NULL, REFOCUS_STACK_ALIGN_SIMILARITY);
    assert_true(result.measured == 0);
    assert_true(result.moved == 0);
}

/* The bytes of a stack of noise, which no library of mathematics draws. */
static void is_the_same_everywhere(void **state)
{
    uint32_t seed = 3, hash = 2166136261u;

    (void)state;
    for (int k = 0; k < FRAMES; k++)
        for (int i = 0; i < 3 * PIXELS; i++) {
            const int other = k ? frame[k - 1][i] : 128;
            const int x = i / 3 % W / 36;

            frame[k][i] = (uint8_t)(x == k ? (int)(next(&seed) & 255) : (other * 3 + 128) / 4);
        }
    run(NULL, NULL, REFOCUS_STACK_ALIGN_SIMILARITY);
    for (int i = 0; i < 3 * PIXELS; i++)
        hash = (hash ^ photo[i]) * 16777619u;
    for (int i = 0; i < PIXELS; i++)
        hash = (hash ^ disparity[i]) * 16777619u;
    assert_int_equal(hash, 0x85eb2928);
}

static void keeps_its_states(void **state)
{
    struct refocus_stack_params params = refocus_stack_params_default(W, H, 3);
    struct refocus_stack_result result = refocus_stack_result_default();
    const struct refocus_image image = image_of(0),
                               small = refocus_image_packed(REFOCUS_FORMAT_RGB8, frame[0], W - 1, H,
                                                            3 * W);
    struct refocus_stack *stack = NULL;

    (void)state;
    params.reference = 3;
    assert_int_equal(refocus_stack_create(&stack, &params), REFOCUS_OK);
    assert_int_equal(refocus_stack_finish(stack, &result), REFOCUS_ERR_STATE);
    assert_int_equal(refocus_stack_add(stack, &image, 1), REFOCUS_OK);
    assert_int_equal(refocus_stack_finish(stack, &result), REFOCUS_ERR_STATE);
    assert_int_equal(refocus_stack_add(stack, &image, 1), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_stack_add(stack, &image, (double)NAN), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_stack_add(stack, &small, 2), REFOCUS_ERR_ARGUMENT);
    assert_int_equal(refocus_stack_add(stack, &image, 2), REFOCUS_OK);
    assert_int_equal(refocus_stack_finish(stack, &result), REFOCUS_ERR_STATE);
    assert_int_equal(refocus_stack_add(stack, &image, 0), REFOCUS_OK);
    assert_int_equal(refocus_stack_add(stack, &image, 4), REFOCUS_ERR_STATE);
    assert_int_equal(refocus_stack_finish(stack, &result), REFOCUS_OK);
    assert_int_equal(refocus_stack_finish(stack, &result), REFOCUS_ERR_STATE);
    refocus_stack_destroy(&stack);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(finds_surfaces),
        cmocka_unit_test(takes_positions),
        cmocka_unit_test(tells_disorder),
        cmocka_unit_test(undoes_breathing_and_shake),
        cmocka_unit_test(covers_the_border),
        cmocka_unit_test(fills_what_is_flat),
        cmocka_unit_test(makes_no_blob_of_a_lamp),
        cmocka_unit_test(says_when_frames_are_alike),
        cmocka_unit_test(is_the_same_everywhere),
        cmocka_unit_test(keeps_its_states),

        cmocka_unit_test(takes_no_noise_for_texture),
        cmocka_unit_test(shows_what_moves_once),
    };

    make_waves();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
