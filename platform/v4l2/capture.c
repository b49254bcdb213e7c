/* capture.c: the source `v4l2:` takes frames from cameras by raw ioctls, in mapped or exported
 * buffers, and never makes a blocking call. */
#include <errno.h>
#include <math.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "file/letters.h"
#include "v4l2.h"

enum { MOST_NODES = 64 };

struct camera {
    struct rf_v4l2 device; /* first: lens.c and modes.c go by it */
    char *name;            /* the name behind the colon */
    struct refocus_frame frame[RF_MOST_BUFFERS];
    bool source_changed; /* the signal at the input, not yet looked at */
    bool failed;
    uint32_t stuck; /* bit n: the driver did not take buffer n back */
    double fps;
};

static int open_camera(struct refocus_source *source, const char *rest,
                       struct refocus_reason *reason)
{
    struct camera *camera = calloc(1, sizeof *camera);
    int status;

    if (camera)
        camera->name = strdup(rest);
    if (!camera || !camera->name) {
        free(camera);
        return rf_capture_fail_memory(reason);
    }
    status = rf_v4l2_open(&camera->device, rest, false, reason);
    if (status != REFOCUS_OK) {
        free(camera->name);
        free(camera);
        return status;
    }
    source->state = camera;
    return REFOCUS_OK;
}

static void close_camera(struct refocus_source *source)
{
    struct camera *camera = source->state;

    rf_v4l2_close(&camera->device);
    free(camera->name);
    free(camera);
}

static int reopen(struct refocus_source *source, struct refocus_reason *reason)
{
    struct camera *camera = source->state;

    rf_v4l2_close(&camera->device);
    return rf_v4l2_open(&camera->device, camera->name, false, reason);
}

/* Start ---------------------------------------------------------------------------- */

/* A changed signal at the input brings timings of its own. */
static void follow_signal(struct camera *camera)
{
    struct v4l2_dv_timings timings;

    if (!camera->source_changed)
        return;
    camera->source_changed = false;
    memset(&timings, 0, sizeof timings);
    if (rf_v4l2_ioctl(camera->device.fd, VIDIOC_QUERY_DV_TIMINGS, &timings) == 0)
        rf_v4l2_ioctl(camera->device.fd, VIDIOC_S_DV_TIMINGS, &timings);
}

/* Where the driver can tell, ask for changes of the chosen input, whose number is the event's. */
static void watch_signal(const struct rf_v4l2 *device)
{
    struct v4l2_event_subscription change;
    int input = 0;

    rf_v4l2_ioctl(device->fd, VIDIOC_G_INPUT, &input);
    memset(&change, 0, sizeof change);
    change.type = V4L2_EVENT_SOURCE_CHANGE;
    change.id = (uint32_t)input;
    rf_v4l2_ioctl(device->fd, VIDIOC_SUBSCRIBE_EVENT, &change);
}

static int start(struct refocus_source *source, struct refocus_source_mode *mode,
                 struct refocus_reason *reason)
{
    struct camera *camera = source->state;
    struct rf_v4l2 *device = &camera->device;
    int type = (int)device->type, error = 0, status;

    if (device->fd < 0)
        return rf_v4l2_fail(device, reason, ENODEV, "starting it");
    rf_v4l2_unmap(device); /* the last stream, if the driver did not end it */
    follow_signal(camera);
    status = rf_v4l2_choose_format(source, reason);
    if (status != REFOCUS_OK)
        return status;
    camera->fps = rf_v4l2_set_rate(device, source->config.fps);
    status = rf_v4l2_map(device, source->config.buffers,
                         source->config.flags & REFOCUS_SOURCE_DMABUF, reason);
    if (status != REFOCUS_OK)
        return status;
    for (int n = 0; n < device->count && !error; n++)
        error = rf_v4l2_queue(device, n, 0);
    if (!error)
        error = rf_v4l2_ioctl(device->fd, VIDIOC_STREAMON, &type);
    if (error) {
        rf_v4l2_ioctl(device->fd, VIDIOC_STREAMOFF, &type);
        rf_v4l2_unmap(device);
        return rf_v4l2_fail(device, reason, error, "starting the stream");
    }
    device->streaming = true;
    camera->failed = false;
    camera->stuck = 0;
    watch_signal(device);
    mode->format = device->format;
    mode->width = device->width;
    mode->height = device->height;
    mode->fps = camera->fps;
    return REFOCUS_OK;
}

