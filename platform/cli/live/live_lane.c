/* live_lane.c: frames are taken from a camera, which is taken up again after a fault. */
#include <math.h>
#include <time.h>
#include "line/report.h"
#include "live/live_lane.h"

enum { WAIT_MS = 200, RETRY_MS = 50 };

static int64_t ms_since(int64_t then_ns)
{
    return (live_now_ns() - then_ns) / 1000000;
}

static bool can_restart(int status)
{
    return status == REFOCUS_ERR_GONE || status == REFOCUS_ERR_IO || status == REFOCUS_ERR_BUSY ||
           status == REFOCUS_ERR_STATE || status == REFOCUS_ERR_MEMORY ||
           status == REFOCUS_ERR_PERMISSION;
}

static void fail(struct live_lane *lane, const char *why)
{
    lane->failed = true;
    live_note_failure(lane->live, EXIT_FAILED, lane->name, why);
}

/* Restart until frames can come again; false when it is over or patience ends. */
static bool recover(struct live_lane *lane, struct refocus_reason *reason)
{
    const struct timespec pause = {0, RETRY_MS * 1000000};
    const int64_t since = live_now_ns();

    while (!live_is_over(lane->live)) {
        struct refocus_reason why = {""};

        if (refocus_source_restart(lane->source, NULL, &why) == REFOCUS_OK) {
            lane->sure.known = lane->seen.known = false; /* a clock may begin anew */
            lane->last_ns = INT64_MIN;
            return true;
        }
        if ((double)ms_since(since) > lane->live->settings->patience * 1e3) {
            if (why.text[0])
                *reason = why;
            return false;
        }
        nanosleep(&pause, NULL);
    }
    return false;
}

static void note_recovery(struct live_lane *lane, int64_t fault_ns)
{
    const double ms = (double)(live_now_ns() - fault_ns) / 1e6;

    lane->stage->recoveries++;
    if (ms > lane->stage->worst_recovery_ms)
        lane->stage->worst_recovery_ms = ms;
}

static const double doubt_ns = 1e9;

/* Whether a frame's time is what its number lets expect after a frame before it. */
static bool continues(const struct live_lane *lane, const struct live_moment *before,
                      const struct refocus_frame *frame)
{
    const int32_t steps = (int32_t)(frame->sequence - before->sequence);
    const double expected = (double)before->ns + steps * (double)lane->period_ns;

    return before->known && fabs((double)frame->timestamp_ns - expected) <= doubt_ns;
}

/*
 * Drivers do give single frames a time that is minutes off. Such a frame would go with the wrong
 * depth, and one that lies ahead would be waited for. A time is sound when it is about now, where
 * it is of our clock, or goes with the last sound one, or with the frame just before, sound or
 * not: then the camera's clock was set. Two in a row are not doubted, unless they lie ahead.
 */
static bool has_sound_time(struct live_lane *lane, const struct refocus_frame *frame,
                           int64_t now_ns)
{
    const bool ours = frame->flags & REFOCUS_FRAME_MONOTONIC;
    const double age = (double)now_ns - (double)frame->timestamp_ns;
    const bool sound = (ours && fabs(age) <= doubt_ns) || continues(lane, &lane->sure, frame) ||
                       continues(lane, &lane->seen, frame) ||
                       (!(ours && age < -doubt_ns) && (!lane->seen.known || lane->doubted));

    lane->doubted = !sound;
    lane->seen = (struct live_moment){true, frame->timestamp_ns, frame->sequence};
    if (sound)
        lane->sure = lane->seen;
    return sound;
}

/* The time of a frame whose own is not sound: as many frames after the last sound one as their
 * numbers say, if that is not long ago. */
static int64_t expected_time(const struct live_lane *lane, const struct refocus_frame *frame,
                             int64_t now_ns)
{
    const int32_t steps = (int32_t)(frame->sequence - lane->sure.sequence);
    const bool near = steps > 0 && steps * (double)lane->period_ns <= doubt_ns;

    return lane->sure.known ? lane->sure.ns + (near ? steps : 1) * lane->period_ns : now_ns;
}

/* Say once why pictures of a sequence are left out. */
static void warn(struct live_lane *lane, const char *why)
{
    if (why[0] && !lane->warned)
        report_warning(lane->name, "%s; the depth before it holds", why);
    lane->warned |= why[0] != '\0';
}

