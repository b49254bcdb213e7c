/* stream.c: the sources `y4m:` and `raw:`: streams of frames out of one file. */
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "bytes.h"
#include "file/number.h"
#include "ring.h"
#include "samples.h"
#include "y4m.h"

enum { LONGEST_HEADER = 1024 };

struct stream {
    int fd;
    bool y4m, is_pipe;
    bool known;      /* the format and size are */
    bool tall;       /* y4m of 4:2:2, which becomes YUYV: U and V have all rows */
    uint8_t *planes; /* memory for such planes */
    char *path;      /* owned */
    off_t begin;     /* offset of the first frame */
    uint32_t format, flags;
    int width, height;
    double fps; /* 0: it does not say so */
    int32_t aspect[2];
    uint32_t chroma_place;
    int64_t frame;
    struct rf_pace pace;
    struct rf_ring ring;
};

static int parse_y4m(const struct refocus_source *source, struct refocus_reason *reason)
{
    struct stream *stream = source->state;
    char header[LONGEST_HEADER];
    struct rf_y4m y4m;
    int status = rf_read_line(source, stream->fd, header, sizeof header, reason);

    if (status == REFOCUS_ERR_END || status == REFOCUS_ERR_FORMAT)
        header[0] = '\0'; /* It is too short, or too long. */
    else if (status != REFOCUS_OK)
        return status;
    status = rf_y4m_parse(&y4m, header, stream->path, reason);
    stream->format = y4m.format;
    stream->flags = y4m.full_range ? REFOCUS_FRAME_FULL_RANGE : 0;
    stream->tall = y4m.tall;
    stream->width = y4m.width;
    stream->height = y4m.height;
    stream->fps = y4m.fps;
    stream->aspect[0] = y4m.aspect[0];
    stream->aspect[1] = y4m.aspect[1];
    stream->chroma_place = y4m.chroma_place;
    return status;
}

/* A number that is the whole of the text, above 0. */
static bool parse_rate(const char *text, double *fps)
{
    return strspn(text, "0123456789.") > 0 && rf_parse_number(text, fps) && *fps > 0;
}

/* "640x480", each of at most six digits, and nothing behind it. */
static bool parse_size(const char *text, int *width, int *height)
{
    const size_t first = strspn(text, "0123456789");
    const size_t second = text[first] == 'x' ? strspn(text + first + 1, "0123456789") : 0;

    if (first < 1 || first > 6 || second < 1 || second > 6 || text[first + 1 + second])
        return false;
    *width = (int)strtol(text, NULL, 10);
    *height = (int)strtol(text + first + 1, NULL, 10);
    return true;
}

/* "FILE,NV12,640x480,30": from the end, as names may hold commas. */
static int parse_raw(struct stream *stream, struct refocus_reason *reason)
{
    char *word[3] = {NULL, NULL, NULL};
    int n = 0;

    for (int i = 0; i < 3; i++) {
        char *comma = strrchr(stream->path, ',');

        if (!comma)
            break;
        *comma = '\0';
        word[n++] = comma + 1;
        if (rf_format_by_name(comma + 1) != REFOCUS_FRAME_ANY)
            break;
    }
    if (n < 2 || (n == 3 && !parse_rate(word[0], &stream->fps)) ||
        !parse_size(word[n - 2], &stream->width, &stream->height))
        return rf_capture_fail(reason, REFOCUS_ERR_ARGUMENT,
                               "give raw:FILE,FORMAT,WIDTHxHEIGHT or with ,FPS behind");
    stream->format = rf_format_by_name(word[n - 1]);
    if (stream->format == REFOCUS_FRAME_ANY || stream->format == REFOCUS_FRAME_MJPEG)
        return rf_capture_fail(
            reason, REFOCUS_ERR_ARGUMENT,
            "'%.40s' is no format of raw frames; give NV12, YUYV, RGB24, Y16, ...", word[n - 1]);
    return REFOCUS_OK;
}

static void close_stream(struct refocus_source *source)
{
    struct stream *stream = source->state;

    if (stream->fd >= 0 && strcmp(stream->path, "-") != 0)
        close(stream->fd);
    rf_ring_free(&stream->ring);
    free(stream->planes);
    free(stream->path);
    free(stream);
}

