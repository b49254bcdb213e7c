/* fake_v4l2.c: the calls of the system that sources and sinks of V4L2 make are answered here. */
#define _GNU_SOURCE /* ppoll */
#include "fake_v4l2.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/dma-buf.h>
#include <linux/videodev2.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

enum { LENGTH = FAKE_WIDTH * FAKE_HEIGHT * 2, CONTROLS = 5, MOST = 64, FIRST_OFFSET = 1 << 16 };

struct fake_v4l2 fake = {.fd = -1};
static struct {
    void *at[MOST];
    int dmabuf[MOST], dmabufs;
    unsigned exported; /* bit 2 n + i: memory i of buffer n */
} held;

static bool fails(void)
{
    fake.calls++;
    if (!fake.fail_at || fake.calls < fake.fail_at || (fake.calls > fake.fail_at && !fake.forever))
        return false;
    errno = fake.failure;
    return true;
}

/* Interruptions are of calls that wait. */
static bool fails_unless_interrupted(void)
{
    return fake.failure != EINTR && fails();
}

/* Calls that are not made when they fail. */
#define WRAP(condition, type, none, name, parameters, ...)                                         \
    type __real_##name parameters;                                                                 \
    type __wrap_##name parameters;                                                                 \
    type __wrap_##name parameters                                                                  \
    {                                                                                              \
        return (condition) && fails_unless_interrupted() ? (none) : __real_##name(__VA_ARGS__);    \
    }
WRAP(true, void *, NULL, calloc, (size_t n, size_t size), n, size)
WRAP(true, char *, NULL, strdup, (const char *text), text)
WRAP(true, int, -1, eventfd, (unsigned value, int flags), value, flags)
WRAP(file == fake.fd, int, -1, fstat64, (int file, struct stat *facts), file, facts)

int __real_open64(const char *path, int flags, mode_t mode);
int __wrap_open64(const char *path, int flags, mode_t mode);
int __real_close(int fd);
int __wrap_close(int fd);
void *__real_mmap64(void *at, size_t size, int protection, int flags, int fd, off_t offset);
void *__wrap_mmap64(void *at, size_t size, int protection, int flags, int fd, off_t offset);
int __real_munmap(void *at, size_t size);
int __wrap_munmap(void *at, size_t size);
int __wrap_ioctl(int fd, unsigned long request, void *argument);
int __real_ppoll(struct pollfd *files, nfds_t n, const struct timespec *wait, const sigset_t *mask);
int __wrap_ppoll(struct pollfd *files, nfds_t n, const struct timespec *wait, const sigset_t *mask);
int __wrap_poll(struct pollfd *files, nfds_t n, int wait);

/* /dev/null is a device, as a camera is. */
int __wrap_open64(const char *path, int flags, mode_t mode)
{
    if (strcmp(path, "/dev/video7") != 0)
        return __real_open64(path, flags, mode);
    if (fails_unless_interrupted())
        return -1;
    if (fake.fd >= 0) {
        errno = EBUSY;
        return -1;
    }
    fake.fd = __real_open64("/dev/null", flags, mode);
    fake.fourcc = fake.multi ? V4L2_PIX_FMT_NV12M : V4L2_PIX_FMT_YUYV;
    return fake.fd;
}

/* The end of the device's file ends its stream, and frees its buffers unless they are mapped. */
int __wrap_close(int fd)
{
    for (int i = 0; i < held.dmabufs; i++)
        if (held.dmabuf[i] == fd)
            held.dmabuf[i] = held.dmabuf[--held.dmabufs];
    if (fd == fake.fd) {
        fake.fd = -1;
        fake.buffers = 0;
        fake.queued = fake.done = 0;
        fake.streaming = false;
    }
    return __real_close(fd);
}

