/* output.c: the sink `v4l2:` writes frames into a V4L2 output node, a virtual camera. */
#include <errno.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include "rgb_to_yuv.h"
#include "samples.h"
#include "sink.h"
#include "v4l2.h"

enum { BUFFERS = 4, PATIENCE_MS = 1000 };

struct output {
    struct rf_v4l2 device;
    uint32_t ours; /* bit n: buffer n is not the driver's, and may be filled */
};

static int open_output(struct refocus_sink *sink, const char *rest, struct refocus_reason *reason)
{
    struct output *output = calloc(1, sizeof *output);
    int status;

    if (!output)
        return rf_capture_fail_memory(reason);
    status = rf_v4l2_open(&output->device, rest, true, reason);
    if (status != REFOCUS_OK) {
        free(output);
        return status;
    }
    sink->state = output;
    return REFOCUS_OK;
}

/* Any order of Y, U and V: codes only change places. */
static bool takes(const struct refocus_sink *sink, uint32_t format)
{
    const struct output *output = sink->state;

    (void)format;
    for (uint32_t i = 0; i < 64; i++) {
        struct v4l2_fmtdesc desc = {.index = i, .type = output->device.type};

        if (rf_v4l2_ioctl(output->device.fd, VIDIOC_ENUM_FMT, &desc) != 0)
            return false;
        if (rf_has_samples(rf_v4l2_format_of(desc.pixelformat)))
            return true;
    }
    return false;
}

static bool try_format(struct rf_v4l2 *device, uint32_t fourcc, int width, int height,
                       struct refocus_reason *reason, int *status)
{
    if (!rf_can_encode(rf_v4l2_format_of(fourcc)))
        return false;
    *status = rf_v4l2_set_format(device, fourcc, width, height, reason);
    return *status == REFOCUS_OK && rf_can_encode(device->format) && device->width == width &&
           device->height == height;
}

/* Choose the format of the pictures themselves, else one with as many samples, else any of Y, U and
 * V. */
static int choose_yuv(struct rf_v4l2 *device, uint32_t format, int width, int height,
                      struct refocus_reason *reason)
{
    static const uint32_t formats[] = {REFOCUS_FRAME_NV12, REFOCUS_FRAME_YUV420, REFOCUS_FRAME_NV21,
                                       REFOCUS_FRAME_YUYV, REFOCUS_FRAME_UYVY};
    enum { OWN, AS_MANY, ANY };
    const uint32_t own = rf_frame_format_of(format);
    int status = REFOCUS_OK;
    uint32_t fourcc;

    for (int round = OWN; round <= ANY; round++)
        for (size_t i = 0; i < sizeof formats / sizeof *formats; i++) {
            const int rank = formats[i] == own                  ? OWN
                             : rf_same_samples(formats[i], own) ? AS_MANY
                                                                : ANY;

            for (int n = 0; rank == round && (fourcc = rf_v4l2_fourcc_of(formats[i], n)); n++)
                if (try_format(device, fourcc, width, height, reason, &status) &&
                    device->format == formats[i])
                    return REFOCUS_OK;
        }
    if (status != REFOCUS_OK && status != REFOCUS_ERR_UNSUPPORTED)
        return status;
    return rf_capture_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                           "%s: it takes no frames of Y, U and V of %dx%d; set its size or the "
                           "camera's",
                           device->path, width, height);
}

/* The format that the node is set to, if it is one of ours, else the first that
 * fits. */
static int choose_format(struct rf_v4l2 *device, int width, int height,
                         struct refocus_reason *reason)
{
    static const uint32_t preferred[] = {
        REFOCUS_FRAME_YUYV,  REFOCUS_FRAME_NV12,  REFOCUS_FRAME_YUV420, REFOCUS_FRAME_UYVY,
        REFOCUS_FRAME_RGB24, REFOCUS_FRAME_BGR24, REFOCUS_FRAME_RGBX,   REFOCUS_FRAME_BGRX};
    struct v4l2_format present;
    int status = REFOCUS_OK;
    uint32_t fourcc;

    memset(&present, 0, sizeof present);
    present.type = device->type;
    if (rf_v4l2_ioctl(device->fd, VIDIOC_G_FMT, &present) == 0 &&
        try_format(device,
                   device->multi ? present.fmt.pix_mp.pixelformat : present.fmt.pix.pixelformat,
                   width, height, reason, &status))
        return REFOCUS_OK;
    for (size_t i = 0; i < sizeof preferred / sizeof *preferred; i++)
        for (int n = 0; (fourcc = rf_v4l2_fourcc_of(preferred[i], n)); n++)
            if (try_format(device, fourcc, width, height, reason, &status))
                return REFOCUS_OK;
    if (status != REFOCUS_OK && status != REFOCUS_ERR_UNSUPPORTED)
        return status;
    return rf_capture_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                           "%s: it takes no frames of %dx%d; set its size or the camera's",
                           device->path, width, height);
}

