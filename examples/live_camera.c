/* live_camera.c: refocuses what a camera and a depth camera see, and takes the camera up again when
 * it fails.
 *
 *     live_camera v4l2:/dev/video0 v4l2:/dev/video2 v4l2:/dev/video9 100
 *     live_camera libcamera:0      v4l2:/dev/video2 null 100 LensPosition=1.5
 *     live_camera "replay::size 320x240" "replay::format Z16;size 160x120" null 30
 *
 * Behind the number of frames, controls of the camera may be set, by the names that it has for
 * them. Here one thread does everything; `refocus live` shows how the steps overlap. */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <refocus/refocus.h>
#include <refocus/platform/convert.h>
#include <refocus/platform/sink.h>
#include <refocus/platform/source.h>

enum { BLUR = 20, NEAREST_MM = 300, FARTHEST_MM = 6000 };
static struct refocus_reason reason;

static void check(int status)
{
    if (status == REFOCUS_OK)
        return;
    fprintf(stderr, "%s\n", reason.text[0] ? reason.text : refocus_strerror(status));
    exit(1);
}

/* The next good frame, however often the device has to be opened again. */
static const struct refocus_frame *next(struct refocus_source *source)
{
    const struct timespec pause = {0, 100000000};
    const struct refocus_frame *frame;

    for (;;) {
        const int status = refocus_source_wait(source, 1000, &frame, &reason);

        if (status == REFOCUS_OK && !(frame->flags & REFOCUS_FRAME_CORRUPT))
            return frame;
        if (status == REFOCUS_OK)
            refocus_source_release(source, frame);
        else if (status == REFOCUS_ERR_GONE || status == REFOCUS_ERR_IO)
            while (refocus_source_restart(source, NULL, &reason) != REFOCUS_OK)
                nanosleep(&pause, NULL);
        else if (status != REFOCUS_ERR_TIMEOUT)
            check(status);
    }
}

/* "focus_absolute=120": the camera is told, and not the renderer. */
static void set_control(struct refocus_source *source, const char *text)
{
    char name[64];
    double value;

    if (sscanf(text, "%63[^=]=%lf", name, &value) != 2) {
        fprintf(stderr, "%s: give NAME=VALUE\n", text);
        exit(2);
    }
    check(refocus_source_set_control(source, name, value, &reason));
}

static uint16_t *read_depth(struct refocus_source *source, struct refocus_converter *converter,
                            struct refocus_disparity *disparity)
{
    static uint16_t *samples; /* millimetres, then disparities */
    const struct refocus_frame *frame = next(source);
    struct refocus_depth_map map = {.struct_size = sizeof(struct refocus_depth_map),
                                    .sample = REFOCUS_SAMPLE_U16,
                                    .meaning = REFOCUS_DEPTH_DISTANCE,
                                    .flags = REFOCUS_DEPTH_ZERO_IS_UNKNOWN,
                                    .metres_per_unit = 0.001,
                                    .near_m = NEAREST_MM / 1e3,
                                    .far_m = FARTHEST_MM / 1e3,
                                    .width = frame->width,
                                    .height = frame->height,
                                    .stride = (ptrdiff_t)frame->width * 2};
    const size_t count = (size_t)frame->width * (size_t)frame->height;

    if (!samples && !(samples = malloc(count * 4)))
        check(REFOCUS_ERR_MEMORY);
    check(refocus_convert_samples(converter, frame, samples, &reason));
    refocus_source_release(source, frame);
    map.samples = samples;
    check(refocus_depth_to_disparity(&map, samples + count, map.stride, NULL));
    *disparity = refocus_disparity16(samples + count, map.width, map.height, map.stride);
    return samples;
}

int main(int argc, char **argv)
{
    struct refocus_source *camera, *depth_camera;
    struct refocus_source_mode mode = refocus_source_mode_default();
    struct refocus_sink *sink;
    struct refocus_converter *converter;
    struct refocus_renderer *renderer;
    struct refocus_disparity disparity;
    uint16_t *samples = NULL;

    if (argc < 5) {
        fprintf(stderr, "usage: live_camera CAMERA DEPTH_CAMERA SINK FRAMES [NAME=VALUE...]\n");
        return 2;
    }
    check(refocus_source_open(&camera, argv[1], &reason));
    check(refocus_source_start(camera, NULL, &mode, &reason));
    for (int i = 5; i < argc; i++)
        set_control(camera, argv[i]);
    check(refocus_source_open(&depth_camera, argv[2], &reason));
    check(refocus_source_start(depth_camera, NULL, NULL, &reason));
    check(refocus_sink_open(&sink, argv[3], &reason));
    check(refocus_sink_start(sink, mode.width, mode.height, mode.fps, &reason));
    check(refocus_converter_create(&converter));

    uint8_t *pixels = malloc((size_t)mode.width * (size_t)mode.height * 6);
    if (!pixels)
        check(REFOCUS_ERR_MEMORY);
    const struct refocus_image photo =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, mode.width, mode.height, mode.width * 3);
    const struct refocus_image result = refocus_image_packed(
        REFOCUS_FORMAT_RGB8, pixels + (size_t)mode.width * 3 * (size_t)mode.height, mode.width,
        mode.height, mode.width * 3);
    const struct refocus_renderer_params make =
        refocus_renderer_params_default(mode.width, mode.height, BLUR);
    const struct refocus_render_params render = refocus_render_params_default(0.8f, BLUR);
    check(refocus_renderer_create(&renderer, &make));

    for (long n = atol(argv[4]); n > 0; n--) {
        const struct refocus_frame *frame = next(camera);

        check(refocus_convert_rgb8(converter, frame, &photo, &reason));
        refocus_source_release(camera, frame);
        samples = read_depth(depth_camera, converter, &disparity);
        check(refocus_prepare(renderer, &photo, &disparity));
        check(refocus_render(renderer, &render, &result));
        check(refocus_sink_write(sink, &result, &reason));
    }

    refocus_renderer_destroy(&renderer);
    refocus_converter_destroy(&converter);
    refocus_source_close(&camera);
    refocus_source_close(&depth_camera);
    free(samples);
    free(pixels);
    check(refocus_sink_close(&sink, &reason));
    return 0;
}
