/* replay.c: a camera by script, with buffers of its own, a clock, and every fault that cameras
 * have. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "backend.h"
#include "replay_lens.h"
#include "replay_scene.h"
#include "replay_script.h"
#include "ring.h"

enum { LONGEST_SCRIPT = 1 << 16, MOST_JPEG_BYTES = 1 << 24 };

struct replay {
    struct rf_script script;
    uint32_t format; /* as they are now, after changes */
    int width, height;
    int64_t stride;
    uint8_t *scene; /* the frame at rest, in the present format, or the bytes of the
                       JPEG */
    size_t scene_bytes;
    struct refocus_source *inner; /* source of "from", or a picture of the stack */
    struct rf_lens lens;
    int64_t next;  /* the frame to come */
    int64_t first; /* the frame that was due when the pace began */
    struct rf_pace pace;
    int64_t stalled_until_ns, gone_until_ns;
    bool failed, changed, gone;
    uint32_t cursed; /* buffers that will be lost on their return */
    int stuck;       /* buffers that were */
    struct rf_ring ring;
};

static int read_text(char **text, const char *path, struct refocus_reason *reason)
{
    FILE *file = fopen(path, "rb");
    size_t n;

    if (!file)
        return rf_capture_fail_errno(reason, errno, path);
    *text = malloc(LONGEST_SCRIPT + 1);
    if (!*text) {
        fclose(file);
        return rf_capture_fail_memory(reason);
    }
    n = fread(*text, 1, LONGEST_SCRIPT, file);
    (*text)[n] = '\0';
    fclose(file);
    return REFOCUS_OK;
}

static int draw_scene(struct replay *replay, struct refocus_reason *reason)
{
    const uint64_t bytes =
        rf_frame_bytes(replay->format, replay->stride, replay->width, replay->height);

    if (bytes == 0)
        return rf_capture_fail(reason, REFOCUS_ERR_FORMAT,
                               "the script's stride is less than a row");
    free(replay->scene);
    replay->scene = bytes < SIZE_MAX ? calloc(1, (size_t)bytes + 1) : NULL;
    if (!replay->scene)
        return rf_capture_fail_memory(reason);
    replay->scene_bytes = (size_t)bytes;
    rf_scene_draw(replay->scene, replay->format, replay->stride, replay->width, replay->height);
    return REFOCUS_OK;
}

/* The bytes of the JPEG file, and by a decoder's eye its size. */
static int read_jpeg(struct replay *replay, struct refocus_reason *reason)
{
    struct refocus_photo *photo = NULL;
    FILE *file = fopen(replay->script.jpeg, "rb");
    int status = refocus_photo_read(&photo, replay->script.jpeg, NULL, reason);

    if (status == REFOCUS_OK) {
        replay->width = photo->info->stored_width;
        replay->height = photo->info->stored_height;
        refocus_photo_free(&photo);
        replay->scene = malloc(MOST_JPEG_BYTES);
        if (!replay->scene || !file)
            status = rf_capture_fail_memory(reason);
        else
            replay->scene_bytes = fread(replay->scene, 1, MOST_JPEG_BYTES, file);
    }
    if (file)
        fclose(file);
    return status;
}

static void close_replay(struct refocus_source *source)
{
    struct replay *replay = source->state;

    refocus_source_close(&replay->inner);
    rf_ring_free(&replay->ring);
    rf_script_free(&replay->script);
    free(replay->scene);
    free(replay);
}

static int open_replay(struct refocus_source *source, const char *rest,
                       struct refocus_reason *reason)
{
    struct replay *replay = calloc(1, sizeof *replay);
    char *text = NULL;
    int status;

