/* The threads that take frames from the cameras, and take them up again after a fault. */
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>
#include "live/live.h"

enum { WAIT_MS = 200, RETRY_MS = 50 };

/* When a frame was taken, by its camera. */
struct moment {
    bool known;
    int64_t ns;
    uint32_t sequence;
};

/* A camera and what happens to its frames. */
struct lane {
    struct live *live;
    struct refocus_source *source;
    const char *name;
    struct live_stage *stage;
    struct refocus_converter *converter;
    /* An exit code; the frame is released by the caller. */
    int (*deliver)(struct lane *lane, const struct refocus_frame *frame, int64_t now_ns,
                   struct refocus_reason *reason);
    uint16_t *samples, *registered; /* of depth */
    size_t capacity;
    int64_t last_ns;
    int64_t period_ns;        /* between two frames */
    struct moment sure, seen; /* the last frame of a sound time, and the last of all */
    bool doubted;             /* the last frame's time was not believed */
    bool newest_wins;
    int64_t late_ns; /* only over frames that are older than this */
    bool done;       /* nothing else will come */
};

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

/* Restart until frames can come again; false when it is over or patience ends. */
static bool recover(struct lane *lane, struct refocus_reason *reason)
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

static void note_recovery(struct lane *lane, int64_t fault_ns)
{
    const double ms = (double)(live_now_ns() - fault_ns) / 1e6;

    lane->stage->recoveries++;
    if (ms > lane->stage->worst_recovery_ms)
        lane->stage->worst_recovery_ms = ms;
}

static const double doubt_ns = 1e9;