void *__wrap_mmap64(void *at, size_t size, int protection, int flags, int fd, off_t offset)
{
    bool is_device = fd >= 0 && fd == fake.fd, is_export = false;
    void *memory;

    for (int i = 0; i < held.dmabufs; i++)
        is_export |= held.dmabuf[i] == fd;
    if (!is_device && !is_export)
        return __real_mmap64(at, size, protection, flags, fd, offset);
    if (is_device != (offset >= FIRST_OFFSET)) { /* Exports begin at 0. */
        errno = EINVAL;
        return MAP_FAILED;
    }
    if (fails_unless_interrupted())
        return MAP_FAILED;
    memory = __real_mmap64(NULL, size, protection, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    for (int i = 0; i < MOST && memory != MAP_FAILED; i++)
        if (!held.at[i]) {
            held.at[i] = memory;
            fake.mapped++;
            break;
        }
    return memory;
}

int __wrap_munmap(void *at, size_t size)
{
    for (int i = 0; i < MOST; i++)
        if (held.at[i] == at) {
            held.at[i] = NULL;
            fake.mapped--;
        }
    return __real_munmap(at, size);
}

/* Waiting ------------------------------------------------------------------------------ */

/* The camera takes a picture, or the display shows one, whenever somebody waits for it. */
static short events(void)
{
    if (fake.changes)
        return POLLPRI;
    for (int n = 0; fake.streaming && !fake.done && n < fake.buffers; n++)
        if (fake.queued >> n & 1) {
            fake.queued &= ~(1u << n);
            fake.done |= 1u << n;
        }
    if (!fake.streaming)
        return POLLERR;
    return fake.done ? (short)(fake.output ? POLLOUT : POLLIN) : 0;
}

/* A fault is an error of the call where it is an interruption or there is no memory, else one of
 * the device. */
static int answer(struct pollfd *file)
{
    if (fails()) {
        if (errno == EINTR || errno == ENOMEM)
            return -1;
        file->revents = POLLERR | (errno == ENODEV ? POLLHUP : 0);
        return 1;
    }
    file->revents = events();
    return file->revents != 0;
}

int __wrap_ppoll(struct pollfd *files, nfds_t n, const struct timespec *wait, const sigset_t *mask)
{
    const struct timespec none = {0, 0};
    int ready;

    if (n < 2 || files[1].fd != fake.fd)
        return __real_ppoll(files, n, wait, mask);
    ready = __real_ppoll(files, 1, &none, mask);
    return ready ? ready : answer(&files[1]);
}

int __wrap_poll(struct pollfd *files, nfds_t n, int wait)
{
    (void)n;
    (void)wait;
    return answer(files);
}

/* Requests ----------------------------------------------------------------------------- */

static void say_format(struct v4l2_format *format)
{
    if (fake.multi) {
        struct v4l2_pix_format_mplane *own = &format->fmt.pix_mp;

        own->pixelformat = fake.fourcc;
        own->width = FAKE_WIDTH;
        own->height = FAKE_HEIGHT;
        own->num_planes = fake.fourcc == V4L2_PIX_FMT_NV12M ? 2 : 1;
        own->plane_fmt[0].bytesperline = FAKE_WIDTH;
        own->plane_fmt[1].bytesperline = 2 * FAKE_WIDTH;
        own->colorspace = fake.space;
        own->ycbcr_enc = (uint8_t)fake.encoding;
        own->quantization = (uint8_t)fake.range;
    } else {
        format->fmt.pix.pixelformat = fake.fourcc;
        format->fmt.pix.width = FAKE_WIDTH;
        format->fmt.pix.height = FAKE_HEIGHT;
        format->fmt.pix.bytesperline = FAKE_WIDTH * 2;
        format->fmt.pix.colorspace = fake.space;
        format->fmt.pix.ycbcr_enc = fake.encoding;
        format->fmt.pix.quantization = fake.range;
    }
}

static int say_capability(struct v4l2_capability *capability)
{
    const uint32_t kind = fake.output
                              ? (fake.multi ? V4L2_CAP_VIDEO_OUTPUT_MPLANE : V4L2_CAP_VIDEO_OUTPUT)
                          : fake.multi ? V4L2_CAP_VIDEO_CAPTURE_MPLANE
                                       : V4L2_CAP_VIDEO_CAPTURE;

    strcpy((char *)capability->card, "Fake");
    capability->capabilities = V4L2_CAP_DEVICE_CAPS;
    capability->device_caps = kind | V4L2_CAP_STREAMING;
    return 0;
}

static int say_size(struct v4l2_frmsizeenum *size)
{
    size->type = V4L2_FRMSIZE_TYPE_DISCRETE;
    size->discrete.width = FAKE_WIDTH;
    size->discrete.height = FAKE_HEIGHT;
    return size->index == 0 ? 0 : EINVAL;
}

static int say_interval(struct v4l2_frmivalenum *interval)
{
    interval->type = V4L2_FRMIVAL_TYPE_DISCRETE;
    interval->discrete = (struct v4l2_fract){1, 30};
    return interval->index == 0 ? 0 : EINVAL;
}

static int say_control(struct v4l2_queryctrl *control)
{
    static const uint32_t ids[CONTROLS] = {V4L2_CID_BRIGHTNESS, V4L2_CID_EXPOSURE_AUTO,
                                           V4L2_CID_EXPOSURE_ABSOLUTE, V4L2_CID_FOCUS_ABSOLUTE,
                                           V4L2_CID_FOCUS_AUTO};
    const bool next = control->id & V4L2_CTRL_FLAG_NEXT_CTRL;
    const uint32_t id = control->id & ~V4L2_CTRL_FLAG_NEXT_CTRL;

    for (int i = 0; i < CONTROLS; i++)
        if (next ? ids[i] > id : ids[i] == id) {
            memset(control, 0, sizeof *control);
            control->id = ids[i];
            control->maximum = 100;
            strcpy((char *)control->name, i == 3 ? "Focus, Absolute" : "Other");
            return 0;
        }
    return EINVAL;
}

static int set_format(struct v4l2_format *format)
{
    const uint32_t fourcc =
        fake.multi ? format->fmt.pix_mp.pixelformat : format->fmt.pix.pixelformat;

    if (fake.buffers)
        return EBUSY;
    fake.fourcc = fake.multi ? (fourcc == V4L2_PIX_FMT_NV12M ? fourcc : V4L2_PIX_FMT_NV12M)
                             : V4L2_PIX_FMT_YUYV;
    say_format(format);
    return 0;
}

static int request_buffers(struct v4l2_requestbuffers *request)
{
    if (fake.streaming || fake.mapped)
        return EBUSY;
    request->count = request->count > 8 ? 8 : request->count;
    fake.buffers = (int)request->count;
    held.exported = 0;
    fake.queued = fake.done = 0;
    return 0;
}

static int query_buffer(struct v4l2_buffer *buffer)
{
    if (buffer->index >= (uint32_t)fake.buffers)
        return EINVAL;
    buffer->length = fake.multi ? 2 : fake.length ? fake.length : LENGTH;
    if (!fake.multi)
        buffer->m.offset = FIRST_OFFSET;
    for (uint32_t i = 0; i < 2 && fake.multi; i++) {
        buffer->m.planes[i].length = fake.length ? fake.length : LENGTH;
        buffer->m.planes[i].m.mem_offset = FIRST_OFFSET;
    }
    return 0;
}

static int export_buffer(struct v4l2_exportbuffer *export)
{
    const unsigned bit = 1u << (2 * export->index + export->plane);

    if (held.dmabufs == MOST)
        return ENFILE;
    if (held.exported & bit)
        return EINVAL;
    held.exported |= bit;
    export->fd = held.dmabuf[held.dmabufs++] = __real_open64("/dev/null", O_RDONLY | O_CLOEXEC, 0);
    return 0;
}

static int queue(const struct v4l2_buffer *buffer)
{
    const unsigned bit = 1u << buffer->index;

    if (buffer->index >= (uint32_t)fake.buffers || (fake.queued | fake.done) & bit)
        return EINVAL;
    fake.queued |= bit;
    fake.queued_at_us = buffer->timestamp.tv_sec * INT64_C(1000000) + buffer->timestamp.tv_usec;
    return 0;
}

static int dequeue(struct v4l2_buffer *buffer)
{
    int n = 0;

    if (!fake.streaming)
        return EINVAL;
    if (!fake.done)
        return EAGAIN;
    while (!(fake.done >> n & 1))
        n++;
    fake.done &= ~(1u << n);
    fake.frames++;
    buffer->index = (uint32_t)n;
    buffer->sequence = fake.sequence++;
    buffer->flags = fake.filled.flags ? fake.filled.flags : V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
    buffer->bytesused = fake.filled.bytes ? fake.filled.bytes : LENGTH;
    buffer->timestamp.tv_sec = (time_t)(fake.filled.us / 1000000);
    buffer->timestamp.tv_usec = (suseconds_t)(fake.filled.us % 1000000);
    for (int i = 0; i < 2 && fake.multi; i++) {
        buffer->m.planes[i].bytesused = buffer->bytesused;
        buffer->m.planes[i].data_offset = fake.filled.offset;
    }
    return 0;
}

static int stream(bool on)
{
    fake.streaming = on;
    if (!on)
        fake.queued = fake.done = 0;
    return 0;
}

static int take_event(struct v4l2_event *event)
{
    if (!fake.changes)
        return ENOENT;
    fake.changes = false;
    event->type = V4L2_EVENT_SOURCE_CHANGE;
    event->u.src_change.changes = V4L2_EVENT_SRC_CH_RESOLUTION;
    return 0;
}

static int answer_request(unsigned long request, void *argument)
{
    switch (request) {
    case VIDIOC_QUERYCAP:
        return say_capability(argument);
    case VIDIOC_ENUM_FMT: {
        struct v4l2_fmtdesc *const format = argument;

        format->pixelformat = fake.multi ? V4L2_PIX_FMT_NV12M : V4L2_PIX_FMT_YUYV;
        return format->index == 0 ? 0 : EINVAL;
    }
    case VIDIOC_ENUM_FRAMESIZES:
        return say_size(argument);
    case VIDIOC_ENUM_FRAMEINTERVALS:
        return say_interval(argument);
    case VIDIOC_G_FMT:
        say_format(argument);
        return 0;
    case VIDIOC_S_FMT:
        return set_format(argument);
    case VIDIOC_G_PARM:
        ((struct v4l2_streamparm *)argument)->parm.capture.timeperframe =
            (struct v4l2_fract){1, 30};
        return 0;
    case VIDIOC_S_PARM:
        memcpy(fake.rate, &((struct v4l2_streamparm *)argument)->parm.capture.timeperframe,
               sizeof fake.rate);
        return 0;
    case VIDIOC_QUERYCTRL:
        return say_control(argument);
    case VIDIOC_REQBUFS:
        return request_buffers(argument);
    case VIDIOC_QUERYBUF:
        return query_buffer(argument);
    case VIDIOC_EXPBUF:
        return export_buffer(argument);
    case VIDIOC_QBUF:
        return queue(argument);
    case VIDIOC_DQBUF:
        return dequeue(argument);
    case VIDIOC_STREAMON:
    case VIDIOC_STREAMOFF:
        return stream(request == VIDIOC_STREAMON);
    case VIDIOC_DQEVENT:
        return take_event(argument);
    default: /* everything else sets something */
        return 0;
    }
}

int __wrap_ioctl(int fd, unsigned long request, void *argument)
{
    (void)fd;
    if (fails())
        return -1;
    if (fake.refusals > 0 && fake.refused == request) {
        fake.refusals--;
        errno = EIO;
        return -1;
    }
    errno = answer_request(request, argument);
    return errno ? -1 : 0;
}