    if (!replay)
        return rf_capture_fail_memory(reason);
    source->state = replay;
    if (*rest == ':') {
        text = strdup(rest + 1);
        status = text ? REFOCUS_OK : rf_capture_fail_memory(reason);
    } else {
        status = read_text(&text, rest, reason);
    }
    if (status == REFOCUS_OK)
        status = rf_script_parse(&replay->script, text, reason);
    free(text);
    replay->format = replay->script.format;
    replay->width = replay->script.width;
    replay->height = replay->script.height;
    replay->stride = replay->script.stride;
    rf_lens_start(&replay->lens, &replay->script);
    if (status == REFOCUS_OK && replay->script.stack)
        status = rf_lens_look(&replay->lens, &replay->script, &replay->inner, reason);
    else if (status == REFOCUS_OK && replay->script.jpeg)
        status = read_jpeg(replay, reason);
    else if (status == REFOCUS_OK && replay->script.from)
        status = refocus_source_open(&replay->inner, replay->script.from, reason);
    else if (status == REFOCUS_OK)
        status = draw_scene(replay, reason);
    if (status != REFOCUS_OK)
        close_replay(source);
    return status;
}

static int get_mode(struct refocus_source *source, int index, struct refocus_source_mode *mode)
{
    const struct replay *replay = source->state;

    if (index > 0)
        return REFOCUS_ERR_ARGUMENT;
    mode->format = replay->format;
    mode->width = replay->width;
    mode->height = replay->height;
    mode->fps = replay->script.fps;
    return REFOCUS_OK;
}

static int start(struct refocus_source *source, struct refocus_source_mode *mode,
                 struct refocus_reason *reason)
{
    struct replay *replay = source->state;
    const double fps = source->config.fps > 0 ? source->config.fps : replay->script.fps;

    if (replay->gone)
        return rf_capture_fail(reason, REFOCUS_ERR_GONE,
                               "the device is gone (by "
                               "script)");
    if (replay->script.start_errors > 0) {
        replay->script.start_errors--;
        return rf_capture_fail(reason, REFOCUS_ERR_IO,
                               "the stream cannot start (by "
                               "script)");
    }
    if (replay->inner) {
        struct refocus_source_config config = source->config;
        int status;

        refocus_source_stop(replay->inner);
        config.flags |= REFOCUS_SOURCE_FAST | REFOCUS_SOURCE_LOOP;
        status = refocus_source_start(replay->inner, &config, mode, reason);
        if (status != REFOCUS_OK)
            return status;
        replay->format = mode->format;
        replay->width = mode->width;
        replay->height = mode->height;
    }
    get_mode(source, 0, mode);
    mode->fps = fps;
    replay->failed = false;
    replay->cursed = 0;
    replay->stuck = 0;
    replay->ring.count = source->config.buffers;
    replay->ring.taken = 0;
    rf_pace_start(&replay->pace, fps, source->config.flags & REFOCUS_SOURCE_FAST);
    replay->first = replay->pace.fast ? 0 : replay->next;
    return REFOCUS_OK;
}

/* Any of the faults that leave the rest of the script as it is. */
static struct rf_event random_event(const struct replay *replay, int64_t frame)
{
    uint64_t h = (uint64_t)(frame + 1) * 0x9e3779b97f4a7c15u +
                 (uint64_t)replay->script.seed * 0xd1b54a32d192ed03u;
    struct rf_event event = {.frame = frame, .fault = RF_FAULT_NONE};

    h = (h ^ h >> 32) * 0xd6e8feb86659fd93u;
    h ^= h >> 32;
    if ((double)(h & 0xffff) >= replay->script.random_percent * 655.36)
        return event;
    event.fault = (enum rf_fault)(RF_FAULT_DROP + (h >> 16) % 8);
    event.value =
        event.fault == RF_FAULT_TIMESTAMP ? -(int64_t)(h >> 20 & 63) : 1 + (int64_t)(h >> 20 & 1);
    return event;
}

static int apply_to_stream(struct replay *replay, const struct rf_event *event,
                           struct refocus_reason *reason)
{
    switch (event->fault) {
    case RF_FAULT_STALL:
        replay->stalled_until_ns = rf_now_ns() + event->value * 1000000;
        break;
    case RF_FAULT_FAIL:
        replay->failed = true;
        break;
    case RF_FAULT_VANISH:
        replay->gone = true;
        replay->gone_until_ns = rf_now_ns() + event->value * 1000000;
        break;
    case RF_FAULT_STRIDE:
        replay->stride = event->value;
        replay->changed = true;
        return replay->inner || replay->script.jpeg ? REFOCUS_OK : draw_scene(replay, reason);
    case RF_FAULT_FORMAT:
        if (replay->inner || replay->script.jpeg)
            break;
        replay->format = event->format;
        replay->width = event->width;
        replay->height = event->height;
        replay->stride = rf_plane_row(event->format, 0, event->width);
        replay->changed = true;
        return draw_scene(replay, reason);
    default:
        break;
    }
    return REFOCUS_OK;
}

