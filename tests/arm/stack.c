/* stack.c: makes depth of a focus stack so that instructions can be counted:
 *
 *     stack SCENE WIDTH HEIGHT FRAMES STACKS FINISHED
 *
 * One thread. FRAMES frames are rendered with K = 8, their focus even in disparity; STACKS stacks
 * are made and get them, and FINISHED of these, the last ones, are finished. */
#include <stdio.h>
#include <stdlib.h>
#include <refocus/refocus.h>

#include "scene.h"

enum { MOST = REFOCUS_STACK_MOST_FRAMES, K = 8 };

/* Renders the frames, each in memory of its own. */
static int render(const struct scene *s, uint8_t **frame, int frames)
{
    const ptrdiff_t stride = 3 * (ptrdiff_t)s->width;
    const struct refocus_image photo =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, s->rgb, s->width, s->height, stride);
    const struct refocus_disparity disparity =
        refocus_disparity16(s->disparity, s->width, s->height, 2 * (ptrdiff_t)s->width);
    struct refocus_renderer_params params = refocus_renderer_params_default(s->width, s->height, K);
    struct refocus_settings lens = refocus_settings_default(0, K);
    struct refocus_renderer *renderer = NULL;
    int status;

    params.threads = 1;
    status = refocus_renderer_create(&renderer, &params);
    if (status == REFOCUS_OK)
        status = refocus_prepare(renderer, &photo, &disparity);
    for (int k = 0; k < frames && status == REFOCUS_OK; k++) {
        const struct refocus_image out =
            refocus_image_packed(REFOCUS_FORMAT_RGB8, frame[k], s->width, s->height, stride);

        lens.render.focus_disparity = (float)k / (float)(frames - 1);
        status = refocus_render_settings(renderer, &lens, &out);
    }
    refocus_renderer_destroy(&renderer);
    return status;
}

static int make_stack(const struct scene *s, uint8_t *const *frame, int frames, bool finish)
{
    struct refocus_stack_params params = refocus_stack_params_default(s->width, s->height, frames);
    struct refocus_stack_result result = refocus_stack_result_default();
    struct refocus_stack *stack = NULL;
    int status;

    params.threads = 1;
    status = refocus_stack_create(&stack, &params);
    for (int k = 0; k < frames && status == REFOCUS_OK; k++) {
        const struct refocus_image image = refocus_image_packed(
            REFOCUS_FORMAT_RGB8, frame[k], s->width, s->height, 3 * (ptrdiff_t)s->width);

        status = refocus_stack_add(stack, &image, k);
    }
    result.photo = s->out;
    result.photo_stride = 3 * (ptrdiff_t)s->width;
    result.disparity = s->disparity;
    result.disparity_stride = 2 * (ptrdiff_t)s->width;
    if (finish && status == REFOCUS_OK)
        status = refocus_stack_finish(stack, &result);
    refocus_stack_destroy(&stack);
    return status;
}

int main(int argc, char **argv)
{
    uint8_t *frame[MOST] = {NULL};
    struct scene scene;
    int number[5], status = REFOCUS_OK;

    for (int i = 0; i < 5; i++)
        number[i] = argc > 2 + i ? atoi(argv[2 + i]) : 0;

    const int frames = number[2], stacks = number[3], finished = number[4];

    if (argc < 7 || number[0] < 16 || number[1] < 16 || frames < 2 || frames > MOST ||
        !read_scene(&scene, argv[1], number[0], number[1])) {
        fprintf(stderr, "usage: stack SCENE WIDTH HEIGHT FRAMES STACKS FINISHED\n");
        return 2;
    }
    for (int k = 0; k < frames && status == REFOCUS_OK; k++) {
        frame[k] = malloc(3 * (size_t)scene.width * (size_t)scene.height);
        status = frame[k] ? REFOCUS_OK : REFOCUS_ERR_MEMORY;
    }
    if (status == REFOCUS_OK)
        status = render(&scene, frame, frames);
    for (int i = 0; i < stacks && status == REFOCUS_OK; i++)
        status = make_stack(&scene, frame, frames, i >= stacks - finished);
    if (status != REFOCUS_OK)
        fprintf(stderr, "stack: %s\n", refocus_strerror(status));
    for (int k = 0; k < frames; k++)
        free(frame[k]);
    free(scene.rgb);
    free(scene.out);
    free(scene.disparity);
    return status != REFOCUS_OK;
}
