/* replay.c: a camera by script, with buffers of its own, a clock, and every fault that cameras
 * have. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "replay.h"

enum { LONGEST_SCRIPT = 1 << 16 };

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

int rf_replay_read_script(struct rf_script *script, const char *rest, struct refocus_reason *reason)
{
    char *text = NULL;
    int status;

    if (*rest == ':') {
        text = strdup(rest + 1);
        status = text ? REFOCUS_OK : rf_capture_fail_memory(reason);
    } else {
        status = read_text(&text, rest, reason);
    }
    if (status == REFOCUS_OK)
        status = rf_script_parse(script, text, reason);
    free(text);
    return status;
}

static void close_replay(struct refocus_source *source)
{
    struct rf_replay *replay = source->state;

    refocus_source_close(&replay->inner);
    rf_ring_free(&replay->ring);
    rf_script_free(&replay->script);
    free(replay->scene);
    free(replay);
}

static int open_replay(struct refocus_source *source, const char *rest,
                       struct refocus_reason *reason)
{
    struct rf_replay *replay = calloc(1, sizeof *replay);
    int status;

    if (!replay)
        return rf_capture_fail_memory(reason);
    source->state = replay;
    status = rf_replay_read_script(&replay->script, rest, reason);
    replay->format = replay->script.format;
    replay->width = replay->script.width;
    replay->height = replay->script.height;
    replay->stride = replay->script.stride;
    rf_lens_start(&replay->lens, &replay->script);
    if (status == REFOCUS_OK && replay->script.stack)
        status = rf_lens_look(&replay->lens, &replay->script, &replay->inner, reason);
    else if (status == REFOCUS_OK && replay->script.jpeg)
        status = rf_replay_read_jpeg(replay, reason);
    else if (status == REFOCUS_OK && replay->script.from)
        status = refocus_source_open(&replay->inner, replay->script.from, reason);
    else if (status == REFOCUS_OK)
        status = rf_replay_draw(replay, reason);
    if (status != REFOCUS_OK)
        close_replay(source);
    return status;
}

static int get_mode(struct refocus_source *source, int index, struct refocus_source_mode *mode)
{
    const struct rf_replay *replay = source->state;

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
    struct rf_replay *replay = source->state;
    const double fps = rf_source_fps(source, replay->script.fps);

    if (replay->gone)
        return rf_capture_fail(reason, REFOCUS_ERR_GONE, "the device is gone (by script)");
    if (replay->script.start_errors > 0) {
        replay->script.start_errors--;
        return rf_capture_fail(reason, REFOCUS_ERR_IO, "the stream cannot start (by script)");
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
    replay->refused = 0;
    replay->stuck = 0;
    replay->ring.count = source->config.buffers;
    replay->ring.taken = 0;
    rf_pace_start(&replay->pace, fps, source->config.flags & REFOCUS_SOURCE_FAST);
    replay->first = replay->pace.fast ? 0 : replay->next;
    return REFOCUS_OK;
}

static int wait_frame(struct refocus_source *source, int64_t deadline_ns,
                      struct refocus_frame **result, struct refocus_reason *reason)
{
    struct rf_replay *replay = source->state;
    struct refocus_frame *frame;
    struct rf_frame_faults faults;
    int buffer, status = rf_replay_check(replay, reason);
    int64_t due;

    if (status == REFOCUS_OK)
        status = rf_source_sleep(source, replay->stalled_until_ns, deadline_ns);
    if (status == REFOCUS_OK && !replay->pace.fast)
        status = rf_source_sleep(source, rf_replay_due(replay, replay->next), deadline_ns);
    if (status != REFOCUS_OK)
        return status;
    buffer = rf_ring_take(&replay->ring, reason);
    if (buffer < 0)
        return REFOCUS_ERR_STATE;
    frame = &replay->ring.frame[buffer];
    *frame = refocus_frame_default();
    status = rf_replay_next(replay, &faults, reason);
    due = rf_replay_due(replay, replay->next);
    if (status == REFOCUS_OK && (replay->gone || replay->failed)) {
        replay->next++;
        status = rf_replay_check(replay, reason);
    } else if (status == REFOCUS_OK && faults.memory) {
        replay->next++;
        status = rf_capture_fail_memory(reason);
    } else if (status == REFOCUS_OK) {
        status = rf_replay_check(replay, reason); /* the last ones may not come */
    }
    if (status == REFOCUS_OK && faults.late_ms > 0)
        status = rf_source_poll(source, -1, 0, rf_now_ns() + faults.late_ms * 1000000, NULL) ==
                         REFOCUS_ERR_CANCELLED
                     ? REFOCUS_ERR_CANCELLED
                     : REFOCUS_OK;
    if (status == REFOCUS_OK) {
        rf_lens_move(&replay->lens, &replay->script, frame);
        status = rf_replay_fill(replay, buffer, frame, reason);
    }
    if (status != REFOCUS_OK) {
        rf_ring_give(&replay->ring, (uint32_t)buffer);
        return status;
    }
    source->counters.dequeued++;
    if (faults.queue_error)
        replay->refused |= (uint32_t)1 << buffer;
    frame->buffer = (uint32_t)buffer;
    frame->sequence = (uint32_t)(replay->script.sequence + (uint64_t)replay->next);
    frame->timestamp_ns = due + faults.shift_ms * 1000000;
    frame->flags |= (faults.corrupt ? REFOCUS_FRAME_CORRUPT : 0) |
                    (replay->changed ? REFOCUS_FRAME_CHANGED : 0) |
                    (replay->pace.fast ? 0 : REFOCUS_FRAME_MONOTONIC);
    replay->changed = false;
    replay->next++;
    *result = frame;
    return REFOCUS_OK;
}

static void release(struct refocus_source *source, struct refocus_frame *frame)
{
    struct rf_replay *replay = source->state;

    if (replay->refused >> frame->buffer & 1) {
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
    struct rf_replay *replay = source->state;

    source->counters.lost = source->counters.dequeued - source->counters.queued;
    replay->ring.taken = 0;
    if (replay->inner)
        refocus_source_stop(replay->inner);
}

static int reopen(struct refocus_source *source, struct refocus_reason *reason)
{
    struct rf_replay *replay = source->state;

    if (replay->gone && rf_now_ns() < replay->gone_until_ns)
        return rf_capture_fail(reason, REFOCUS_ERR_GONE, "the device is gone (by script)");
    replay->gone = false;
    return REFOCUS_OK;
}

static int get_lens(struct refocus_source *source, struct refocus_source_lens *lens,
                    struct refocus_reason *reason)
{
    const struct rf_replay *replay = source->state;

    (void)reason;
    rf_lens_describe(&replay->lens, &replay->script, lens);
    return REFOCUS_OK;
}

static int set_focus(struct refocus_source *source, uint32_t mode, double position,
                     struct refocus_reason *reason)
{
    struct rf_replay *replay = source->state;

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