/* The faults of one frame; faults of the stream take effect at once. */
struct fate {
    int64_t dropped, late_ms, shift_ms;
    bool corrupt, queue_error, memory;
};

static void apply_to_frame(struct fate *fate, const struct rf_event *event)
{
    fate->dropped += event->fault == RF_FAULT_DROP ? event->value : 0;
    fate->late_ms += event->fault == RF_FAULT_LATE ? event->value : 0;
    fate->shift_ms += event->fault == RF_FAULT_TIMESTAMP ? event->value : 0;
    fate->corrupt |= event->fault == RF_FAULT_CORRUPT;
    fate->queue_error |= event->fault == RF_FAULT_QUEUE_ERROR;
    fate->memory |= event->fault == RF_FAULT_MEMORY;
}

/* The events of the frame to come; streams' events of frames that are passed over
 * count. */
static int decide(struct replay *replay, struct fate *fate, struct refocus_reason *reason)
{
    const struct rf_event chance = random_event(replay, replay->next);
    int status = apply_to_stream(replay, &chance, reason);

    memset(fate, 0, sizeof *fate);
    apply_to_frame(fate, &chance);
    for (int i = 0; i < replay->script.events && status == REFOCUS_OK; i++)
        if (replay->script.event[i].frame == replay->next) {
            apply_to_frame(fate, &replay->script.event[i]);
            status = apply_to_stream(replay, &replay->script.event[i], reason);
        }
    return status;
}

/* Copy the scene, moved sideways by four pixels a frame, as one that pans. */
static void copy_scene(const struct replay *replay, const struct refocus_frame *frame,
                       uint8_t *memory, int64_t number)
{
    const int64_t steps = frame->width / 4 > 0 ? frame->width / 4 : 1;
    const int64_t shift = number % steps * 4;
    const uint8_t *from = replay->scene;

    for (int i = 0; i < rf_format_planes(frame->format); i++) {
        const int64_t row = rf_plane_row(frame->format, i, frame->width);
        const int64_t cut = frame->width < 4 ? 0 : shift * row / frame->width / 4 * 4;

        for (int y = 0; y < rf_plane_rows(frame->format, i, frame->height); y++) {
            memcpy(memory, from + cut, (size_t)(row - cut));
            memcpy(memory + (row - cut), from, (size_t)cut);
            memory += frame->stride[i];
            from += frame->stride[i];
        }
    }
}

static int copy_inner(struct replay *replay, int buffer, struct refocus_frame *frame,
                      struct refocus_reason *reason)
{
    const struct refocus_frame *inner;
    const int status = refocus_source_wait(replay->inner, 1000, &inner, reason);
    int64_t stride;
    uint64_t bytes;

    if (status != REFOCUS_OK)
        return status;
    stride = rf_plane_row(inner->format, 0, inner->width);
    stride = replay->stride > stride ? replay->stride : stride;
    bytes = rf_frame_bytes(inner->format, stride, inner->width, inner->height);
    if (bytes == 0 || !rf_ring_reserve(&replay->ring, buffer, bytes)) {
        refocus_source_release(replay->inner, inner);
        return rf_capture_fail_memory(reason);
    }
    frame->format = inner->format;
    frame->width = inner->width;
    frame->height = inner->height;
    frame->flags |= inner->flags & REFOCUS_FRAME_FULL_RANGE;
    rf_frame_lay_out(frame, replay->ring.memory[buffer], stride);
    for (int i = 0; i < rf_format_planes(inner->format); i++) {
        uint8_t *to = replay->ring.memory[buffer] + (frame->plane[i] - frame->plane[0]);

        for (int y = 0; y < rf_plane_rows(inner->format, i, inner->height); y++)
            memcpy(to + y * frame->stride[i], inner->plane[i] + y * inner->stride[i],
                   (size_t)rf_plane_row(inner->format, i, inner->width));
    }
    refocus_source_release(replay->inner, inner);
    return REFOCUS_OK;
}

