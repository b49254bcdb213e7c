/* replay_faults.c: which frame of a scripted camera comes next, and the faults that it meets. */
#include <string.h>
#include "replay.h"

/* Draws at random whether a frame has a fault, and which: one of those that leave the rest of the
 * script as it is. */
static struct rf_event random_event(const struct rf_replay *replay, int64_t frame)
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

static int apply_to_stream(struct rf_replay *replay, const struct rf_event *event,
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
        return replay->inner || replay->script.jpeg ? REFOCUS_OK : rf_replay_draw(replay, reason);
    case RF_FAULT_FORMAT:
        if (replay->inner || replay->script.jpeg)
            break;
        replay->format = event->format;
        replay->width = event->width;
        replay->height = event->height;
        replay->stride = rf_plane_row(event->format, 0, event->width);
        replay->changed = true;
        return rf_replay_draw(replay, reason);
    default:
        break;
    }
    return REFOCUS_OK;
}

static void apply_to_frame(struct rf_frame_faults *faults, const struct rf_event *event)
{
    faults->dropped += event->fault == RF_FAULT_DROP ? event->value : 0;
    faults->late_ms += event->fault == RF_FAULT_LATE ? event->value : 0;
    faults->shift_ms += event->fault == RF_FAULT_TIMESTAMP ? event->value : 0;
    faults->corrupt |= event->fault == RF_FAULT_CORRUPT;
    faults->queue_error |= event->fault == RF_FAULT_QUEUE_ERROR;
    faults->memory |= event->fault == RF_FAULT_MEMORY;
}

/* Collects the faults of the frame to come. Faults of the stream take effect at once, also where
 * the frame is passed over. */
static int collect_faults(struct rf_replay *replay, struct rf_frame_faults *faults,
                          struct refocus_reason *reason)
{
    const struct rf_event chance = random_event(replay, replay->next);
    int status = apply_to_stream(replay, &chance, reason);

    memset(faults, 0, sizeof *faults);
    apply_to_frame(faults, &chance);
    for (int i = 0; i < replay->script.events && status == REFOCUS_OK; i++)
        if (replay->script.event[i].frame == replay->next) {
            apply_to_frame(faults, &replay->script.event[i]);
            status = apply_to_stream(replay, &replay->script.event[i], reason);
        }
    return status;
}

static bool is_over(const struct rf_replay *replay, int64_t frame)
{
    return replay->script.frames > 0 && frame >= replay->script.frames;
}

int64_t rf_replay_due(const struct rf_replay *replay, int64_t frame)
{
    return rf_pace_due(&replay->pace, frame - replay->first);
}

/* A camera fills the buffers that it has and drops frames that come then, but for the last one of
 * the script. */
int rf_replay_next(struct rf_replay *replay, struct rf_frame_faults *faults,
                   struct refocus_reason *reason)
{
    int status = collect_faults(replay, faults, reason);

    while (status == REFOCUS_OK && !replay->pace.fast && !replay->failed && !replay->gone &&
           !is_over(replay, replay->next + 1) &&
           rf_replay_due(replay, replay->next + replay->ring.count) < rf_now_ns()) {
        replay->next++;
        status = collect_faults(replay, faults, reason);
    }
    while (status == REFOCUS_OK && faults->dropped > 0) {
        const int64_t left = faults->dropped - 1;

        replay->next++;
        status = collect_faults(replay, faults, reason);
        if (left > faults->dropped)
            faults->dropped = left;
    }
    return status;
}

int rf_replay_check(const struct rf_replay *replay, struct refocus_reason *reason)
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
