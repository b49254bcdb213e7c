/* frame.c: renders a scene so that instructions can be counted:
 *
 *     frame SCENE WIDTH HEIGHT K RAYS PHOTOS RENDERS [CPU [TESTS [SIGMA]]]
 *
 * RAYS is -1 for every ray. With TESTS above 0 the search renders, of so many tests; with SIGMA
 * above 0 stored values are averaged, weighted by eq. 5.
 *
 * One thread, RGB in and out. PHOTOS times it is prepared and rendered, then the last RENDERS times
 * more; highlights are splatted. The focus goes back and forth between renders, so that none can
 * rest on the one before. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <refocus/refocus.h>

#include "scene.h"

int main(int argc, char **argv)
{
    struct refocus_renderer *renderer = NULL;
    struct scene scene;
    int number[6], status = REFOCUS_OK;
    uint32_t cpu = REFOCUS_CPU_AUTO;

    for (int i = 0; i < 6; i++)
        number[i] = argc > 2 + i ? atoi(argv[2 + i]) : 0;
    while (argc > 8 && refocus_cpu_name(cpu) && strcmp(refocus_cpu_name(cpu), argv[8]) != 0)
        cpu++;
    if (argc < 8 || number[0] < 1 || number[1] < 1 ||
        !read_scene(&scene, argv[1], number[0], number[1])) {
        fprintf(stderr,
                "usage: frame SCENE WIDTH HEIGHT K RAYS PHOTOS RENDERS [CPU [TESTS [SIGMA]]]\n");
        return 2;
    }
    const struct refocus_image photo = refocus_image_packed(
        REFOCUS_FORMAT_RGB8, scene.rgb, number[0], number[1], (ptrdiff_t)number[0] * 3);
    const struct refocus_image out = refocus_image_packed(REFOCUS_FORMAT_RGB8, scene.out, number[0],
                                                          number[1], (ptrdiff_t)number[0] * 3);
    const struct refocus_disparity disparity =
        refocus_disparity16(scene.disparity, number[0], number[1], (ptrdiff_t)number[0] * 2);
    struct refocus_renderer_params params =
        refocus_renderer_params_default(number[0], number[1], (float)number[2]);
    struct refocus_settings lens = refocus_settings_default(0, (float)number[2]);

    params.threads = 1;
    params.cpu = cpu;
    lens.render.rays = number[3];
    lens.highlights.gain = 4; /* As `--highlights 4` of the command. */
    if (argc > 9 && atoi(argv[9]) > 0) {
        lens.render.method = REFOCUS_METHOD_SEARCH;
        lens.search.iterations = atoi(argv[9]);
    }
    if (argc > 10 && atoi(argv[10]) > 0) {
        lens.render.blend = REFOCUS_BLEND_STORED;
        lens.render.sigma = (float)atoi(argv[10]);
    }
    status = refocus_renderer_create(&renderer, &params);
    for (int i = 0; i < number[4] + number[5] && status == REFOCUS_OK; i++) {
        if (i < number[4])
            status = refocus_prepare(renderer, &photo, &disparity);
        if (status != REFOCUS_OK)
            break;
        lens.render.focus_disparity = i % 2 ? 0.689f : 0.689f - 1 / 512.0f;
        status = refocus_render_settings(renderer, &lens, &out);
    }
    refocus_renderer_destroy(&renderer);
    if (status != REFOCUS_OK)
        fprintf(stderr, "frame: %s\n", refocus_strerror(status));
    free(scene.rgb);
    free(scene.out);
    free(scene.disparity);
    return status != REFOCUS_OK;
}