static int fill(struct replay *replay, int buffer, struct refocus_frame *frame,
                struct refocus_reason *reason)
{
    if (replay->script.stack) {
        const int status = rf_lens_look(&replay->lens, &replay->script, &replay->inner, reason);

        if (status != REFOCUS_OK)
            return status;
    }
    if (replay->inner)
        return copy_inner(replay, buffer, frame, reason);
    if (!rf_ring_reserve(&replay->ring, buffer, replay->scene_bytes))
        return rf_capture_fail_memory(reason);
    frame->format = replay->format;
    frame->width = replay->width;
    frame->height = replay->height;
    if (replay->format == REFOCUS_FRAME_MJPEG) {
        memcpy(replay->ring.memory[buffer], replay->scene, replay->scene_bytes);
        frame->plane[0] = replay->ring.memory[buffer];
        frame->bytes = replay->scene_bytes;
        return REFOCUS_OK;
    }
    rf_frame_lay_out(frame, replay->ring.memory[buffer], replay->stride);
    copy_scene(replay, frame, replay->ring.memory[buffer], replay->next);
    return REFOCUS_OK;
}

static bool is_over(const struct replay *replay, int64_t frame)
{
    return replay->script.frames > 0 && frame >= replay->script.frames;
}

static int64_t due_at(const struct replay *replay, int64_t frame)
{
    return rf_pace_due(&replay->pace, frame - replay->first);
}

/* A camera fills the buffers that it has; what comes then is dropped, but for the last
 * frame. */
static int pass_over(struct replay *replay, struct fate *fate, struct refocus_reason *reason)
{
    int status = decide(replay, fate, reason);

    while (status == REFOCUS_OK && !replay->pace.fast && !replay->failed && !replay->gone &&
           !is_over(replay, replay->next + 1) &&
           due_at(replay, replay->next + replay->ring.count) < rf_now_ns()) {
        replay->next++;
        status = decide(replay, fate, reason);
    }
    while (status == REFOCUS_OK && fate->dropped > 0) {
        const int64_t left = fate->dropped - 1;

        replay->next++;
        status = decide(replay, fate, reason);
        if (left > fate->dropped)
            fate->dropped = left;
    }
    return status;
}

static int sleep_until(const struct refocus_source *source, int64_t due, int64_t deadline_ns)
{
    int status;

    if (due <= rf_now_ns())
        return REFOCUS_OK;
    status = rf_source_poll(source, -1, 0, due < deadline_ns ? due : deadline_ns, NULL);
    return status == REFOCUS_ERR_TIMEOUT && due <= deadline_ns ? REFOCUS_OK : status;
}

static int check_stream(const struct replay *replay, struct refocus_reason *reason)
{
    if (replay->gone)
        return rf_capture_fail(reason, REFOCUS_ERR_GONE,
                               "the device is gone (by script); plug it in");
    if (replay->failed)
        return rf_capture_fail(reason, REFOCUS_ERR_IO, "the stream failed (by script)");
    if (is_over(replay, replay->next))
        return rf_capture_fail(reason, REFOCUS_ERR_END, "the script is at its end");
    return REFOCUS_OK;
}

static int wait_frame(struct refocus_source *source, int64_t deadline_ns,
                      struct refocus_frame **result, struct refocus_reason *reason)
{
    struct replay *replay = source->state;
    struct refocus_frame *frame;
    struct fate fate;
    int buffer, status = check_stream(replay, reason);
    int64_t due;