/* A pipe that nobody writes to yet is opened all the same. */
static int open_file(struct stream *stream, struct refocus_reason *reason)
{
    if (strcmp(stream->path, "-") == 0)
        stream->fd = STDIN_FILENO;
    else
        stream->fd = open(stream->path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (stream->fd < 0)
        return rf_capture_fail_errno(reason, errno, stream->path);
    stream->begin = lseek(stream->fd, 0, SEEK_CUR);
    stream->is_pipe = stream->begin < 0;
    return REFOCUS_OK;
}

/* Find out format and size, where this has not been done. */
static int know(const struct refocus_source *source, struct refocus_reason *reason)
{
    struct stream *stream = source->state;
    int status = REFOCUS_OK;

    if (stream->known)
        return REFOCUS_OK;
    if (stream->y4m)
        status = parse_y4m(source, reason);
    if (status != REFOCUS_OK)
        return status;
    if (rf_frame_bytes(stream->format, rf_plane_row(stream->format, 0, stream->width),
                       stream->width, stream->height) == 0)
        return rf_capture_fail(reason, REFOCUS_ERR_SIZE,
                               "%.160s: %dx%d pixels are out of the range", stream->path,
                               stream->width, stream->height);
    if (!stream->is_pipe)
        stream->begin = lseek(stream->fd, 0, SEEK_CUR);
    stream->known = true;
    return REFOCUS_OK;
}

static int open_stream(struct refocus_source *source, const char *rest, bool y4m,
                       struct refocus_reason *reason)
{
    struct stream *stream = calloc(1, sizeof *stream);
    int status = REFOCUS_OK;

    if (!stream)
        return rf_capture_fail_memory(reason);
    source->state = stream;
    stream->fd = -1;
    stream->y4m = y4m;
    stream->path = strdup(rest);
    if (!stream->path)
        status = rf_capture_fail_memory(reason);
    if (status == REFOCUS_OK && !y4m)
        status = parse_raw(stream, reason);
    if (status == REFOCUS_OK)
        status = open_file(stream, reason);
    /* Nobody can interrupt a source that is not open yet: the header of a pipe is read later. */
    if (status == REFOCUS_OK && !(y4m && stream->is_pipe))
        status = know(source, reason);
    if (status != REFOCUS_OK)
        close_stream(source);
    return status;
}

static int open_y4m(struct refocus_source *source, const char *rest, struct refocus_reason *reason)
{
    return open_stream(source, rest, true, reason);
}

static int open_raw(struct refocus_source *source, const char *rest, struct refocus_reason *reason)
{
    return open_stream(source, rest, false, reason);
}

static int get_mode(struct refocus_source *source, int index, struct refocus_source_mode *mode)
{
    const struct stream *stream = source->state;
    struct refocus_reason unheard;
    const int status = index > 0 ? REFOCUS_ERR_ARGUMENT : know(source, &unheard);

    if (status != REFOCUS_OK)
        return status;
    mode->format = stream->format;
    mode->width = stream->width;
    mode->height = stream->height;
    mode->fps = stream->fps;
    mode->pixel_aspect[0] = stream->aspect[0];
    mode->pixel_aspect[1] = stream->aspect[1];
    mode->chroma_place = stream->chroma_place;
    return REFOCUS_OK;
}

static int start(struct refocus_source *source, struct refocus_source_mode *mode,
                 struct refocus_reason *reason)
{
    struct stream *stream = source->state;
    const int status = know(source, reason);

    if (status != REFOCUS_OK)
        return status;
    if (stream->is_pipe && source->config.flags & REFOCUS_SOURCE_LOOP)
        return rf_capture_fail(
            reason, REFOCUS_ERR_ARGUMENT,
            "%.160s: a pipe has no beginning to go back to; read it without a loop", stream->path);
    if (!stream->is_pipe && lseek(stream->fd, stream->begin, SEEK_SET) < 0)
        return rf_capture_fail_errno(reason, errno, stream->path);
    stream->ring.count = source->config.buffers;
    stream->ring.taken = 0;
    stream->frame = 0;
    get_mode(source, 0, mode);
    mode->fps = rf_source_fps(source, stream->fps);
    rf_pace_start(&stream->pace, mode->fps, source->config.flags & REFOCUS_SOURCE_FAST);
    return REFOCUS_OK;
}

/* Read one frame into memory; REFOCUS_ERR_END where the next one would begin. */
static int read_frame(const struct refocus_source *source, uint8_t *memory, size_t bytes,
                      struct refocus_reason *reason)
{
    const struct stream *stream = source->state;
    char header[LONGEST_HEADER];
    int status = REFOCUS_OK;
    size_t n;

    if (stream->y4m) {
        status = rf_read_line(source, stream->fd, header, sizeof header, reason);
        if (status == REFOCUS_ERR_END)
            return rf_capture_fail(reason, status, "there are no more frames");
        if (status != REFOCUS_OK && status != REFOCUS_ERR_FORMAT)
            return status;
        if (status != REFOCUS_OK || strncmp(header, "FRAME", 5) != 0)
            return rf_capture_fail(reason, REFOCUS_ERR_FORMAT,
                                   "%.160s: damaged: frame %lld does not begin with FRAME",
                                   stream->path, (long long)stream->frame);
    }
    status = rf_read_bytes(source, stream->fd, memory, bytes, &n, reason);
    if (status != REFOCUS_OK || n == bytes)
        return status;
    if (n == 0 && !stream->y4m)
        return rf_capture_fail(reason, REFOCUS_ERR_END, "there are no more frames");
    return rf_capture_fail(reason, REFOCUS_ERR_FORMAT,
                           "%.160s: it ends within frame %lld; was it cut off?", stream->path,
                           (long long)stream->frame);
}

/* Read a frame of 4:2:2 in planes, and pack it. */
static int read_tall(const struct refocus_source *source, uint8_t *memory,
                     struct refocus_reason *reason)
{
    struct stream *stream = source->state;
    const size_t w = (size_t)stream->width, h = (size_t)stream->height, half = (w + 1) / 2;
    const size_t bytes = (w + 2 * half) * h;
    struct rf_samples from[3], to[3];
    int status;

    if (!stream->planes)
        stream->planes = malloc(bytes);
    if (!stream->planes)
        return rf_capture_fail_memory(reason);
    status = read_frame(source, stream->planes, bytes, reason);
    if (status != REFOCUS_OK)
        return status;
    rf_samples_of(from, REFOCUS_FRAME_YUV420,
                  (const uint8_t *const[3]){stream->planes, stream->planes + w * h,
                                            stream->planes + (w + half) * h},
                  (const ptrdiff_t[3]){(ptrdiff_t)w, (ptrdiff_t)half, (ptrdiff_t)half});
    rf_samples_of(to, REFOCUS_FRAME_YUYV, (const uint8_t *const[3]){memory, NULL, NULL},
                  (const ptrdiff_t[3]){4 * (ptrdiff_t)half, 0, 0});
    rf_copy_samples(to, stream->height, from, stream->height, stream->width, stream->height);
    return REFOCUS_OK;
}

static int read_next(const struct refocus_source *source, uint8_t *memory, size_t bytes,
                     struct refocus_reason *reason)
{
    const struct stream *stream = source->state;

    return stream->tall ? read_tall(source, memory, reason)
                        : read_frame(source, memory, bytes, reason);
}

static int wait_frame(struct refocus_source *source, int64_t deadline_ns,
                      struct refocus_frame **result, struct refocus_reason *reason)
{
    struct stream *stream = source->state;
    const int64_t due = rf_pace_due(&stream->pace, stream->frame);
    const int64_t row = rf_plane_row(stream->format, 0, stream->width);
    const uint64_t bytes = rf_frame_bytes(stream->format, row, stream->width, stream->height);
    struct refocus_frame *frame;
    int buffer, status;

    status = stream->pace.fast ? REFOCUS_OK : rf_source_sleep(source, due, deadline_ns);
    if (status != REFOCUS_OK)
        return status;
    buffer = rf_ring_take(&stream->ring, reason);
    if (buffer < 0)
        return REFOCUS_ERR_STATE;
    status = rf_ring_reserve(&stream->ring, buffer, bytes)
                 ? read_next(source, stream->ring.memory[buffer], (size_t)bytes, reason)
                 : rf_capture_fail_memory(reason);
    if (status == REFOCUS_ERR_END && source->config.flags & REFOCUS_SOURCE_LOOP &&
        !stream->is_pipe && stream->frame > 0 && lseek(stream->fd, stream->begin, SEEK_SET) >= 0)
        status = read_next(source, stream->ring.memory[buffer], (size_t)bytes, reason);
    if (status != REFOCUS_OK) {
        rf_ring_give(&stream->ring, (uint32_t)buffer);
        return status;
    }
    frame = &stream->ring.frame[buffer];
    *frame = refocus_frame_default();
    frame->format = stream->format;
    frame->width = stream->width;
    frame->height = stream->height;
    frame->matrix = rf_matrix_by_size(stream->width, stream->height);
    rf_frame_lay_out(frame, stream->ring.memory[buffer], row);
    frame->buffer = (uint32_t)buffer;
    frame->sequence = (uint32_t)stream->frame++;
    frame->timestamp_ns = due;
    frame->flags = stream->flags | (stream->pace.fast ? 0 : REFOCUS_FRAME_MONOTONIC);
    *result = frame;
    return REFOCUS_OK;
}

static void release(struct refocus_source *source, struct refocus_frame *frame)
{
    rf_ring_give(&((struct stream *)source->state)->ring, frame->buffer);
}

static void stop(struct refocus_source *source)
{
    ((struct stream *)source->state)->ring.taken = 0;
}

static int reopen(struct refocus_source *source, struct refocus_reason *reason)
{
    const struct stream *stream = source->state;

    if (stream->is_pipe)
        return rf_capture_fail(reason, REFOCUS_ERR_END, "%.160s: a pipe cannot be read again",
                               stream->path);
    return REFOCUS_OK;
}

#define STREAM_OPS(word, open_function)                                                            \
    {                                                                                              \
        .scheme = word, .kind = REFOCUS_SOURCE_KIND_FILE, .open = open_function,                   \
        .get_mode = get_mode, .start = start, .wait = wait_frame, .release = release,              \
        .stop = stop, .reopen = reopen, .close = close_stream                                      \
    }
const struct rf_source_ops rf_source_y4m = STREAM_OPS("y4m", open_y4m);
const struct rf_source_ops rf_source_raw = STREAM_OPS("raw", open_raw);
