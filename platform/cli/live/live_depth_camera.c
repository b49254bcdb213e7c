/* live_depth_camera.c: the thread that takes depth from a camera, and the fixed depth map in its
 * place. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "line/report.h"
#include "live/live_depth_camera.h"
#include "live/live_lane.h"
#include "live/live_look.h"

/* The samples of a map on their way to disparities. */
struct samples {
    uint16_t *own,
        *registered; /* samples as the camera gives them, and as the colour camera sees them */
    size_t capacity; /* number of samples in each */
    void *work;      /* memory of the repair */
    size_t work_bytes;
    uint32_t flags; /* refocus_depth_follow_flags() gave them for the last map */
};

static bool reserve(struct samples *samples, const struct refocus_calibration *c,
                    const struct refocus_frame *frame)
{
    size_t count = (size_t)frame->width * (size_t)frame->height;

    if (c && (size_t)c->colour.width * (size_t)c->colour.height > count)
        count = (size_t)c->colour.width * (size_t)c->colour.height;
    if (count <= samples->capacity)
        return true;
    free(samples->own);
    free(samples->registered);
    samples->own = malloc(count * 2);
    samples->registered = malloc(count * 2);
    samples->capacity = samples->own && samples->registered ? count : 0;
    return samples->capacity > 0;
}

/* As large as the largest map needs that has come. */
static bool reserve_work(struct samples *samples, const struct refocus_depth_map *map)
{
    const uint64_t bytes = refocus_repair_memory(map->width, map->height, 0);

    if (bytes <= samples->work_bytes)
        return true;
    free(samples->work);
    samples->work = bytes <= SIZE_MAX ? malloc((size_t)bytes) : NULL;
    samples->work_bytes = samples->work ? (size_t)bytes : 0;
    return samples->work != NULL;
}

/* The samples mean what the option says, else millimetres for depth cameras and disparities for
 * pictures. */
static int describe(struct live_lane *lane, const struct refocus_frame *frame,
                    struct refocus_depth_map *map, struct refocus_reason *reason)
{
    const struct samples *const samples = lane->user;
    const struct depth_settings *settings = &lane->live->settings->depth;
    const bool picture =
        frame->format == REFOCUS_FRAME_GREY || strncmp(lane->name, "file:", 5) == 0;
    const char *unit = settings->unit ? settings->unit : picture ? "disparity" : "mm";

    *map = refocus_depth_map_default();
    map->samples = samples->own;
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
    if (live_look_needs_metres(lane->live->settings) && map->meaning != REFOCUS_DEPTH_DISTANCE &&
        !(map->near_m > 0 && map->far_m > map->near_m)) {
        snprintf(reason->text, sizeof reason->text, "%s", live_look_no_metres);
        return REFOCUS_ERR_ARGUMENT;
    }
    return REFOCUS_OK;
}

/* Distances without a value become 0, before they are registered and their range is measured.
 * Where 65535 may be one, it is or is not from map to map alike. */
static int clear_codes(struct samples *samples, struct refocus_depth_map *map, const char *invalid)
{
    const size_t count = (size_t)map->width * (size_t)map->height;
    const int status = refocus_depth_follow_flags(map, &samples->flags);

    if (status != REFOCUS_OK)
        return status;
    map->flags |= samples->flags;
    refocus_depth_set_invalid(map, invalid);
    for (size_t i = 0; map->meaning == REFOCUS_DEPTH_DISTANCE && i < count; i++)
        if (refocus_depth_is_code(map, samples->own[i]))
            samples->own[i] = 0;
    return REFOCUS_OK;
}

static int register_map(struct live_lane *lane, struct refocus_depth_map *map,
                        struct refocus_reason *reason)
{
    const struct samples *const samples = lane->user;
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
    refocus_register_depth(c, samples->own, map->metres_per_unit, samples->registered);
    map->samples = samples->registered;
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

/* The range that disparity 1 and 0 stand for in this map: distances follow the scene, but for ends
 * that are given. */
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
        map->far_m = 1 / ranger->range.far; /* INFINITY for 0 */
    }
    return ranger->maps > 0 ? ranger->range : (struct live_range){0, 0};
}