    if (status == REFOCUS_OK)
        status = sleep_until(source, replay->stalled_until_ns, deadline_ns);
    if (status == REFOCUS_OK && !replay->pace.fast)
        status = sleep_until(source, due_at(replay, replay->next), deadline_ns);
    if (status != REFOCUS_OK)
        return status;
    buffer = rf_ring_take(&replay->ring);
    if (buffer < 0)
        return rf_capture_fail(reason, REFOCUS_ERR_STATE,
                               "every buffer is out; "
                               "release one");
    frame = &replay->ring.frame[buffer];
    *frame = refocus_frame_default();
    status = pass_over(replay, &fate, reason);
    due = due_at(replay, replay->next);
    if (status == REFOCUS_OK && (replay->gone || replay->failed)) {
        replay->next++;
        status = check_stream(replay, reason);
    } else if (status == REFOCUS_OK && fate.memory) {
        replay->next++;
        status = rf_capture_fail_memory(reason);
    } else if (status == REFOCUS_OK) {
        status = check_stream(replay, reason); /* the last ones may not come */
    }
    if (status == REFOCUS_OK && fate.late_ms > 0)
        status = rf_source_poll(source, -1, 0, rf_now_ns() + fate.late_ms * 1000000, NULL) ==
                         REFOCUS_ERR_CANCELLED
                     ? REFOCUS_ERR_CANCELLED
                     : REFOCUS_OK;
    if (status == REFOCUS_OK) {
        rf_lens_move(&replay->lens, &replay->script, frame);
        status = fill(replay, buffer, frame, reason);
    }
    if (status != REFOCUS_OK) {
        rf_ring_give(&replay->ring, (uint32_t)buffer);
        return status;
    }
    source->counters.dequeued++;
    if (fate.queue_error)
        replay->cursed |= (uint32_t)1 << buffer;
    frame->buffer = (uint32_t)buffer;
    frame->sequence = (uint32_t)(replay->script.sequence + (uint64_t)replay->next);
    frame->timestamp_ns = due + fate.shift_ms * 1000000;
    frame->flags |= (fate.corrupt ? REFOCUS_FRAME_CORRUPT : 0) |
                    (replay->changed ? REFOCUS_FRAME_CHANGED : 0) |
                    (replay->pace.fast ? 0 : REFOCUS_FRAME_MONOTONIC);
    replay->changed = false;
    replay->next++;
    *result = frame;
    return REFOCUS_OK;
}

static void release(struct refocus_source *source, struct refocus_frame *frame)
{
    struct replay *replay = source->state;

    if (replay->cursed >> frame->buffer & 1) {
        /* The driver refuses it. With less than two left the stream has failed. */
        source->counters.lost++;
        replay->failed |= ++replay->stuck >= replay->ring.count - 1;
        return;
    }
    source->counters.queued++;
    rf_ring_give(&replay->ring, frame->buffer);
}

static void stop(struct refocus_source *source)
{
    struct replay *replay = source->state;

    source->counters.lost = source->counters.dequeued - source->counters.queued;
    replay->ring.taken = 0;
    if (replay->inner)
        refocus_source_stop(replay->inner);
}

static int reopen(struct refocus_source *source, struct refocus_reason *reason)
{
    struct replay *replay = source->state;

    if (replay->gone && rf_now_ns() < replay->gone_until_ns)
        return rf_capture_fail(reason, REFOCUS_ERR_GONE,
                               "the device is gone (by "
                               "script)");
    replay->gone = false;
    return REFOCUS_OK;
}

static int get_lens(struct refocus_source *source, struct refocus_source_lens *lens,
                    struct refocus_reason *reason)
{
    const struct replay *replay = source->state;

    (void)reason;
    rf_lens_describe(&replay->lens, &replay->script, lens);
    return REFOCUS_OK;
}

static int set_focus(struct refocus_source *source, uint32_t mode, double position,
                     struct refocus_reason *reason)
{
    struct replay *replay = source->state;

    (void)reason;
    rf_lens_focus(&replay->lens, &replay->script, mode, position);
    return REFOCUS_OK;
}

/* Pictures of a script have one exposure anyway. */
static int lock_exposure(struct refocus_source *source, bool lock, struct refocus_reason *reason)
{
    (void)source, (void)lock, (void)reason;
    return REFOCUS_OK;
}

const struct rf_source_ops rf_source_replay = {
    .scheme = "replay",
    .kind = REFOCUS_SOURCE_KIND_SCRIPT,
    .open = open_replay,
    .get_mode = get_mode,
    .start = start,
    .wait = wait_frame,
    .release = release,
    .stop = stop,
    .reopen = reopen,
    .close = close_replay,
    .get_lens = get_lens,
    .set_focus = set_focus,
    .lock_exposure = lock_exposure,
};
