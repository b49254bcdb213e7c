/* Streams into a file, a pipe or standard output, and sequences of pictures. */
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>
#include "pictures.h"
#include "sink.h"

struct stream {
    char *path;
    int fd;
    bool y4m, begun;
    uint32_t format, range;     /* of its pictures: enum refocus_format,
                                   refocus_range */
    struct refocus_frame frame; /* in memory */
    uint8_t *memory;
    size_t bytes;
};

/* A write into a closed pipe raises SIGPIPE, which is the program's business and not
 * ours: it is held back in this thread, and taken away when it was this write that
 * raised it. */
static ssize_t quiet_write(int fd, const void *bytes, size_t size)
{
    const struct timespec none = {0, 0};
    sigset_t pipe_set, before, pending;
    ssize_t n;
    int error;

    sigemptyset(&pipe_set);
    sigaddset(&pipe_set, SIGPIPE);
    sigpending(&pending);
    pthread_sigmask(SIG_BLOCK, &pipe_set, &before);
    n = write(fd, bytes, size);
    error = errno;
    if (n < 0 && error == EPIPE && !sigismember(&pending, SIGPIPE))
        while (sigtimedwait(&pipe_set, NULL, &none) < 0 && errno == EINTR)
            continue;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    errno = error;
    return n;
}

static int write_all(const struct stream *stream, const void *bytes, size_t size,
                     struct refocus_reason *reason)
{
    const uint8_t *at = bytes;

    while (size > 0) {
        const ssize_t n = quiet_write(stream->fd, at, size);

        if (n < 0 && errno == EAGAIN) {
            struct pollfd wait = {.fd = stream->fd, .events = POLLOUT};
            poll(&wait, 1, 100);
            continue;
        }
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0)
            return rf_capture_fail_errno(reason, errno, stream->path);
        at += n;
        size -= (size_t)n;
    }
    return REFOCUS_OK;
}

static int open_stream(struct refocus_sink *sink, const char *rest, bool y4m,
                       struct refocus_reason *reason)
{
    struct stream *stream;
    int status;

    if (!*rest)
        return rf_capture_fail(reason, REFOCUS_ERR_ARGUMENT,
                               "give the name of a file behind the colon, or '-'");
    stream = calloc(1, sizeof *stream);
    if (!stream)
        return rf_capture_fail_memory(reason);
    sink->state = stream;
    stream->y4m = y4m;
    stream->path = strdup(rest);
    stream->fd = strcmp(rest, "-") == 0
                     ? fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3)
                     : open(rest, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    status = !stream->path    ? rf_capture_fail_memory(reason)
             : stream->fd < 0 ? rf_capture_fail_errno(reason, errno, rest)
                              : REFOCUS_OK;
    if (status != REFOCUS_OK) {
        if (stream->fd >= 0)
            close(stream->fd);
        free(stream->path);
        free(stream);
    }
    return status;
}

static int open_y4m(struct refocus_sink *sink, const char *rest,
                    struct refocus_reason *reason)
{
    return open_stream(sink, rest, true, reason);
}

static int open_raw(struct refocus_sink *sink, const char *rest,
                    struct refocus_reason *reason)
{
    return open_stream(sink, rest, false, reason);
}

static bool is_422(uint32_t format)
{
    return format == REFOCUS_FORMAT_YUYV;
}

static uint32_t range_of(const struct refocus_sink *sink)
{
    return sink->format == REFOCUS_FORMAT_RGB8 ? (uint32_t)REFOCUS_RANGE_LIMITED
                                               : sink->range;
}

static bool takes_yuv(const struct refocus_sink *sink, uint32_t format)
{
    (void)sink;
    (void)format;
    return true;
}

/* Planes of y4m are those of YUV420; in 4:2:2 U and V have all rows. */
static bool lay_out(struct stream *stream, int width, int height)
{
    struct refocus_frame *frame = &stream->frame;
    const size_t half = ((size_t)width + 1) / 2;

    rf_frame_clear(frame);
    frame->format = stream->y4m ? REFOCUS_FRAME_YUV420 : REFOCUS_FRAME_RGB24;
    frame->width = width;
    frame->height = height;
    stream->bytes = (size_t)rf_frame_bytes(
        frame->format, rf_plane_row(frame->format, 0, width), width, height);
    if (is_422(stream->format))
        stream->bytes = ((size_t)width + 2 * half) * (size_t)height;
    stream->memory = malloc(stream->bytes);
    if (!stream->memory)
        return false;
    rf_frame_lay_out(frame, stream->memory, rf_plane_row(frame->format, 0, width));
    if (is_422(stream->format))
        frame->plane[2] = frame->plane[1] + half * (size_t)height;
    return true;
}

/* Samples of a row that lie `step` bytes apart. */
static void take_row(uint8_t *to, const uint8_t *from, int step, int n)
{
    if (step == 1)
        memcpy(to, from, (size_t)n);
    else
        for (int x = 0; x < n; x++)
            to[x] = from[x * step];
}