static void stop(struct refocus_source *source)
{
    struct camera *camera = source->state;

    source->counters.lost = source->counters.dequeued - source->counters.queued;
    rf_v4l2_unmap(&camera->device);
}

/* Frames --------------------------------------------------------------------------- */

/* True when the signal at the input is another one. */
static bool read_events(struct camera *camera)
{
    struct v4l2_event event;

    memset(&event, 0, sizeof event);
    while (rf_v4l2_ioctl(camera->device.fd, VIDIOC_DQEVENT, &event) == 0)
        if (event.type == V4L2_EVENT_SOURCE_CHANGE &&
            event.u.src_change.changes & V4L2_EVENT_SRC_CH_RESOLUTION)
            camera->source_changed = true;
    return camera->source_changed;
}

static bool is_short(const struct rf_v4l2 *device, const struct rf_v4l2_done *done)
{
    for (int i = 0; i < device->memories; i++)
        if (done->bytes[i] < rf_v4l2_needed(device, i) + done->offset[i] ||
            done->bytes[i] > device->buffer[done->index].length[i])
            return true;
    return false;
}

static void fill(struct camera *camera, const struct rf_v4l2_done *done,
                 struct refocus_frame *frame)
{
    static const uint32_t none[3] = {0, 0, 0};
    const struct rf_v4l2 *device = &camera->device;
    const bool cut = is_short(device, done);

    rf_v4l2_lay_out(device, done->index, cut ? none : done->offset, frame);
    if (device->format == REFOCUS_FRAME_MJPEG) {
        frame->plane[0] = device->buffer[done->index].memory[0] + (cut ? 0 : done->offset[0]);
        frame->bytes = cut ? 0 : done->bytes[0] - done->offset[0];
    }
    if (cut || done->flags & V4L2_BUF_FLAG_ERROR)
        frame->flags |= REFOCUS_FRAME_CORRUPT;
    if ((done->flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC)
        frame->flags |= REFOCUS_FRAME_MONOTONIC;
    frame->sequence = done->sequence;
    frame->timestamp_ns = done->timestamp_ns;
}

static int bits_of(uint64_t mask)
{
    int bits = 0;

    for (; mask; mask &= mask - 1)
        bits++;
    return bits;
}

/* True when the driver has no buffer that it could fill. */
static bool all_are_out(const struct refocus_source *source)
{
    const struct camera *camera = source->state;
    return bits_of(source->out | camera->stuck) >= camera->device.count;
}

static int wait_frame(struct refocus_source *source, int64_t deadline_ns,
                      struct refocus_frame **result, struct refocus_reason *reason)
{
    struct camera *camera = source->state;
    struct rf_v4l2 *device = &camera->device;
    struct rf_v4l2_done done;
    short events = 0;
    int error, status;

