/* format_times.c: refocus-format-times: whole frames, prepared and rendered, in each pixel
 * format by turns; the best CPU time of one thread.
 *
 * usage: refocus-format-times SCENE_FOLDER K RAYS REPEATS [SIGMA [FORMAT]]
 *
 * A line for each format: its name, and milliseconds of preparing, rendering and both. With SIGMA
 * weights of eq. 5; with FORMAT that one alone, for those who count instructions. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <refocus/refocus.h>

#include "../clock.h"
#include "png_io.h"
#include "yuv.h"

enum { FORMATS = 5 };

static const struct {
    const char *name;
    uint32_t format;
} formats[FORMATS] = {{"RGB8", REFOCUS_FORMAT_RGB8},
                      {"NV12", REFOCUS_FORMAT_NV12},
                      {"NV21", REFOCUS_FORMAT_NV21},
                      {"I420", REFOCUS_FORMAT_I420},
                      {"YUYV", REFOCUS_FORMAT_YUYV}};

struct subject {
    struct refocus_renderer *renderer;
    struct refocus_image photo, out;
    double prepare, render, both; /* ms */
};

static int set_up(struct subject *s, uint32_t format, const struct refocus_image *rgb, float blur)
{
    struct refocus_renderer_params limits =
        refocus_renderer_params_default(rgb->width, rgb->height, blur);
    const size_t bytes = (size_t)refocus_image_bytes(format, rgb->width, rgb->height);
    uint8_t *memory = malloc(2 * bytes);

    limits.threads = 1;
    *s = (struct subject){.prepare = INFINITY, .render = INFINITY, .both = INFINITY};
    if (!memory || refocus_renderer_create(&s->renderer, &limits) != REFOCUS_OK)
        return -1;
    s->photo = refocus_image_planar(format, memory, rgb->width, rgb->height);
    s->out = refocus_image_planar(format, memory + bytes, rgb->width, rgb->height);
    if (format == REFOCUS_FORMAT_RGB8)
        s->photo = *rgb;
    else
        yuv_from_rgb(rgb, &s->photo);
    return 0;
}

static int time_once(struct subject *s, const struct refocus_disparity *map,
                     const struct refocus_settings *params)
{
    const double begin = clock_ms(CLOCK_THREAD_CPUTIME_ID);
    int status = refocus_prepare(s->renderer, &s->photo, map);
    const double prepared = clock_ms(CLOCK_THREAD_CPUTIME_ID);

    if (status == REFOCUS_OK)
        status = refocus_render_settings(s->renderer, params, &s->out);
    const double end = clock_ms(CLOCK_THREAD_CPUTIME_ID);
    s->prepare = fmin(s->prepare, prepared - begin);
    s->render = fmin(s->render, end - prepared);
    s->both = fmin(s->both, end - begin);
    return status;
}

int main(int argc, char **argv)
{
    struct subject subject[FORMATS];
    struct refocus_settings params;
    char path[1200];
    int width, height, w, h;

    int first = 0, end = FORMATS;

    while (argc == 7 && first < FORMATS && strcmp(argv[6], formats[first].name))
        first++;
    if (argc == 7)
        end = first + 1;
    if (argc < 5 || argc > 7 || first == FORMATS) {
        fputs("usage: refocus-format-times SCENE_FOLDER K RAYS REPEATS [SIGMA [FORMAT]]\n", stderr);
        return 2;
    }
    snprintf(path, sizeof path, "%s/allfocus.png", argv[1]);
    uint8_t *rgb = png_io_read(path, 3, &width, &height);
    snprintf(path, sizeof path, "%s/disparity.png", argv[1]);
    uint16_t *disparity = png_io_read(path, 1, &w, &h);
    if (!rgb || !disparity)
        return 1;
    const struct refocus_image photo =
        refocus_image_planar(REFOCUS_FORMAT_RGB8, rgb, width, height);
    const struct refocus_disparity map = refocus_disparity16(disparity, w, h, 2 * (ptrdiff_t)w);

    params = refocus_settings_default(0.689f, (float)atof(argv[2]));
    params.render.rays = atoi(argv[3]);
    if (argc > 5)
        params.render.sigma = (float)atof(argv[5]);
    for (int i = first; i < end; i++)
        if (set_up(&subject[i], formats[i].format, &photo, params.render.max_blur_radius))
            return 1;
    for (int n = 0; n < atoi(argv[4]); n++)
        for (int i = first; i < end; i++)
            if (time_once(&subject[i], &map, &params) != REFOCUS_OK)
                return 1;
    for (int i = first; i < end; i++)
        printf("%s %.2f %.2f %.2f\n", formats[i].name, subject[i].prepare, subject[i].render,
               subject[i].both);
    return 0;
}
