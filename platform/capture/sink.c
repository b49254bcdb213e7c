/* sink.c: sinks are opened by name and checked in one place; the sink `null` drops everything. */
#include <stdlib.h>
#include <string.h>
#include "modules.h"
#include "pattern.h"
#include "samples.h"
#include "sink.h"

static const double most_fps = 10000; /* the limit of sources, too */

static const struct rf_sink_ops *const kinds[] = {
#ifdef RF_HAVE_V4L2
    &rf_sink_v4l2,
#endif
    &rf_sink_y4m,
    &rf_sink_raw,
};

static int write_null(struct refocus_sink *sink, const struct refocus_image *image,
                      struct refocus_reason *reason)
{
    (void)sink;
    (void)image;
    (void)reason;
    return REFOCUS_OK;
}

static bool take_all(const struct refocus_sink *sink, uint32_t format)
{
    (void)sink;
    (void)format;
    return true;
}

const struct rf_sink_ops rf_sink_null = {.scheme = "null", .takes = take_all, .write = write_null};

static const struct rf_sink_ops *find_window(struct refocus_reason *reason)
{
    const struct rf_sink_ops *window = rf_window();

    if (!window)
        rf_capture_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                        "this build has no window (SDL2), or its module is gone");
    return window;
}

static const struct rf_sink_ops *find_pipewire(struct refocus_reason *reason)
{
    const struct rf_sink_ops *pipewire = rf_pipewire_sink();

    if (!pipewire)
        rf_capture_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                        "this build has no pipewire, or its module is gone");
    return pipewire;
}

static const struct rf_sink_ops *find(const char *name, const char **rest,
                                      struct refocus_reason *reason)
{
    if (strcmp(name, "null") == 0)
        return &rf_sink_null;
    if (strcmp(name, "window") == 0)
        return find_window(reason);
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        const size_t length = strlen(kinds[i]->scheme);

        if (strncmp(name, kinds[i]->scheme, length) == 0 && name[length] == ':') {
            *rest = name + length + 1;
            return kinds[i];
        }
    }
    if (strncmp(name, "pipewire:", 9) == 0) {
        *rest = name + 9;
        return find_pipewire(reason);
    }
#ifndef RF_HAVE_V4L2
    if (strncmp(name, "v4l2:", 5) == 0) {
        rf_capture_fail(reason, REFOCUS_ERR_UNSUPPORTED, "this build has no v4l2");
        return NULL;
    }
#endif
    if (rf_pattern_check(name) == 1)
        return &rf_sink_pictures;
    rf_capture_fail(reason, REFOCUS_ERR_ARGUMENT,
                    "no such kind of sink; give window, v4l2:DEVICE, pipewire:[NAME], y4m:FILE, "
                    "raw:FILE[,FORMAT], null or a pattern of pictures such as frames-%%04d.png");
    return NULL;
}

int refocus_sink_open(struct refocus_sink **result, const char *name, struct refocus_reason *reason)
{
    struct refocus_reason unheard;
    struct refocus_sink *sink;
    const struct rf_sink_ops *ops;
    const char *rest = name;
    int status;

    if (!result)
        return REFOCUS_ERR_ARGUMENT;
    *result = NULL;
    reason = reason ? reason : &unheard;
    memset(reason, 0, sizeof *reason);
    if (!name)
        return rf_capture_fail(reason, REFOCUS_ERR_ARGUMENT, "no name");
    ops = find(name, &rest, reason);
    if (!ops)
        return strstr(reason->text, "this build") ? REFOCUS_ERR_UNSUPPORTED : REFOCUS_ERR_ARGUMENT;
    sink = calloc(1, sizeof *sink);
    if (!sink)
        return rf_capture_fail_memory(reason);
    sink->ops = ops;
    status = ops->open ? ops->open(sink, rest, reason) : REFOCUS_OK;
    if (status != REFOCUS_OK)
        free(sink);
    else
        *result = sink;
    return status;
}

int refocus_sink_takes(struct refocus_sink *sink, uint32_t format)
{
    if (!sink)
        return 0;
    return format == REFOCUS_FORMAT_RGB8 ||
           (rf_frame_format_of(format) && sink->ops->takes && sink->ops->takes(sink, format));
}