    if (camera->failed)
        return rf_capture_fail(reason, REFOCUS_ERR_IO, "%s: the driver takes its buffers no more",
                               device->path);
    for (;;) {
        status = rf_source_poll(source, device->fd, POLLIN | POLLPRI, deadline_ns, &events);
        if (status != REFOCUS_OK)
            return status;
        if (events & POLLPRI && read_events(camera))
            return rf_capture_fail(reason, REFOCUS_ERR_IO, "%s: another signal is at its input",
                                   device->path);
        error = rf_v4l2_dequeue(device, &done);
        if (error == 0)
            break;
        if (error == EAGAIN && !(events & (POLLERR | POLLHUP | POLLNVAL)))
            continue;
        if (error == EAGAIN && all_are_out(source))
            return rf_capture_fail(reason, REFOCUS_ERR_STATE, "every buffer is out; release one");
        return rf_v4l2_fail(device, reason, error == EAGAIN ? EIO : error,
                            "taking a frame from the driver");
    }
    source->counters.dequeued++;
    rf_v4l2_sync(&device->buffer[done.index], true);
    fill(camera, &done, &camera->frame[done.index]);
    *result = &camera->frame[done.index];
    return REFOCUS_OK;
}

/* Buffers that the driver refused before are offered again with each that comes back. */
static void release(struct refocus_source *source, struct refocus_frame *frame)
{
    struct camera *camera = source->state;
    struct rf_v4l2 *device = &camera->device;
    int error = 0;

    rf_v4l2_sync(&device->buffer[frame->buffer], false);
    camera->stuck |= 1u << frame->buffer;
    for (int round = 0; round < 2 && camera->stuck && error != ENODEV;
         round++) /* some refuse once */
        for (int n = 0; n < device->count && error != ENODEV; n++) {
            if (!(camera->stuck >> n & 1))
                continue;
            error = rf_v4l2_queue(device, n, 0);
            if (error == 0) {
                camera->stuck &= ~(1u << n);
                source->counters.queued++;
            }
        }
    if (device->count - bits_of(camera->stuck) < 2)
        camera->failed = error != ENODEV; /* wait will report it by itself */
}

/* Controls and the list of cameras ------------------------------------------------- */

/* "Focus, Absolute" becomes "focus_absolute". */
static void plain_name(char *plain, size_t size, const char *name)
{
    size_t n = 0;
    bool gap = false;

    for (; *name && n + 2 < size; name++) {
        const char letter = rf_lower(*name);

        if (!(letter >= 'a' && letter <= 'z') && !(letter >= '0' && letter <= '9')) {
            gap = n > 0;
            continue;
        }
        if (gap)
            plain[n++] = '_';
        gap = false;
        plain[n++] = letter;
    }
    plain[n] = '\0';
}

static int set_control(struct refocus_source *source, const char *name, double value,
                       struct refocus_reason *reason)
{
    const struct camera *camera = source->state;
    struct v4l2_queryctrl query;
    char plain[64];

    memset(&query, 0, sizeof query);
    query.id = V4L2_CTRL_FLAG_NEXT_CTRL;
    while (rf_v4l2_ioctl(camera->device.fd, VIDIOC_QUERYCTRL, &query) == 0) {
        plain_name(plain, sizeof plain, (const char *)query.name);
        if (strcmp(plain, name) == 0) {
            struct v4l2_control control = {.id = query.id, .value = (int32_t)lround(value)};
            const int error = rf_v4l2_ioctl(camera->device.fd, VIDIOC_S_CTRL, &control);

            return error ? rf_v4l2_fail(&camera->device, reason, error, name) : REFOCUS_OK;
        }
        query.id |= V4L2_CTRL_FLAG_NEXT_CTRL;
    }
    return rf_capture_fail(reason, REFOCUS_ERR_ARGUMENT, "%s: it has no control '%.60s'",
                           camera->device.path, name);
}

static int list(refocus_source_found *found, void *user)
{
    int n = 0;

    for (int i = 0; i < MOST_NODES; i++) {
        struct refocus_reason ignored;
        struct v4l2_capability capability;
        struct rf_v4l2 device;
        char number[16], name[80];

        memset(&device, 0, sizeof device);
        snprintf(number, sizeof number, "%d", i);
        if (rf_v4l2_open(&device, number, false, &ignored) != REFOCUS_OK)
            continue;
        memset(&capability, 0, sizeof capability);
        if (rf_v4l2_ioctl(device.fd, VIDIOC_QUERYCAP, &capability) == 0) {
            snprintf(name, sizeof name, "v4l2:%s", device.path);
            capability.card[sizeof capability.card - 1] = '\0';
            found(user, name, (const char *)capability.card);
            n++;
        }
        rf_v4l2_close(&device);
    }
    return n;
}

const struct rf_source_ops rf_source_v4l2 = {
    .scheme = "v4l2",
    .kind = REFOCUS_SOURCE_KIND_CAMERA,
    .open = open_camera,
    .get_mode = rf_v4l2_get_mode,
    .start = start,
    .wait = wait_frame,
    .release = release,
    .stop = stop,
    .reopen = reopen,
    .set_control = set_control,
    .close = close_camera,
    .list = list,
    .get_lens = rf_v4l2_get_lens,
    .set_focus = rf_v4l2_set_focus,
    .lock_exposure = rf_v4l2_lock_exposure,
};