/* Handle one frame that came, and why it is corrupt; an exit code. */
static int handle(struct live_lane *lane, const struct refocus_frame *given, const char *why)
{
    struct live_stage *stage = lane->stage;
    struct refocus_reason reason = {""};
    struct refocus_frame frame = refocus_frame_copy(given);
    const int64_t begin = live_now_ns();
    int status = EXIT_DONE;

    stage->frames++;
    if (lane->live->settings->matrix >= 0)
        frame.matrix = (uint32_t)lane->live->settings->matrix;
    if (frame.flags & REFOCUS_FRAME_CORRUPT) {
        stage->corrupt++;
        warn(lane, why);
    } else {
        if (!has_sound_time(lane, given, begin)) {
            frame.timestamp_ns = expected_time(lane, given, begin);
            stage->retimed++;
        }
        stage->reordered += lane->last_ns > frame.timestamp_ns;
        lane->last_ns = frame.timestamp_ns;
        status = lane->deliver(lane, &frame, begin, &reason);
    }
    if (status == REFOCUS_ERR_FORMAT || status == REFOCUS_ERR_NO_DEPTH) {
        stage->damaged++; /* a picture cut short: the next one may be whole */
        return EXIT_DONE;
    }
    if (status == REFOCUS_OK)
        return EXIT_DONE;
    fail(lane, reason.text[0] ? reason.text : refocus_strerror(status));
    return EXIT_FAILED;
}

static bool is_late(const struct live_lane *lane, const struct refocus_frame *frame)
{
    return lane->late_ns == 0 || (frame->flags & REFOCUS_FRAME_MONOTONIC &&
                                  live_now_ns() - frame->timestamp_ns > lane->late_ns);
}

/* When the newest frame wins: leave out those that a newer one waits behind already. */
static const struct refocus_frame *skip_to_newest(struct live_lane *lane,
                                                  const struct refocus_frame *frame)
{
    const struct refocus_frame *newer;

    for (int i = 0; i < LIVE_SLOTS && lane->newest_wins && is_late(lane, frame); i++) {
        if (refocus_source_wait(lane->source, 0, &newer, NULL) != REFOCUS_OK)
            break; /* a fault will be there at the next wait, too */
        refocus_source_release(lane->source, frame);
        frame = newer;
        lane->stage->frames++;
        lane->stage->skipped++;
    }
    return frame;
}

void live_lane_run(struct live_lane *lane)
{
    struct live *live = lane->live;
    int64_t fault_ns = 0;

    lane->quiet_since_ns = live_now_ns();
    while (!live_is_over(live)) {
        struct refocus_reason reason = {""};
        const struct refocus_frame *frame = NULL;

        if (lane->between && lane->between(lane) != EXIT_DONE)
            return;
        int status = refocus_source_wait(lane->source, WAIT_MS, &frame, &reason);

        if (status == REFOCUS_OK) {
            frame = skip_to_newest(lane, frame);
            const int result = handle(lane, frame, reason.text);
            refocus_source_release(lane->source, frame);
            if (fault_ns)
                note_recovery(lane, fault_ns);
            fault_ns = 0;
            lane->quiet_since_ns = live_now_ns();
            if (result != EXIT_DONE || lane->done)
                return;
            continue;
        }
        if (status == REFOCUS_ERR_CANCELLED || status == REFOCUS_ERR_END)
            return;
        if (status == REFOCUS_ERR_TIMEOUT) {
            lane->stage->timeouts++;
            /* A device that says nothing for long may have to be opened again. */
            if (ms_since(lane->quiet_since_ns) < 2000)
                continue;
        } else if (!can_restart(status)) {
            fail(lane, reason.text);
            return;
        }
        fault_ns = fault_ns ? fault_ns : live_now_ns();
        if (!recover(lane, &reason)) {
            if (!live_is_over(live))
                fail(lane, reason.text);
            return;
        }
        if (status == REFOCUS_ERR_TIMEOUT &&
            (double)ms_since(fault_ns) > live->settings->patience * 1e3) {
            fail(lane, "no frame comes; check the camera");
            return;
        }
        lane->quiet_since_ns = live_now_ns();
    }
}

struct live_lane live_lane_of(struct live *live, struct refocus_source *source, const char *name,
                              const struct refocus_source_mode *mode, struct live_stage *stage)
{
    return (struct live_lane){
        .live = live,
        .source = source,
        .name = name,
        .stage = stage,
        .last_ns = INT64_MIN,
        .period_ns = (int64_t)(1e9 / (mode->fps > 0 ? mode->fps : 30)),
        .newest_wins = live->settings->policy == POLICY_NEWEST && !live->settings->fast,
    };
}
