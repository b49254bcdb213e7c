/* pictures.c: the source `file:`: pictures, or the samples of depth files, as frames. */
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "backend.h"
#include "pattern.h"
#include "ring.h"

struct pictures {
    char *pattern;
    bool many;
    int first; /* numbers of files; the next one may be one that no file can have */
    int64_t next;
    int64_t frame; /* since the start */
    struct rf_pace pace;
    struct rf_ring ring; /* without memory: photos own it */
    struct refocus_photo *photo[RF_MOST_BUFFERS];
    struct refocus_photo *still; /* the one picture */
    int width, height;           /* size of the frame before, 0 at the beginning */
};

static void note_first(void *first, const char *path, int n)
{
    int *const least = first;

    (void)path;
    *least = n < *least || *least < 0 ? n : *least;
}

static int open_pictures(struct refocus_source *source, const char *rest,
                         struct refocus_reason *reason)
{
    struct pictures *pictures;
    const int many = rf_pattern_check(rest);
    bool memory = true;

    if (many < 0 || !*rest)
        return rf_capture_fail(reason, REFOCUS_ERR_ARGUMENT,
                               "give file:NAME, or a pattern with one %%d such as "
                               "file:frames-%%04d.png");
    pictures = calloc(1, sizeof *pictures);
    if (pictures)
        pictures->pattern = strdup(rest);
    if (!pictures || !pictures->pattern) {
        free(pictures);
        return rf_capture_fail_memory(reason);
    }
    pictures->many = many == 1;
    pictures->first = -1;
    if (many)
        memory = rf_pattern_each(rest, note_first, &pictures->first);
    else if (access(rest, F_OK) == 0)
        pictures->first = 0;
    if (pictures->first < 0) {
        free(pictures->pattern);
        free(pictures);
        return memory ? rf_capture_fail(reason, REFOCUS_ERR_GONE, "%.180s: no such file", rest)
                      : rf_capture_fail_memory(reason);
    }
    source->state = pictures;
    return REFOCUS_OK;
}

static int get_mode(struct refocus_source *source, int index, struct refocus_source_mode *mode)
{
    (void)source;
    if (index > 0)
        return REFOCUS_ERR_ARGUMENT;
    mode->format = REFOCUS_FRAME_RGB24;
    return REFOCUS_OK;
}

/* The reason of an error names the picture of a sequence. */
static int read_photo(const struct refocus_source *source, struct refocus_photo **photo,
                      const char *name, struct refocus_reason *reason)
{
    const struct pictures *const pictures = source->state;
    struct refocus_reason why = {""};
    const int status = source->config.flags & REFOCUS_SOURCE_DEPTH
                           ? refocus_depth_read(photo, name, NULL, 0, 0, NULL, &why)
                           : refocus_photo_read(photo, name, NULL, &why);

    if (status == REFOCUS_OK || !pictures->many)
        *reason = why;
    else
        rf_capture_fail(reason, status, "%.100s: %.150s", name,
                        why.text[0] ? why.text : "it cannot be read");
    return status;
}

/* Point the frame into the photo. */
static int show(struct refocus_frame *frame, const struct refocus_photo *photo,
                struct refocus_reason *reason)
{
    const struct refocus_image *image = photo->image;

    if (image->plane[0]) {
        frame->format = REFOCUS_FRAME_RGB24;
        frame->width = image->width;
        frame->height = image->height;
        frame->plane[0] = image->plane[0];
        frame->stride[0] = image->stride[0];
        return REFOCUS_OK;
    }
    if (photo->depth->sample == REFOCUS_SAMPLE_F32)
        return rf_capture_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                               "depth of floats is not streamed; give 8 or 16 bits");
    frame->format =
        photo->depth->sample == REFOCUS_SAMPLE_U8 ? REFOCUS_FRAME_GREY : REFOCUS_FRAME_Y16;
    frame->width = photo->depth->width;
    frame->height = photo->depth->height;
    frame->plane[0] = photo->depth->samples;
    frame->stride[0] = photo->depth->stride;
    return REFOCUS_OK;
}

static int start(struct refocus_source *source, struct refocus_source_mode *mode,
                 struct refocus_reason *reason)
{
    struct pictures *pictures = source->state;
    const bool fast = source->config.flags & REFOCUS_SOURCE_FAST;
    char name[PATH_MAX];
    struct refocus_frame frame = refocus_frame_default();
    int status = REFOCUS_OK;

    if (!rf_pattern_name(name, sizeof name, pictures->pattern, pictures->first))
        return rf_capture_fail(reason, REFOCUS_ERR_ARGUMENT, "the name is too long");
    refocus_photo_free(&pictures->still);
    status = read_photo(source, &pictures->still, name, reason);
    if (status == REFOCUS_OK)
        status = show(&frame, pictures->still, reason);
    if (status != REFOCUS_OK)
        return status;
    mode->format = frame.format;
    mode->width = frame.width;
    mode->height = frame.height;
    mode->fps = rf_source_fps(source, 0);
    if (pictures->many)
        refocus_photo_free(&pictures->still);
    pictures->next = pictures->first;
    pictures->frame = 0;
    pictures->width = 0;
    pictures->ring.count = source->config.buffers;
    pictures->ring.taken = 0;
    rf_pace_start(&pictures->pace, mode->fps, fast);
    return REFOCUS_OK;
}

