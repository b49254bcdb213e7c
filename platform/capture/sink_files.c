/* sink_files.c: the sinks `y4m:` and `raw:`, into a file, a pipe or standard output, and sequences
 * of pictures. */
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>
#include "file/letters.h"
#include "pattern.h"
#include "rgb_to_yuv.h"
#include "samples.h"
#include "sink.h"
#include "y4m.h"

struct stream {
    char *path;
    int fd;
    bool y4m, begun;
    bool ours, made;            /* the file was opened here; it was not there before */
    bool own;                   /* raw: frames are as pictures come */
    bool tall;                  /* y4m: U and V have all rows */
    uint32_t range;             /* enum refocus_range of its pictures */
    uint32_t layout;            /* raw: enum refocus_frame_format of frames */
    struct refocus_frame frame; /* the frame as it is written, in memory */
    uint8_t *memory;
    size_t bytes;
};

/* A write into a closed pipe raises SIGPIPE, which is the program's business and not
 * ours: it is held back in this thread, and taken away when it was this write that
 * raised it. It may have written a part before the pipe was closed. */
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
    if ((n < 0 ? error == EPIPE : (size_t)n < size) && !sigismember(&pending, SIGPIPE))
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

/* "FILE,NV12" or "FILE,own", split; names may hold commas where a dot or a slash
 * follows. */
static int parse_raw(struct stream *stream, struct refocus_reason *reason)
{
    char *const comma = strrchr(stream->path, ',');

    stream->layout = REFOCUS_FRAME_RGB24;
    if (!comma || strpbrk(comma, "./"))
        return REFOCUS_OK;
    stream->own = rf_same_word(comma + 1, "own");
    if (!stream->own)
        stream->layout = rf_format_by_name(comma + 1);
    if (!stream->own && !rf_can_encode(stream->layout))
        return rf_capture_fail(reason, REFOCUS_ERR_ARGUMENT,
                               "'%.40s' is no format of raw frames that can be written; give own, "
                               "NV12, NV21, YUV420, YUYV, UYVY, RGB24, BGR24, RGBX or BGRX",
                               comma + 1);
    *comma = '\0';
    return REFOCUS_OK;
}

/* A file that is there stays as it is until the first frame is announced. */
static int open_file(struct stream *stream, struct refocus_reason *reason)
{
    const int flags = O_WRONLY | O_CREAT | O_CLOEXEC;

    if (!*stream->path)
        return rf_capture_fail(reason, REFOCUS_ERR_ARGUMENT,
                               "give the name of a file behind the colon, or '-'");
    stream->ours = strcmp(stream->path, "-") != 0;
    if (stream->ours) {
        stream->fd = open(stream->path, flags | O_EXCL, 0666);
        stream->made = stream->fd >= 0;
        if (!stream->made && errno == EEXIST)
            stream->fd = open(stream->path, flags, 0666);
    } else {
        stream->fd = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
    }
    return stream->fd < 0 ? rf_capture_fail_errno(reason, errno, stream->path) : REFOCUS_OK;
}

/* The old contents go; pipes and devices have none. */
static int empty_file(const struct stream *stream, struct refocus_reason *reason)
{
    struct stat found;

    if (!stream->ours || fstat(stream->fd, &found) != 0 || !S_ISREG(found.st_mode) ||
        ftruncate(stream->fd, 0) == 0)
        return REFOCUS_OK;
    return rf_capture_fail_errno(reason, errno, stream->path);
}

static int open_stream(struct refocus_sink *sink, const char *rest, bool y4m,
                       struct refocus_reason *reason)
{
    struct stream *stream = calloc(1, sizeof *stream);
    int status = REFOCUS_OK;

    if (!stream)
        return rf_capture_fail_memory(reason);
    stream->y4m = y4m;
    stream->path = strdup(rest);
    if (!stream->path)
        status = rf_capture_fail_memory(reason);
    if (status == REFOCUS_OK && !y4m)
        status = parse_raw(stream, reason);
    if (status == REFOCUS_OK)
        status = open_file(stream, reason);
    if (status != REFOCUS_OK) {
        free(stream->path);
        free(stream);
        return status;
    }
    sink->state = stream;
    return REFOCUS_OK;
}

static int open_y4m(struct refocus_sink *sink, const char *rest, struct refocus_reason *reason)
{
    return open_stream(sink, rest, true, reason);
}

static int open_raw(struct refocus_sink *sink, const char *rest, struct refocus_reason *reason)
{
    return open_stream(sink, rest, false, reason);
}

static bool is_422(uint32_t format)
{
    return format == REFOCUS_FORMAT_YUYV;
}

static uint32_t range_of(const struct refocus_sink *sink)
{
    return sink->format == REFOCUS_FORMAT_RGB8 ? (uint32_t)REFOCUS_RANGE_LIMITED : sink->range;
}

static bool y4m_takes(const struct refocus_sink *sink, uint32_t format)
{
    (void)sink;
    (void)format;
    return true;
}

static bool raw_takes(const struct refocus_sink *sink, uint32_t format)
{
    const struct stream *stream = sink->state;

    (void)format;
    return stream->own || rf_has_samples(stream->layout);
}

/* The frames that pictures of the sink's format become. */
static uint32_t layout_of(const struct refocus_sink *sink)
{
    const struct stream *stream = sink->state;

    if (stream->y4m)
        return REFOCUS_FRAME_YUV420;
    if (!stream->own)
        return stream->layout;
    return sink->format == REFOCUS_FORMAT_RGB8 ? (uint32_t)REFOCUS_FRAME_RGB24
                                               : rf_frame_format_of(sink->format);
}