static int deliver_depth(struct live_lane *lane, const struct refocus_frame *frame, int64_t now_ns,
                         struct refocus_reason *reason)
{
    struct samples *const samples = lane->user;
    struct live *live = lane->live;
    struct refocus_depth_map map;
    struct live_range range;
    struct live_depth_map *to;
    struct refocus_repair_params repair = refocus_repair_params_default();
    int status = reserve(samples, live->calibration, frame) ? REFOCUS_OK : REFOCUS_ERR_MEMORY;
    double ms;

    if (status == REFOCUS_OK)
        status = refocus_convert_samples(lane->converter, frame, samples->own, reason);
    if (status == REFOCUS_OK)
        status = describe(lane, frame, &map, reason);
    if (status == REFOCUS_OK)
        status = clear_codes(samples, &map, live->settings->depth.invalid);
    if (status == REFOCUS_OK && live->calibration)
        status = register_map(lane, &map, reason);
    if (status == REFOCUS_OK && !reserve_work(samples, &map))
        status = REFOCUS_ERR_MEMORY;
    if (status != REFOCUS_OK)
        return status;
    range = follow_range(live, &map, frame->timestamp_ns);
    ms = (double)(live_now_ns() - now_ns) / 1e6;
    to = live_depths_fill(&live->depths, map.width, map.height);
    if (!to)
        return live_is_over(live) ? REFOCUS_OK : REFOCUS_ERR_MEMORY;
    now_ns = live_now_ns();
    repair.memory = samples->work;
    repair.memory_bytes = samples->work_bytes;
    status = refocus_depth_repair(&map, &repair, to->disparity, (ptrdiff_t)map.width * 2, NULL);
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
    struct samples samples = {0};
    struct live_lane lane = live_lane_of(live, live->depth_camera, live->settings->depth.file,
                                         &live->depth_mode, &live->depth);
    const struct depth_settings *depth = &live->settings->depth;
    const double fps = live->mode.fps > 0 ? live->mode.fps : 30;

    lane.deliver = deliver_depth;
    lane.user = &samples;
    live_range_begin(&live->ranger, isnan(depth->near_m) ? 0 : depth->near_m,
                     isnan(depth->far_m) ? 0 : depth->far_m);
    /* A picture waits so long for its depth; without a limit a slow machine would be behind for
     * ever. */
    lane.late_ns = (int64_t)(1.5e9 / fps);
    if (refocus_converter_create(&lane.converter) == REFOCUS_OK)
        live_lane_run(&lane);
    else
        live_fail(live, EXIT_FAILED, lane.name, "not enough memory");
    refocus_converter_destroy(&lane.converter);
    free(samples.own);
    free(samples.registered);
    free(samples.work);
    live_range_end(&live->ranger);
    if (!lane.failed && live->depths.count == 0 && !live_is_over(live)) {
        lane.failed = true;
        live_note_failure(live, EXIT_FAILED, lane.name, "it ended without a depth map");
    }
    live_depths_end(&live->depths, lane.failed);
    if (lane.failed && live->settings->policy == POLICY_NEWEST)
        live_queue_close(&live->captured);
    return NULL;
}

int live_read_fixed_depth(struct live *live)
{
    struct input input;
    struct live_depth_map *to;
    int status = input_read_depth(&input, live->settings->depth.file, &live->settings->depth);

    if (status == EXIT_DONE && live_look_needs_metres(live->settings) &&
        !(input.report.near_m > 0 && input.report.far_m > input.report.near_m))
        status = report_failure(EXIT_FAILED, live->settings->depth.file, "%s", live_look_no_metres);
    if (status == EXIT_DONE) {
        const int width = input.depth_from->depth->width;
        const int height = input.depth_from->depth->height;

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
