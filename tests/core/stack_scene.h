/* stack_scene.h: focus stacks that are drawn, for tests of depth and the photo made of them.
 *
 * Surfaces carry sums of sines, which a blur of standard deviation s only makes weaker, by
 * exp(-s^2 f^2 / 2): so a frame is drawn in closed form, at any place and focus. A test includes
 * this once, after cmocka. */
#ifndef STACK_SCENE_H
#define STACK_SCENE_H

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <refocus/stack.h>

enum { W = 144, H = 96, FRAMES = 5, MOST = 9, WAVES = 20, PIXELS = W * H };

/* How a stack is drawn: where the surfaces lie, in frames, and how frames were moved. */
struct scene {
    double left, right;             /* focus of the surface on either side of the middle */
    double scale, shift_x, shift_y; /* frame k: by 1 + k scale, k shift */
    int flat;                       /* a square without texture in the right one */
    int wall;                       /* a wall without texture between them, of all rows */
    int noise;                      /* codes of noise where there is no texture, either way */
    double faint;                   /* the share of its height that texture on the right has */
    int lamp;                       /* a clipped disc on the left one */
    int walks;                      /* a grey disc crosses the photo, a frame after the other */
    double turn;                    /* frame k: by k turn, radians about the middle */
    int odd;                        /* the last frame shows another place */
};

static int frames = FRAMES; /* so many are drawn */
static uint32_t order_by;   /* enum refocus_stack_order */
static int32_t threads;     /* 0: one for each processor */
static const double *focus; /* where each frame is focused; NULL: its number */
static uint8_t frame[MOST][3 * PIXELS], photo[3 * PIXELS], confidence[PIXELS];
static uint16_t disparity[PIXELS];
static double wave[2][WAVES][4]; /* frequencies, phase, height */

static inline uint32_t next(uint32_t *seed)
{
    return (*seed = *seed * 1664525u + 1013904223u) >> 8;
}

static inline void make_waves(void)
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

enum { WALL_LEFT = 32, WALL_RIGHT = 112 };

static inline int is_flat(const struct scene *scene, double x, double y)
{
    if (scene->wall)
        return x > WALL_LEFT && x < WALL_RIGHT;
    return scene->flat && x > 84 && x < 130 && y > 20 && y < 76;
}

static inline double code_at(const struct scene *scene, double x, double y, double k)
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

        sum += w[3] * (side && scene->faint > 0 ? scene->faint : 1) * exp(-s * s * f2 / 2) *
               sin(w[0] * x + w[1] * y + w[2]);
    }
    return sum < 0 ? 0 : sum > 240 ? 240 : sum;
}

static inline void draw(const struct scene *scene)
{
    uint32_t seed = 1;

    for (int k = 0; k < frames; k++) {
        const double scale = 1 + (k - frames / 2) * scene->scale;
        const double mx = (W - 1) / 2.0, my = (H - 1) / 2.0;

        for (int i = 0; i < PIXELS; i++) {
            const double c = cos((k - frames / 2) * scene->turn) / scale;
            const double s = sin((k - frames / 2) * scene->turn) / scale;
            const double odd = scene->odd && k == frames - 1 ? 1000 : 0;
            const double u = i % W - mx - (k - frames / 2) * scene->shift_x;
            const double v = i / W - my - (k - frames / 2) * scene->shift_y;
            const double x = c * u + s * v + mx, y = c * v - s * u + my + odd;
            const int codes = is_flat(scene, i % W, i / W) ? scene->noise : 0;
            const double noise = (next(&seed) % 5 - 2.0) / 2 * (codes ? codes : 1);
            const double code = code_at(scene, x, y, focus ? focus[k] : k) + noise;
            const int rounded = (int)(code < 0 ? 0 : code > 255 ? 255 : code + 0.5);

            memset(frame[k] + 3 * i, rounded, 3);
        }
    }
}

static inline struct refocus_image image_of(int k)
{
    return refocus_image_packed(REFOCUS_FORMAT_RGB8, frame[k], W, H, 3 * W);
}

/* Frames in an order, with positions (NULL: none), through the stack. */
static inline struct refocus_stack_result run(const int *order, const double *position,
                                              uint32_t align)
{
    struct refocus_stack_params params = refocus_stack_params_default(W, H, frames);
    struct refocus_stack_result result = refocus_stack_result_default();
    struct refocus_stack *stack = NULL;

    params.align = align;
    params.order = order_by;
    params.threads = threads;
    result.photo = photo;
    result.photo_stride = 3 * W;
    result.disparity = disparity;
    result.disparity_stride = 2 * W;
    result.confidence = confidence;
    result.confidence_stride = W;
    assert_int_equal(refocus_stack_create(&stack, &params), REFOCUS_OK);
    for (int i = 0; i < frames; i++) {
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
static inline double right_share(const struct scene *scene)
{
    int right = 0, all = 0;

    for (int i = 0; i < PIXELS; i++) {
        const int x = i % W, y = i / W;
        const double d = (x < W / 2 ? scene->left : scene->right) / (frames - 1);

        if (abs(x - W / 2) < 8 || x < 6 || y < 6 || x >= W - 6 || y >= H - 6)
            continue;
        all++;
        right += fabs(disparity[i] / 65535.0 - d) < (frames == 2       ? 0.25
                                                     : frames < FRAMES ? 0.1
                                                                       : 0.06);
    }
    return (double)right / all;
}

/* Root mean square error of the photo against the scene in focus, away from the middle. */
static inline double photo_error(const struct scene *scene)
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

#endif