int refocus_sink_set_mode(struct refocus_sink *sink, const struct refocus_source_mode *mode)
{
    struct refocus_source_mode own;
    const int status = refocus_struct_read(&own, sizeof own,
                                           REFOCUS_SIZE_TO(struct refocus_source_mode, fps), mode);

    if (status != REFOCUS_OK)
        return status;
    if (!sink || own.chroma_place >= REFOCUS_CHROMA_PLACE_COUNT || own.pixel_aspect[0] < 0 ||
        own.pixel_aspect[1] < 0 || !own.pixel_aspect[0] != !own.pixel_aspect[1])
        return REFOCUS_ERR_ARGUMENT;
    sink->aspect[0] = own.pixel_aspect[0];
    sink->aspect[1] = own.pixel_aspect[1];
    sink->chroma_place = own.chroma_place;
    return REFOCUS_OK;
}

int refocus_sink_set_cancelled(struct refocus_sink *sink, int (*cancelled)(void *user), void *user)
{
    if (!sink)
        return REFOCUS_ERR_ARGUMENT;
    sink->cancelled = cancelled;
    sink->user = user;
    return REFOCUS_OK;
}

int refocus_sink_start_image(struct refocus_sink *sink, const struct refocus_image *like,
                             double fps, struct refocus_reason *reason)
{
    struct refocus_reason unheard;
    struct refocus_image own;
    int status;

    reason = reason ? reason : &unheard;
    reason->text[0] = '\0';
    status = refocus_image_read(&own, like);
    if (status != REFOCUS_OK || !sink)
        return rf_capture_fail(reason, status ? status : REFOCUS_ERR_ARGUMENT,
                               sink ? "no picture that can be read is given" : "no sink is given");
    like = &own;
    if (like->width < 1 || like->height < 1 || like->width > REFOCUS_MAX_SIDE ||
        like->height > REFOCUS_MAX_SIDE)
        return rf_capture_fail(reason, REFOCUS_ERR_ARGUMENT,
                               "%dx%d pixels are out of the range; give 1 to %d a side",
                               (int)like->width, (int)like->height, REFOCUS_MAX_SIDE);
    sink->started = false;
    if (!refocus_sink_takes(sink, like->format))
        return rf_capture_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                               "this sink does not take such pictures; give it RGB8");
    sink->width = like->width;
    sink->height = like->height;
    sink->format = like->format;
    sink->matrix = like->matrix;
    sink->range = like->range;
    sink->fps = !(fps > 0) ? 30 : fps < most_fps ? fps : most_fps;
    status = sink->ops->start ? sink->ops->start(sink, like->width, like->height, sink->fps, reason)
                              : REFOCUS_OK;
    sink->started = status == REFOCUS_OK;
    return status;
}

int refocus_sink_start(struct refocus_sink *sink, int width, int height, double fps,
                       struct refocus_reason *reason)
{
    const struct refocus_image like = {.struct_size = sizeof(struct refocus_image),
                                       .format = REFOCUS_FORMAT_RGB8,
                                       .width = width,
                                       .height = height};

    return refocus_sink_start_image(sink, &like, fps, reason);
}

/* Whether all rows of a picture of the sink's format and size can be there. */
static bool is_whole(const struct refocus_image *image)
{
    const uint32_t format = image->format == REFOCUS_FORMAT_RGB8
                                ? (uint32_t)REFOCUS_FRAME_RGB24
                                : rf_frame_format_of(image->format);

    for (int i = 0; i < rf_format_planes(format); i++)
        if (!image->plane[i] ||
            !rf_stride_fits(image->stride[i], rf_plane_row(format, i, image->width),
                            rf_plane_rows(format, i, image->height)))
            return false;
    return true;
}

int refocus_sink_write(struct refocus_sink *sink, const struct refocus_image *image,
                       struct refocus_reason *reason)
{
    struct refocus_reason unheard;
    struct refocus_image own;
    int status;

    reason = reason ? reason : &unheard;
    reason->text[0] = '\0';
    if (!sink || !sink->started)
        return rf_capture_fail(reason, REFOCUS_ERR_STATE, "the sink is not started");
    if ((status = refocus_image_read(&own, image)))
        return rf_capture_fail(reason, status, "the picture is not of a known size of struct");
    image = &own;
    if (image->format != sink->format || image->width != sink->width ||
        image->height != sink->height || !is_whole(image))
        return rf_capture_fail(reason, REFOCUS_ERR_ARGUMENT,
                               "give a picture of the size and format that were announced");
    return sink->ops->write(sink, image, reason);
}

int refocus_sink_close(struct refocus_sink **handle, struct refocus_reason *reason)
{
    struct refocus_reason unheard;
    int status;

    if (!handle || !*handle)
        return REFOCUS_OK;
    reason = reason ? reason : &unheard;
    reason->text[0] = '\0';
    status = (*handle)->ops->close ? (*handle)->ops->close(*handle, reason) : REFOCUS_OK;
    free(*handle);
    *handle = NULL;
    return status;
}