/* Whether a frame's time is what its number lets expect after a frame before it. */
static bool continues(const struct lane *lane, const struct moment *before,
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
static bool has_sound_time(struct lane *lane, const struct refocus_frame *frame, int64_t now_ns)
{
    const bool ours = frame->flags & REFOCUS_FRAME_MONOTONIC;
    const double age = (double)now_ns - (double)frame->timestamp_ns;
    const bool sound = (ours && fabs(age) <= doubt_ns) || continues(lane, &lane->sure, frame) ||
                       continues(lane, &lane->seen, frame) ||
                       (!(ours && age < -doubt_ns) && (!lane->seen.known || lane->doubted));

    lane->doubted = !sound;
    lane->seen = (struct moment){true, frame->timestamp_ns, frame->sequence};
    if (sound)
        lane->sure = lane->seen;
    return sound;
}

/* One frame that came; an exit code. */
static int handle(struct lane *lane, const struct refocus_frame *frame)
{
    struct live_stage *stage = lane->stage;
    struct refocus_reason reason = {""};
    const int64_t begin = live_now_ns();
    int status = EXIT_DONE;

    stage->frames++;
    if (frame->flags & REFOCUS_FRAME_CORRUPT) {
        stage->corrupt++;
    } else if (!has_sound_time(lane, frame, begin)) {
        stage->damaged++;
    } else {
        stage->reordered += lane->last_ns > frame->timestamp_ns;
        lane->last_ns = frame->timestamp_ns;
        status = lane->deliver(lane, frame, begin, &reason);
    }
    if (status == REFOCUS_ERR_FORMAT || status == REFOCUS_ERR_NO_DEPTH) {
        stage->damaged++; /* a picture cut short: the next one may be whole */
        return EXIT_DONE;
    }
    if (status == REFOCUS_OK)
        return EXIT_DONE;
    live_fail(lane->live, EXIT_FAILED, lane->name,
              reason.text[0] ? reason.text : refocus_strerror(status));
    return EXIT_FAILED;
}

static bool is_late(const struct lane *lane, const struct refocus_frame *frame)
{
    return lane->late_ns == 0 || (frame->flags & REFOCUS_FRAME_MONOTONIC &&
                                  live_now_ns() - frame->timestamp_ns > lane->late_ns);
}

/* When the newest frame wins: leave out those that a newer one waits behind already. */
static const struct refocus_frame *skip_to_newest(struct lane *lane,
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

static void run_lane(struct lane *lane)
{
    struct live *live = lane->live;
    int64_t quiet_since = live_now_ns(), fault_ns = 0;

    while (!live_is_over(live)) {
        struct refocus_reason reason = {""};
        const struct refocus_frame *frame = NULL;
        int status = refocus_source_wait(lane->source, WAIT_MS, &frame, &reason);

        if (status == REFOCUS_OK) {
            frame = skip_to_newest(lane, frame);
            const int result = handle(lane, frame);
            refocus_source_release(lane->source, frame);
            if (fault_ns)
                note_recovery(lane, fault_ns);
            fault_ns = 0;
            quiet_since = live_now_ns();
            if (result != EXIT_DONE || lane->done)
                return;
            continue;
        }
        if (status == REFOCUS_ERR_CANCELLED || status == REFOCUS_ERR_END)
            return;
        if (status == REFOCUS_ERR_TIMEOUT) {
            lane->stage->timeouts++;
            /* A device that says nothing for long may have to be opened again. */
            if (ms_since(quiet_since) < 2000)
                continue;
        } else if (!can_restart(status)) {
            live_fail(live, EXIT_FAILED, lane->name, reason.text);
            return;
        }
        fault_ns = fault_ns ? fault_ns : live_now_ns();
        if (!recover(lane, &reason)) {
            if (!live_is_over(live))
                live_fail(live, EXIT_FAILED, lane->name, reason.text);
            return;
        }
        if (status == REFOCUS_ERR_TIMEOUT && ms_since(fault_ns) > live->settings->patience * 1e3) {
            live_fail(live, EXIT_FAILED, lane->name, "no frame comes; check the camera");
            return;
        }
        quiet_since = live_now_ns();
    }
}

/* When it was taken: by the camera's clock where that is ours and plausible. */
static int64_t taken_at(const struct refocus_frame *frame, int64_t now_ns)
{
    const int64_t age = now_ns - frame->timestamp_ns;

    return frame->flags & REFOCUS_FRAME_MONOTONIC && age >= 0 && age < 1000000000
               ? frame->timestamp_ns
               : now_ns;
}

/* What a frame is rendered in: its own Y, U and V if nobody needs anything else. */
static uint32_t format_for(const struct live *live, const struct refocus_frame *frame)
{
    const uint32_t own = refocus_frame_image_format(frame->format);

    return own && live->yuv_formats >> own & 1 ? own : (uint32_t)REFOCUS_FORMAT_RGB8;
}

static int deliver_colour(struct lane *lane, const struct refocus_frame *frame, int64_t now_ns,
                          struct refocus_reason *reason)
{
    struct live *live = lane->live;
    struct live_picture *picture;
    bool memory;
    int status;

    const uint32_t format = format_for(live, frame);
    picture = live_queue_fill(&live->captured, format, frame->width, frame->height, &memory);
    if (!picture)
        return REFOCUS_OK;
    /* The time of waiting for a free slot is not that of converting. */
    const int64_t begin = live_now_ns();
    if (!memory)
        status = REFOCUS_ERR_MEMORY;
    else if (format == REFOCUS_FORMAT_RGB8)
        status = refocus_convert_rgb8(lane->converter, frame, &picture->image, reason);
    else
        status = refocus_convert_copy(lane->converter, frame, &picture->image, reason);
    live->rendered_format = format;
    if (status == REFOCUS_OK && live->estimator)
        status = live_estimate_offer(live, picture, frame, lane->converter, reason);
    if (status != REFOCUS_OK) {
        live_queue_return(&live->captured, picture);
        return status;
    }
    picture->timestamp_ns = frame->timestamp_ns;
    picture->taken_ns = taken_at(frame, now_ns);
    picture->lens_dioptres = frame->lens_dioptres;
    picture->still = frame->flags & REFOCUS_FRAME_STILL;
    live_times_add(&lane->stage->times, (double)(live_now_ns() - begin) / 1e6);
    live_queue_put(&live->captured, picture);
    return REFOCUS_OK;
}

static int64_t period_of(const struct refocus_source_mode *mode)
{
    return (int64_t)(1e9 / (mode->fps > 0 ? mode->fps : 30));
}

void *live_capture_thread(void *argument)
{
    struct live *live = argument;
    struct lane lane = {.live = live,
                        .source = live->camera,
                        .name = live->settings->camera,
                        .stage = &live->capture,
                        .last_ns = INT64_MIN,
                        .period_ns = period_of(&live->mode),
                        .newest_wins =
                            live->settings->policy == POLICY_NEWEST && !live->settings->fast,
                        .deliver = deliver_colour};

    if (refocus_converter_create(&lane.converter) == REFOCUS_OK)
        run_lane(&lane);
    else
        live_fail(live, EXIT_FAILED, lane.name, "not enough memory");
    refocus_converter_destroy(&lane.converter);
    live_queue_close(&live->captured);
    live_queue_close(&live->to_estimate);
    return NULL;
}

/* Depth ---------------------------------------------------------------------------------- */

static bool reserve(struct lane *lane, const struct refocus_frame *frame)
{
    const struct refocus_calibration *c = lane->live->calibration;
    size_t samples = (size_t)frame->width * (size_t)frame->height;

    if (c && (size_t)c->colour.width * (size_t)c->colour.height > samples)
        samples = (size_t)c->colour.width * (size_t)c->colour.height;
    if (samples <= lane->capacity)
        return true;
    free(lane->samples);
    free(lane->registered);
    lane->samples = malloc(samples * 2);
    lane->registered = malloc(samples * 2);
    lane->capacity = lane->samples && lane->registered ? samples : 0;
    return lane->capacity > 0;
}

/* What the samples mean: the option, else millimetres for depth cameras and disparities for
 * pictures. */
static int describe(struct lane *lane, const struct refocus_frame *frame,
                    struct refocus_depth_map *map, struct refocus_reason *reason)
{
    const struct depth_settings *settings = &lane->live->settings->depth;
    const bool picture =
        frame->format == REFOCUS_FRAME_GREY || strncmp(lane->name, "file:", 5) == 0;
    const char *unit = settings->unit ? settings->unit : picture ? "disparity" : "mm";

    memset(map, 0, sizeof *map);
    map->samples = lane->samples;
    map->width = frame->width;
    map->height = frame->height;
    map->stride = (ptrdiff_t)frame->width * 2;
    map->sample = REFOCUS_SAMPLE_U16;
    if (refocus_depth_set_unit(map, unit) != REFOCUS_OK) {
        snprintf(reason->text, sizeof reason->text, "--depth-unit %.60s does not suit it", unit);
        return REFOCUS_ERR_ARGUMENT;
    }
    map->near_m = isnan(settings->near_m) ? 0 : settings->near_m;
    map->far_m = isnan(settings->far_m) ? 0 : settings->far_m;
    return REFOCUS_OK;
}

static int register_map(struct lane *lane, struct refocus_depth_map *map,
                        struct refocus_reason *reason)
{
    const struct refocus_calibration *c = lane->live->calibration;

    if (map->meaning != REFOCUS_DEPTH_DISTANCE || map->metres_at_zero != 0 ||
        map->width != c->depth.width || map->height != c->depth.height) {
        snprintf(reason->text, sizeof reason->text,
                 "--calibration is for distances of %dx%d samples, these are %s of %dx%d",
                 c->depth.width, c->depth.height,
                 map->meaning == REFOCUS_DEPTH_DISTANCE ? "distances" : "disparities", map->width,
                 map->height);
        return REFOCUS_ERR_ARGUMENT;
    }
    refocus_register_depth(c, lane->samples, map->metres_per_unit, lane->registered);
    map->samples = lane->registered;
    map->width = c->colour.width;
    map->height = c->colour.height;
    map->stride = (ptrdiff_t)map->width * 2;
    return REFOCUS_OK;
}

static struct live_range range_of(double near_m, double far_m)
{
    return near_m > 0 && far_m > near_m ? (struct live_range){1 / near_m, 1 / far_m}
                                        : (struct live_range){0, 0};
}

/* What disparity 1 and 0 stand for in this map: distances follow the scene, but for what is
 * given. */
static struct live_range follow_range(struct live *live, struct refocus_depth_map *map,
                                      int64_t timestamp_ns)
{
    struct live_ranger *ranger = &live->ranger;
    struct live_range seen;

    if (map->meaning != REFOCUS_DEPTH_DISTANCE || (ranger->near_given && ranger->far_given))
        return range_of(map->near_m, map->far_m);
    if (live_range_measure(ranger, map, &seen))
        live_range_follow(ranger, &seen, timestamp_ns);
    if (ranger->maps > 0) {
        map->near_m = 1 / ranger->range.near;
        map->far_m = 1 / ranger->range.far; /* INFINITY of 0 */
    }
    return ranger->maps > 0 ? ranger->range : (struct live_range){0, 0};
}

static int deliver_depth(struct lane *lane, const struct refocus_frame *frame, int64_t now_ns,
                         struct refocus_reason *reason)
{
    struct live *live = lane->live;
    struct refocus_depth_map map;
    struct live_range range;
    struct live_depth_map *to;
    int status = reserve(lane, frame) ? REFOCUS_OK : REFOCUS_ERR_MEMORY;
    double ms;

    if (status == REFOCUS_OK)
        status = refocus_convert_samples(lane->converter, frame, lane->samples, reason);
    if (status == REFOCUS_OK)
        status = describe(lane, frame, &map, reason);
    if (status == REFOCUS_OK && live->calibration)
        status = register_map(lane, &map, reason);
    if (status != REFOCUS_OK)
        return status;
    range = follow_range(live, &map, frame->timestamp_ns);
    ms = (double)(live_now_ns() - now_ns) / 1e6;
    to = live_depths_fill(&live->depths, map.width, map.height);
    if (!to)
        return live_is_over(live) ? REFOCUS_OK : REFOCUS_ERR_MEMORY;
    now_ns = live_now_ns();
    status = refocus_depth_to_disparity(&map, to->disparity, (ptrdiff_t)map.width * 2, NULL);
    if (status != REFOCUS_OK)
        return status;
    to->range = range;
    live_times_add(&lane->stage->times, ms + (double)(live_now_ns() - now_ns) / 1e6);
    lane->done = frame->flags & REFOCUS_FRAME_STILL;
    live_depths_put(&live->depths, to, frame->timestamp_ns, lane->done);
    return REFOCUS_OK;
}

void *live_depth_thread(void *argument)
{
    struct live *live = argument;
    struct lane lane = {.live = live,
                        .source = live->depth_camera,
                        .name = live->settings->depth.file,
                        .stage = &live->depth,
                        .last_ns = INT64_MIN,
                        .period_ns = period_of(&live->depth_mode),
                        .newest_wins =
                            live->settings->policy == POLICY_NEWEST && !live->settings->fast,
                        .deliver = deliver_depth};
    const struct depth_settings *depth = &live->settings->depth;
    const double fps = live->mode.fps > 0 ? live->mode.fps : 30;

    live_range_begin(&live->ranger, isnan(depth->near_m) ? 0 : depth->near_m,
                     isnan(depth->far_m) ? 0 : depth->far_m);
    /* As long as a picture waits for its depth: else a slow machine would be behind for ever. */
    lane.late_ns = (int64_t)(1.5e9 / fps);

    if (refocus_converter_create(&lane.converter) == REFOCUS_OK)
        run_lane(&lane);
    else
        live_fail(live, EXIT_FAILED, lane.name, "not enough memory");
    refocus_converter_destroy(&lane.converter);
    free(lane.samples);
    free(lane.registered);
    live_range_end(&live->ranger);
    live_depths_end(&live->depths);
    return NULL;
}

int live_read_fixed_depth(struct live *live)
{
    struct input input;
    struct live_depth_map *to;
    int status = input_read_depth(&input, live->settings->depth.file, &live->settings->depth);

    if (status == EXIT_DONE) {
        const int width = input.depth_from->depth.width;
        const int height = input.depth_from->depth.height;

        to = live_depths_fill(&live->depths, width, height);
        if (to) {
            memcpy(to->disparity, input.disparity, (size_t)width * (size_t)height * 2);
            to->range = range_of(input.report.near_m, input.report.far_m);
            live_depths_put(&live->depths, to, 0, true);
        } else {
            status = report_failure(EXIT_FAILED, live->settings->depth.file, "not enough memory");
        }
    }
    input_free(&input);
    return status;
}