/* Y, U and V in planes of their own. */
static void take_apart(const struct refocus_image *image, struct stream *stream)
{
    const int half = (image->width + 1) / 2;
    const bool planar = image->format == REFOCUS_FORMAT_I420,
               packed = is_422(image->format);
    const bool swapped = image->format == REFOCUS_FORMAT_NV21;
    uint8_t *at = stream->memory;

    for (int i = 0; i < 3; i++) {
        const int plane = packed ? 0 : planar ? i : i > 0;
        const int step = i == 0 ? (packed ? 2 : 1) : packed ? 4 : planar ? 1 : 2;
        const int first = i == 0 || planar ? 0
                          : packed         ? 2 * i - 1
                                           : (i == 2) ^ swapped;
        const int n = i == 0 ? image->width : half;

        for (int y = 0; y < (i == 0 ? image->height
                                    : rf_plane_rows(rf_frame_format_of(image->format),
                                                    plane, image->height));
             y++, at += n)
            take_row(at, image->plane[plane] + y * image->stride[plane] + first, step,
                     n);
    }
}

static int start_stream(struct refocus_sink *sink, int width, int height, double fps,
                        struct refocus_reason *reason)
{
    struct stream *stream = sink->state;
    char header[128];

    if (stream->begun) {
        if (width == stream->frame.width && height == stream->frame.height &&
            is_422(sink->format) == is_422(stream->format) &&
            range_of(sink) == stream->range)
            return REFOCUS_OK;
        return rf_capture_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                               "%.120s: a stream of %dx%d has begun, and %dx%d came, "
                               "or other colours; begin another",
                               stream->path, stream->frame.width, stream->frame.height,
                               width, height);
    }
    stream->format = sink->format;
    stream->range = range_of(sink);
    if (!lay_out(stream, width, height))
        return rf_capture_fail_memory(reason);
    /* y4m says the size at once: only a header that was written is begun. */
    stream->begun = true;
    if (!stream->y4m)
        return REFOCUS_OK;
    snprintf(header, sizeof header,
             "YUV4MPEG2 W%d H%d F%d:1000 Ip A1:1 C%s XCOLORRANGE=%s\n", width, height,
             (int)(fps * 1000 + 0.5), is_422(stream->format) ? "422" : "420jpeg",
             stream->range == REFOCUS_RANGE_FULL ? "FULL" : "LIMITED");
    return write_all(stream, header, strlen(header), reason);
}

static int write_stream(struct refocus_sink *sink, const struct refocus_image *image,
                        struct refocus_reason *reason)
{
    struct stream *stream = sink->state;
    int status = REFOCUS_OK;

    if (image->format == REFOCUS_FORMAT_RGB8)
        rf_encode(image, &stream->frame);
    else
        take_apart(image, stream);
    if (stream->y4m)
        status = write_all(stream, "FRAME\n", 6, reason);
    if (status == REFOCUS_OK)
        status = write_all(stream, stream->memory, stream->bytes, reason);
    return status;
}

static int close_stream(struct refocus_sink *sink, struct refocus_reason *reason)
{
    struct stream *stream = sink->state;
    int status = REFOCUS_OK;

    if (close(stream->fd) != 0)
        status = rf_capture_fail_errno(reason, errno, stream->path);
    free(stream->memory);
    free(stream->path);
    free(stream);
    return status;
}

const struct rf_sink_ops rf_sink_y4m = {.scheme = "y4m",
                                        .open = open_y4m,
                                        .takes = takes_yuv,
                                        .start = start_stream,
                                        .write = write_stream,
                                        .close = close_stream};
const struct rf_sink_ops rf_sink_raw = {.scheme = "raw",
                                        .open = open_raw,
                                        .start = start_stream,
                                        .write = write_stream,
                                        .close = close_stream};

struct sequence {
    char *pattern;
    int next;
};

static int open_pictures(struct refocus_sink *sink, const char *rest,
                         struct refocus_reason *reason)
{
    struct sequence *sequence = calloc(1, sizeof *sequence);

    if (sequence)
        sequence->pattern = strdup(rest);
    if (!sequence || !sequence->pattern) {
        free(sequence);
        return rf_capture_fail_memory(reason);
    }
    sink->state = sequence;
    return REFOCUS_OK;
}

static int start_pictures(struct refocus_sink *sink, int width, int height, double fps,
                          struct refocus_reason *reason)
{
    (void)sink;
    (void)width;
    (void)height;
    (void)fps;
    (void)reason;
    return REFOCUS_OK;
}

static int write_picture(struct refocus_sink *sink, const struct refocus_image *image,
                         struct refocus_reason *reason)
{
    struct sequence *sequence = sink->state;
    char name[PATH_MAX];

    if (!rf_pattern_name(name, sizeof name, sequence->pattern, sequence->next))
        return rf_capture_fail(reason, REFOCUS_ERR_ARGUMENT, "the name is too long");
    sequence->next++;
    return refocus_image_write(name, image, NULL, reason);
}

static int close_pictures(struct refocus_sink *sink, struct refocus_reason *reason)
{
    struct sequence *sequence = sink->state;

    (void)reason;
    free(sequence->pattern);
    free(sequence);
    return REFOCUS_OK;
}

const struct rf_sink_ops rf_sink_pictures = {.scheme = NULL,
                                             .open = open_pictures,
                                             .start = start_pictures,
                                             .write = write_picture,
                                             .close = close_pictures};
