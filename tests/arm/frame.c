/* frame.c: renders a scene so that instructions can be counted:
 *
 *     frame SCENE WIDTH HEIGHT K RAYS PHOTOS RENDERS [CPU [TESTS [SIGMA]]]
 *
 * RAYS is -1 for every ray. With TESTS above 0 the search renders, of so many tests; with SIGMA
 * above 0 stored values are averaged, weighted by eq. 5.
 *
 * One thread, RGB in and out. PHOTOS times it is prepared and rendered, then the last RENDERS times
 * more; highlights are splatted. SCENE is raw: two 32-bit numbers, width and height; RGB, three
 * bytes a pixel; 16-bit disparities. It is brought to WIDTH x HEIGHT by repeating pixels. The
 * focus goes back and forth between renders, so that none can rest on the one before. */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <refocus/refocus.h>

struct scene {
    int width, height;
    uint8_t *rgb, *out;
    uint16_t *disparity;
};

static bool read_scene(struct scene *s, const char *file, int width, int height)
{
    FILE *in = fopen(file, "rb");
    uint32_t size[2] = {0, 0};
    uint8_t *rgb = NULL;
    uint16_t *disparity = NULL;
    size_t pixels = 0;
    bool good =
        in && fread(size, sizeof size, 1, in) == 1 && size[0] - 1 < 65535 && size[1] - 1 < 65535;

    if (good) {
        pixels = (size_t)size[0] * size[1];
        rgb = malloc(3 * pixels);
        disparity = malloc(2 * pixels);
        good = rgb && disparity && fread(rgb, 3, pixels, in) == pixels &&
               fread(disparity, 2, pixels, in) == pixels;
    }
    *s = (struct scene){width, height, malloc((size_t)width * (size_t)height * 3),
                        malloc((size_t)width * (size_t)height * 3),
                        malloc((size_t)width * (size_t)height * 2)};
    good = good && s->rgb && s->out && s->disparity;
    for (int y = 0; good && y < height; y++) {
        for (int x = 0; x < width; x++) {
            const size_t from = (size_t)y * size[1] / (size_t)height * size[0] +
                                (size_t)x * size[0] / (size_t)width;
            const size_t to = (size_t)y * (size_t)width + (size_t)x;

            memcpy(s->rgb + 3 * to, rgb + 3 * from, 3);
            s->disparity[to] = disparity[from];
        }
    }
    free(rgb);
    free(disparity);
    if (in)
        fclose(in);
    return good;
}

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
    lens.highlights.gain = 4; /* The command line renders with this gain. */
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