/* Planes of y4m are those of YUV420; in 4:2:2 U and V have all rows. */
static bool lay_out(struct stream *stream, uint32_t layout, int width, int height)
{
    struct refocus_frame *frame = &stream->frame;
    const size_t half = ((size_t)width + 1) / 2;

    *frame = refocus_frame_default();
    frame->format = layout;
    frame->width = width;
    frame->height = height;
    frame->matrix = rf_matrix_by_size(width, height);
    stream->bytes =
        (size_t)rf_frame_bytes(frame->format, rf_plane_row(frame->format, 0, width), width, height);
    if (stream->tall)
        stream->bytes = ((size_t)width + 2 * half) * (size_t)height;
    stream->memory = malloc(stream->bytes);
    if (!stream->memory)
        return false;
    rf_frame_lay_out(frame, stream->memory, rf_plane_row(frame->format, 0, width));
    if (stream->tall)
        frame->plane[2] = frame->plane[1] + half * (size_t)height;
    return true;
}

static size_t write_header(const struct refocus_sink *sink, char header[RF_Y4M_HEADER], double fps)
{
    const struct stream *const stream = sink->state;
    const bool own = sink->format != REFOCUS_FORMAT_RGB8;
    const struct rf_y4m y4m = {.tall = stream->tall,
                               .full_range = stream->range == REFOCUS_RANGE_FULL,
                               .width = stream->frame.width,
                               .height = stream->frame.height,
                               .fps = fps,
                               .aspect = {sink->aspect[0], sink->aspect[1]},
                               .chroma_place = own ? sink->chroma_place : 0};

    return rf_y4m_write(header, &y4m);
}

static int start_stream(struct refocus_sink *sink, int width, int height, double fps,
                        struct refocus_reason *reason)
{
    struct stream *stream = sink->state;
    char header[RF_Y4M_HEADER];
    int status;

    const uint32_t layout = layout_of(sink);
    const bool tall = stream->y4m && is_422(sink->format);

    if (stream->begun) {
        if (width == stream->frame.width && height == stream->frame.height &&
            tall == stream->tall && layout == stream->frame.format &&
            range_of(sink) == stream->range)
            return REFOCUS_OK;
        return rf_capture_fail(
            reason, REFOCUS_ERR_UNSUPPORTED,
            "%.120s: a stream of %dx%d has begun, and %dx%d came, or other colours; begin another",
            stream->path, stream->frame.width, stream->frame.height, width, height);
    }
    stream->tall = tall;
    stream->range = range_of(sink);
    if (!lay_out(stream, layout, width, height))
        return rf_capture_fail_memory(reason);
    status = empty_file(stream, reason);
    if (status != REFOCUS_OK)
        return status;
    /* y4m says the size at once: only a header that was written is begun. */
    stream->begun = true;
    if (!stream->y4m)
        return REFOCUS_OK;
    return write_all(stream, header, write_header(sink, header, fps), reason);
}

static int write_stream(struct refocus_sink *sink, const struct refocus_image *image,
                        struct refocus_reason *reason)
{
    struct stream *stream = sink->state;
    int status = REFOCUS_OK;

    if (image->format == REFOCUS_FORMAT_RGB8)
        rf_encode(image, &stream->frame);
    else
        rf_rearrange(image, &stream->frame,
                     stream->tall ? image->height
                                  : rf_rows_of_chroma(stream->frame.format, image->height));
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
    if (stream->made && !stream->begun)
        unlink(stream->path);
    free(stream->memory);
    free(stream->path);
    free(stream);
    return status;
}

const struct rf_sink_ops rf_sink_y4m = {.scheme = "y4m",
                                        .open = open_y4m,
                                        .takes = y4m_takes,
                                        .start = start_stream,
                                        .write = write_stream,
                                        .close = close_stream};
const struct rf_sink_ops rf_sink_raw = {.scheme = "raw",
                                        .open = open_raw,
                                        .takes = raw_takes,
                                        .start = start_stream,
                                        .write = write_stream,
                                        .close = close_stream};

struct sequence {
    char *pattern;
    int next;
};

static int open_pictures(struct refocus_sink *sink, const char *rest, struct refocus_reason *reason)
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

static int write_picture(struct refocus_sink *sink, const struct refocus_image *image,
                         struct refocus_reason *reason)
{
    struct sequence *sequence = sink->state;
    struct refocus_write_options options = refocus_write_options_default();
    char name[PATH_MAX];

    if (!rf_pattern_name(name, sizeof name, sequence->pattern, sequence->next))
        return rf_capture_fail(reason, REFOCUS_ERR_ARGUMENT, "the name is too long");
    sequence->next++;
    options.unsynced = 1; /* The next frame does not wait for the disk. */
    options.cancelled = sink->cancelled;
    options.user = sink->user;
    return refocus_image_write(name, image, &options, reason);
}

static int close_pictures(struct refocus_sink *sink, struct refocus_reason *reason)
{
    struct sequence *sequence = sink->state;

    (void)reason;
    free(sequence->pattern);
    free(sequence);
    return REFOCUS_OK;
}

const struct rf_sink_ops rf_sink_pictures = {
    .scheme = NULL, .open = open_pictures, .write = write_picture, .close = close_pictures};