static int start(struct refocus_sink *sink, int width, int height, double fps,
                 struct refocus_reason *reason)
{
    struct output *output = sink->state;
    struct v4l2_streamparm rate;
    int status;

    rf_v4l2_unmap(&output->device);
    status = sink->format == REFOCUS_FORMAT_RGB8
                 ? choose_format(&output->device, width, height, reason)
                 : choose_yuv(&output->device, sink->format, width, height, reason);
    if (status != REFOCUS_OK)
        return status;
    memset(&rate, 0, sizeof rate);
    rate.type = output->device.type;
    rate.parm.output.timeperframe.numerator = 1000;
    rate.parm.output.timeperframe.denominator = (uint32_t)(fps * 1000 + 0.5);
    rf_v4l2_ioctl(output->device.fd, VIDIOC_S_PARM, &rate); /* where it can be set */
    status = rf_v4l2_map(&output->device, BUFFERS, false, reason);
    output->ours = status == REFOCUS_OK ? UINT32_MAX >> (32 - output->device.count) : 0;
    return status;
}

static int stream_on(struct rf_v4l2 *device, struct refocus_reason *reason)
{
    int type = (int)device->type, error;

    if (device->streaming)
        return REFOCUS_OK;
    error = rf_v4l2_ioctl(device->fd, VIDIOC_STREAMON, &type);
    if (error)
        return rf_v4l2_fail(device, reason, error, "starting the stream");
    device->streaming = true;
    return REFOCUS_OK;
}

/* A buffer to fill: one that is ours, or one that the device has shown. It is ours until it is
 * queued, so that none is lost where the driver refuses it. */
static int take_buffer(struct output *output, int *index, struct refocus_reason *reason)
{
    struct rf_v4l2 *device = &output->device;
    struct pollfd wait = {.fd = device->fd, .events = POLLOUT};
    const int64_t deadline = rf_now_ns() + (int64_t)PATIENCE_MS * 1000000;
    struct rf_v4l2_done done;
    int error;

    if (output->ours) {
        for (*index = 0; !(output->ours >> *index & 1);)
            ++*index;
        return REFOCUS_OK;
    }
    error = stream_on(device, reason); /* all are queued, but it never began */
    if (error != REFOCUS_OK)
        return error;
    for (;;) {
        const int64_t left = (deadline - rf_now_ns()) / 1000000;
        const int n = poll(&wait, 1, left > 0 ? (int)left : 0);

        error = rf_v4l2_dequeue(device, &done);
        if (error == 0) {
            *index = done.index;
            output->ours |= 1u << done.index;
            return REFOCUS_OK;
        }
        if (error != EAGAIN)
            return rf_v4l2_fail(device, reason, error, "getting a buffer back");
        if (n > 0 && wait.revents & (POLLERR | POLLHUP))
            return rf_v4l2_fail(device, reason, EIO, "getting a buffer back");
        if (left <= 0)
            return rf_capture_fail(reason, REFOCUS_ERR_TIMEOUT, "%s: it took no frame for a second",
                                   device->path);
    }
}

static int write_frame(struct refocus_sink *sink, const struct refocus_image *image,
                       struct refocus_reason *reason)
{
    static const uint32_t none[3] = {0, 0, 0};
    struct output *output = sink->state;
    struct rf_v4l2 *device = &output->device;
    struct refocus_frame frame;
    int index = 0, error, status;

    status = take_buffer(output, &index, reason);
    if (status != REFOCUS_OK)
        return status;
    rf_v4l2_lay_out(device, index, none, &frame);
    if (image->format == REFOCUS_FORMAT_RGB8)
        rf_encode(image, &frame);
    else
        rf_rearrange(image, &frame, rf_rows_of_chroma(frame.format, image->height));
    error = rf_v4l2_queue(device, index, rf_now_ns());
    if (error)
        return rf_v4l2_fail(device, reason, error, "queuing a frame");
    output->ours &= ~(1u << index);
    return stream_on(device, reason);
}

static int close_output(struct refocus_sink *sink, struct refocus_reason *reason)
{
    struct output *output = sink->state;

    (void)reason;
    rf_v4l2_unmap(&output->device);
    rf_v4l2_close(&output->device);
    free(output);
    return REFOCUS_OK;
}

const struct rf_sink_ops rf_sink_v4l2 = {.scheme = "v4l2",
                                         .open = open_output,
                                         .takes = takes,
                                         .start = start,
                                         .write = write_frame,
                                         .close = close_output};
