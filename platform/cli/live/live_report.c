/* live_report.c: the report at the end says what became of the frames and how long it took. */
#include <stdio.h>
#include "line/report.h"
#include "live/live_report.h"

static json_t *stage_json(const struct live_stage *stage)
{
    return json_pack("{s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:f}", "frames",
                     (json_int_t)stage->frames, "corrupt", (json_int_t)stage->corrupt, "damaged",
                     (json_int_t)stage->damaged, "reordered", (json_int_t)stage->reordered,
                     "retimed", (json_int_t)stage->retimed, "timeouts", (json_int_t)stage->timeouts,
                     "recoveries", (json_int_t)stage->recoveries, "worst_recovery_ms",
                     stage->worst_recovery_ms);
}

static double mean(const struct live_stage *stage)
{
    return stage->times.count ? stage->times.sum_ms / (double)stage->times.count : 0;
}

/* The format that the last frame was rendered in. */
static const char *rendered_in(uint32_t image_format)
{
    for (uint32_t i = 1; i < REFOCUS_FRAME_FORMAT_COUNT; i++)
        if (i != REFOCUS_FRAME_UYVY && refocus_frame_image_format(i) == image_format &&
            image_format != REFOCUS_FORMAT_NONE)
            return refocus_frame_format_name(i);
    return "RGB24";
}

/* The share of the time for a frame that is not spent on preparing and rendering it. */
static double outside_rendering(const struct live *live)
{
    const double inside = mean(&live->prepare) + mean(&live->render);
    const double outside = mean(&live->capture) + mean(&live->output);

    return inside + outside > 0 ? outside / (inside + outside) : 0;
}

/* 0: not known. */
static double metres(const struct live_range *range, bool near)
{
    return live_range_is_known(range) ? 1 / (near ? range->near : range->far) : 0;
}

/* A failure whose words were printed where it happened has none here. */
static json_t *error_json(const struct live *live)
{
    char text[sizeof live->what + sizeof live->why + 2];

    snprintf(text, sizeof text, "%s%s%s", live->what, live->what[0] ? ": " : "",
             live->what[0] ? report_without_name(live->what, live->why)
                           : "it failed; standard error says why");
    return report_text_json(text);
}

/* The frames of a whole run. */
struct totals {
    uint64_t out, dropped, dropped_rendered;
    double fps;
    struct refocus_source_counters camera;
};

static struct totals totals_of(struct live *live)
{
    const double seconds = (double)(live->last_out_ns - live->first_out_ns) / 1e9;
    struct totals totals = {.out = atomic_load(&live->frames_out),
                            .dropped_rendered = live_queue_dropped(&live->rendered),
                            .camera = refocus_source_counters_default()};

    totals.fps = seconds > 0 ? (double)(totals.out - 1) / seconds : 0;
    totals.dropped =
        live->capture.skipped + live_queue_dropped(&live->captured) + totals.dropped_rendered;
    refocus_source_get_counters(live->camera, &totals.camera);
    return totals;
}

static json_t *frames_json(const struct live *live, const struct totals *totals)
{
    return json_pack(
        "{s:o, s:s?, s:i, s:i, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:f, s:o, s:f, s:f}",
        "camera", report_text_json(live->settings->camera), "format",
        refocus_frame_format_name(live->mode.format), "width", (int)live->mode.width, "height",
        (int)live->mode.height, "frames_in", (json_int_t)live->capture.frames, "frames_out",
        (json_int_t)totals->out, "dropped", (json_int_t)totals->dropped, "camera_dropped",
        (json_int_t)totals->camera.dropped, "sink_dropped", (json_int_t)live->sink_dropped,
        "paired", (json_int_t)live->paired, "unpaired", (json_int_t)live->unpaired, "without_depth",
        (json_int_t)live->without_depth, "commands", (json_int_t)live->commands, "fps", totals->fps,
        "latency_ms", live_times_json(&live->latency), "outside_rendering", outside_rendering(live),
        "create_ms", live->create_ms);
}

/* Where the subject is, and how often it was not found. */
static json_t *tracked_json(const struct live_tracker *tracker)
{
    return json_pack("{s:[f, f, f, f], s:f, s:I}", "rectangle", tracker->box[0], tracker->box[1],
                     tracker->box[2], tracker->box[3], "likeness", tracker->likeness, "lost",
                     (json_int_t)tracker->lost);
}

static json_t *stages_json(const struct live *live)
{
    return json_pack(
        "{s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "convert", live_times_json(&live->capture.times),
        "depth", live_times_json(&live->depth.times), "pair", live_times_json(&live->pair.times),
        "steady", live_times_json(&live->steady.times), "prepare",
        live_times_json(&live->prepare.times), "render", live_times_json(&live->render.times),
        "output", live_times_json(&live->output.times));
}

/* Adds the last frame, in the words of render. */
static void add_last_frame(json_t *json, const struct live *live)
{
    json_object_set_new(json, "focus", report_number_json(live->focus_disparity));
    json_object_set_new(json, "blur", report_number_json(live->blur));
    json_object_set_new(json, "near_m", report_metres_json(metres(&live->range, true)));
    json_object_set_new(json, "far_m", report_metres_json(metres(&live->range, false)));
}

/* Adds what cameras, lens and sink did. */
static void add_devices(json_t *json, const struct live *live, const struct totals *totals)
{
    json_object_set_new(json, "rendered_in", json_string(rendered_in(live->rendered_format)));
    json_object_set_new(json, "colour", stage_json(&live->capture));
    if (live->depth_camera || live->estimator || live->stack)
        json_object_set_new(json, "depth", stage_json(&live->depth));
    if (live->stack)
        json_object_set_new(json, "stacks", json_integer((json_int_t)live->stacks));
    json_object_set_new(json, "dropped_rendered", /* part of "dropped" */
                        json_integer((json_int_t)totals->dropped_rendered));
    json_object_set_new(json, "buffers_lost", json_integer((json_int_t)totals->camera.lost));
    json_object_set_new(json, "sink_recoveries", json_integer((json_int_t)live->output.recoveries));
    json_object_set_new(json, "lens_dioptres", report_number_json(live->lens_dioptres));
    json_object_set_new(json, "lens", live_lens_json(live->camera, &live->settings->autofocus));
    if (live->tracked)
        json_object_set_new(json, "tracked", tracked_json(&live->tracker));
}

int live_report(struct live *live)
{
    const struct totals totals = totals_of(live);
    json_t *json;

    if (!live->settings->engine.json) {
        fprintf(
            stderr,
            "%llu frames in, %llu out, %llu dropped; %.1f a second, %.1f ms from camera to sink\n",
            (unsigned long long)live->capture.frames, (unsigned long long)totals.out,
            (unsigned long long)totals.dropped + totals.camera.dropped, totals.fps,
            live_times_quantile(&live->latency, 0.5));
        return EXIT_DONE;
    }
    json = frames_json(live, &totals);
    if (json && live->exit_code != EXIT_DONE)
        json_object_set_new(json, "error", error_json(live));
    if (json) {
        add_devices(json, live, &totals);
        add_last_frame(json, live);
        json_object_set_new(json, "stages_ms", stages_json(live));
        json_object_set_new(json, "peak_rss_kib", json_integer(report_peak_rss_kib()));
    }
    return report_print_json(json);
}