/* The end of a sequence is told from a gap by the numbers behind it, this many. */
enum { LONGEST_GAP = 100 };

/* Whether there is a picture of that number, and its name. */
static bool has_number(const struct pictures *pictures, int64_t n, char name[PATH_MAX])
{
    name[0] = '\0';
    return n <= INT_MAX && rf_pattern_name(name, PATH_MAX, pictures->pattern, (int)n) &&
           access(name, F_OK) == 0;
}

static int check_gap(const struct pictures *pictures, const char *missing,
                     struct refocus_reason *reason)
{
    char name[PATH_MAX];

    for (int i = 1; i <= LONGEST_GAP; i++)
        if (has_number(pictures, pictures->next + i, name))
            return rf_capture_fail(
                reason, REFOCUS_ERR_FORMAT,
                "%.120s is missing, and there is %.120s; number them without a gap", missing, name);
    return REFOCUS_OK;
}

/* Read the picture that comes next into a buffer. */
static int read_next(struct refocus_source *source, int buffer, struct refocus_reason *reason)
{
    struct pictures *pictures = source->state;
    char name[PATH_MAX];

    if (!has_number(pictures, pictures->next, name)) {
        const int status = check_gap(pictures, name, reason);

        if (status != REFOCUS_OK)
            return status;
        if (!(source->config.flags & REFOCUS_SOURCE_LOOP) || pictures->next == pictures->first)
            return rf_capture_fail(reason, REFOCUS_ERR_END, "there are no more pictures");
        pictures->next = pictures->first;
        has_number(pictures, pictures->next, name);
    }
    refocus_photo_free(&pictures->photo[buffer]);
    return read_photo(source, &pictures->photo[buffer], name, reason);
}

/* One map of many that is missing or damaged is no end: what depth was before still serves. */
static bool is_left_out(const struct refocus_source *source, int status)
{
    const struct pictures *pictures = source->state;

    return pictures->many && source->config.flags & REFOCUS_SOURCE_DEPTH &&
           status != REFOCUS_ERR_END && status != REFOCUS_ERR_MEMORY;
}

/* Whether the size differs from that of the frame before. */
static bool has_changed(struct pictures *pictures, const struct refocus_frame *frame)
{
    const bool changed =
        pictures->width && (pictures->width != frame->width || pictures->height != frame->height);

    pictures->width = frame->width;
    pictures->height = frame->height;
    return changed;
}

static int wait_frame(struct refocus_source *source, int64_t deadline_ns,
                      struct refocus_frame **result, struct refocus_reason *reason)
{
    struct pictures *pictures = source->state;
    const int64_t due = rf_pace_due(&pictures->pace, pictures->frame);
    struct refocus_frame *frame;
    int buffer, status;

    status = pictures->pace.fast ? REFOCUS_OK : rf_source_sleep(source, due, deadline_ns);
    if (status != REFOCUS_OK)
        return status;
    buffer = rf_ring_take(&pictures->ring, reason);
    if (buffer < 0)
        return REFOCUS_ERR_STATE;
    frame = &pictures->ring.frame[buffer];
    *frame = refocus_frame_default();
    status = pictures->many ? read_next(source, buffer, reason) : REFOCUS_OK;
    if (status == REFOCUS_OK)
        status = show(frame, pictures->many ? pictures->photo[buffer] : pictures->still, reason);
    if (status != REFOCUS_OK && !is_left_out(source, status)) {
        rf_ring_give(&pictures->ring, (uint32_t)buffer);
        return status;
    }
    if (status != REFOCUS_OK)
        frame->flags |= REFOCUS_FRAME_CORRUPT;
    else if (has_changed(pictures, frame))
        frame->flags |= REFOCUS_FRAME_CHANGED;
    frame->buffer = (uint32_t)buffer;
    frame->sequence = (uint32_t)pictures->frame;
    frame->timestamp_ns = due;
    if (!pictures->many)
        frame->flags |= REFOCUS_FRAME_STILL;
    if (!pictures->pace.fast)
        frame->flags |= REFOCUS_FRAME_MONOTONIC;
    pictures->frame++;
    pictures->next++;
    *result = frame;
    return REFOCUS_OK;
}

static void release(struct refocus_source *source, struct refocus_frame *frame)
{
    struct pictures *pictures = source->state;

    refocus_photo_free(&pictures->photo[frame->buffer]);
    rf_ring_give(&pictures->ring, frame->buffer);
}

static void stop(struct refocus_source *source)
{
    struct pictures *pictures = source->state;

    for (int i = 0; i < RF_MOST_BUFFERS; i++)
        refocus_photo_free(&pictures->photo[i]);
    refocus_photo_free(&pictures->still);
}

static void close_pictures(struct refocus_source *source)
{
    struct pictures *pictures = source->state;

    stop(source);
    free(pictures->pattern);
    free(pictures);
}

const struct rf_source_ops rf_source_file = {
    .scheme = "file",
    .kind = REFOCUS_SOURCE_KIND_FILE,
    .open = open_pictures,
    .get_mode = get_mode,
    .start = start,
    .wait = wait_frame,
    .release = release,
    .stop = stop,
    .close = close_pictures,
};
