/* live_file.c: refocuses a y4m stream, with one depth map for all of it.
 *
 *     live_file IN.y4m DEPTH.png OUT.y4m */
#include <stdio.h>
#include <stdlib.h>
#include <refocus/refocus.h>
#include <refocus/platform/convert.h>
#include <refocus/platform/file.h>
#include <refocus/platform/sink.h>
#include <refocus/platform/source.h>

enum { BLUR = 20 };
static struct refocus_reason reason;

/* End with a line when something failed. */
static void check(int status)
{
    if (status == REFOCUS_OK)
        return;
    fprintf(stderr, "%s\n", reason.text[0] ? reason.text : refocus_strerror(status));
    exit(1);
}

int main(int argc, char **argv)
{
    struct refocus_source_config config = refocus_source_config_default();
    struct refocus_render_params render = refocus_render_params_default(0.8f, BLUR);
    struct refocus_source *source;
    struct refocus_source_mode mode = refocus_source_mode_default();
    struct refocus_sink *sink;
    struct refocus_photo *depth;
    struct refocus_converter *converter;
    struct refocus_renderer *renderer;
    const struct refocus_frame *frame;
    char name[4096];

    if (argc != 4) {
        fprintf(stderr, "usage: live_file IN.y4m DEPTH.png OUT.y4m\n");
        return 2;
    }
    config.flags = REFOCUS_SOURCE_FAST;
    snprintf(name, sizeof name, "y4m:%s", argv[1]);
    check(refocus_source_open(&source, name, &reason));
    check(refocus_source_start(source, &config, &mode, &reason));
    snprintf(name, sizeof name, "y4m:%s", argv[3]);
    check(refocus_sink_open(&sink, name, &reason));
    check(refocus_sink_set_mode(sink, &mode));
    check(refocus_sink_start(sink, mode.width, mode.height, mode.fps, &reason));

    check(refocus_depth_read(&depth, argv[2], NULL, 0, 0, NULL, &reason));
    const struct refocus_depth_map *map = depth->depth;
    uint16_t *samples = malloc((size_t)map->width * (size_t)map->height * 2);
    uint8_t *in = malloc((size_t)mode.width * (size_t)mode.height * 3);
    uint8_t *out = malloc((size_t)mode.width * (size_t)mode.height * 3);
    if (!samples || !in || !out)
        check(REFOCUS_ERR_MEMORY);
    check(refocus_depth_to_disparity(map, samples, (ptrdiff_t)map->width * 2, NULL));

    const struct refocus_disparity disparity =
        refocus_disparity16(samples, map->width, map->height, (ptrdiff_t)map->width * 2);
    const struct refocus_image photo =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, in, mode.width, mode.height, mode.width * 3);
    const struct refocus_image result =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, out, mode.width, mode.height, mode.width * 3);
    const struct refocus_renderer_params make =
        refocus_renderer_params_default(mode.width, mode.height, BLUR);
    check(refocus_renderer_create(&renderer, &make));
    check(refocus_converter_create(&converter));

    while (refocus_source_wait(source, 1000, &frame, &reason) == REFOCUS_OK) {
        check(refocus_convert_rgb8(converter, frame, &photo, &reason));
        refocus_source_release(source, frame);
        check(refocus_prepare(renderer, &photo, &disparity));
        check(refocus_render(renderer, &render, &result));
        check(refocus_sink_write(sink, &result, &reason));
    }

    refocus_converter_destroy(&converter);
    refocus_renderer_destroy(&renderer);
    refocus_photo_free(&depth);
    refocus_source_close(&source);
    free(samples);
    free(in);
    free(out);
    check(refocus_sink_close(&sink, &reason));
    return 0;
}
