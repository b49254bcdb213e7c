/* live_render.c: each frame gets its depth, is refocused, and goes on to the output. */
#include <math.h>
#include <stdlib.h>
#include "inputs/lens.h"
#include "inputs/upsample.h"
#include "line/interrupt.h"
#include "live/live_look.h"
#include "live/live_render.h"

/* Small changes of the light of highlights from frame to frame are reduced by this part. */
#define STEADY_LIGHT 0.8f

/* A renderer for pictures of this size; the old one goes. */
static bool fit_renderer(struct live *live, int width, int height)
{
    struct refocus_renderer_params params =
        refocus_renderer_params_default(width, height, (float)live->focus.blur_most);
    const int64_t begin = live_now_ns();
    char why[256];
    int status;

    interrupt_watch(NULL);
    refocus_renderer_destroy(&live->engine->renderer);
    params.threads = (int32_t)live->settings->engine.threads;
    params.cpu = (uint32_t)live->settings->engine.cpu;
    params.papers = refocus_papers();
    params.methods = live->engine->methods;
    params.thin = live->settings->engine.quality == QUALITY_BEST;
    if (live->settings->depth.edges == EDGES_AUTO)
        params.depth_edges = REFOCUS_DEPTH_EDGES_STEADY;
    status = refocus_renderer_create(&live->engine->renderer, &params);
    live->create_ms = (double)(live_now_ns() - begin) / 1e6;
    if (status != REFOCUS_OK) {
        snprintf(why, sizeof why, "%s: %dx%d pixels with blur up to %.4g need %.0f MiB",
                 refocus_strerror(status), width, height, live->focus.blur_most,
                 (double)refocus_renderer_memory(&params) / (1 << 20));
        live_fail(live, EXIT_FAILED, live->settings->camera, why);
        return false;
    }
    interrupt_watch(live->engine->renderer);
    live->engine->info = refocus_renderer_info_default();
    refocus_renderer_get_info(live->engine->renderer, &live->engine->info);
    return true;
}

/* The points that are asked for, by the disparities that are prepared. */
static void find_points(struct live *live, int width, int height)
{
    uint16_t *disparity = NULL;
    double point[2];

    live_focus_size(&live->focus, width, height);
    while (live_focus_point(&live->focus, point)) {
        const double x = isnan(point[0]) ? width / 2 : fmin(fmax(point[0], 0), width - 1);
        const double y = isnan(point[1]) ? height / 2 : fmin(fmax(point[1], 0), height - 1);

        if (!disparity)
            disparity = malloc((size_t)width * (size_t)height * 2);
        if (!disparity || refocus_get_view(live->engine->renderer, REFOCUS_VIEW_DISPARITY,
                                           disparity, (ptrdiff_t)width * 2) != REFOCUS_OK)
            break;
        live_focus_found(&live->focus, point,
                         input_surface_at(disparity, width, height, (int)x, (int)y));
    }
    free(disparity);
}

/* The focus goes with the subject of a rectangle, if one is followed, and where the subject cannot
 * be found it stays. */
static void follow(struct live *live, const struct refocus_image *photo,
                   const struct refocus_disparity *map)
{
    struct live_tracker *const tracker = &live->tracker;
    const double seconds = (double)(live->clock_ns - live->tracked_ns) / 1e9;
    double rectangle[4];
    int corner[2], end[2];
    uint64_t asked;
    float disparity;
    bool first;

    live->tracked_ns = live->clock_ns;
    if (!live_focus_rectangle(&live->focus, rectangle, &asked)) {
        live->tracked = 0;
        return;
    }
    first = live->tracked != asked;
    if (first)
        live_track_begin(tracker, rectangle);
    live->tracked = asked;
    if (!live_track_frame(tracker, photo))
        return;
    for (int i = 0; i < 2; i++) {
        const int samples = i ? map->height : map->width;
        const double scale = (double)samples / (i ? photo->height : photo->width);

        corner[i] = (int)fmin(fmax(tracker->box[i] * scale, 0), samples - 1);
        end[i] = (int)fmin(
            fmax(ceil((tracker->box[i] + tracker->box[2 + i]) * scale), corner[i] + 1), samples);
    }
    if (refocus_focus_in_rectangle(map, corner[0], corner[1], end[0] - corner[0],
                                   end[1] - corner[1], &disparity) == REFOCUS_OK)
        live_focus_follow(&live->focus, (double)disparity, first, seconds);
}

/* Time goes on with the frames, so that the same ones make the same pull however long they take;
 * it stands still when one lies before the last. */
static void advance(struct live *live, const struct live_picture *picture)
{
    const int64_t step = picture->timestamp_ns - live->last_frame_ns;

    if (live->frames_rendered++ > 0 && step > 0)
        live->clock_ns += step;
    live->last_frame_ns = picture->timestamp_ns;
}

/* Puts a map of the photo's size in place of a map of another, in memory that `full` owns, by a way
 * of upsample_words; the core's is left to the renderer. */
static int upsample(struct live_depth_map *full, const struct live_depth_map **map,
                    const struct refocus_image *photo, int way, struct refocus_reason *reason)
{
    const struct live_depth_map *const from = *map;
    const struct refocus_disparity small =
        refocus_disparity16(from->disparity, from->width, from->height, (ptrdiff_t)from->width * 2);
    int status;

    if (way == 0 || (from->width == photo->width && from->height == photo->height))
        return REFOCUS_OK;
    if (!live_depth_reserve(full, photo->width, photo->height))
        return REFOCUS_ERR_MEMORY;
    status = upsample_by_filter(way, photo, &small, full->disparity, reason);
    full->timestamp_ns = from->timestamp_ns;
    full->number = from->number;
    full->range = from->range;
    *map = full;
    return status;
}

static int refocus(struct live *live, const struct live_picture *picture,
                   const struct live_depth_map *map, const struct refocus_image *out,
                   struct refocus_reason *reason)
{
    struct refocus_settings params = live->engine->params;
    struct refocus_disparity disparity;
    struct refocus_scene scene;
    int64_t begin = live_now_ns();
    int status;

    live->lens_dioptres = (double)picture->lens_dioptres;
    live->range = map->range;
    live_focus_frame(&live->focus, live->clock_ns, live->lens_dioptres, &live->range);
    status = live_depth_widen(&live->wide, &map, &live->range);
    if (status == REFOCUS_OK)
        status =
            upsample(&live->full, &map, &picture->image, live->settings->depth.upsample, reason);
    if (status != REFOCUS_OK)
        return status;
    disparity =
        refocus_disparity16(map->disparity, map->width, map->height, (ptrdiff_t)map->width * 2);
    scene = refocus_scene_default(&picture->image, &disparity);
    if (live->settings->depth.edges == EDGES_AUTO)
        scene.depth_edges = REFOCUS_DEPTH_EDGES_STEADY;
    status = refocus_prepare_scene(live->engine->renderer, &scene);
    if (status != REFOCUS_OK)
        return status;
    live_times_add(&live->prepare.times, (double)(live_now_ns() - begin) / 1e6);
    follow(live, &picture->image, &disparity);
    find_points(live, picture->image.width, picture->image.height);
    live_focus_get(&live->focus, &live->focus_disparity, &live->blur);
    begin = live_now_ns();
    params.render.focus_disparity = (float)live->focus_disparity;
    params.render.max_blur_radius = (float)live->blur;
    engine_suit_rays(live->engine, &params);
    params.highlights.steady = STEADY_LIGHT;
    /* Y, U and V have silhouettes alone; R, G and B would have thin structures, too, which flicker
     * under the noise of video. */
    params.thin.enabled = live->settings->engine.quality == QUALITY_BEST &&
                          (picture->still || refocus_format_is_yuv(picture->image.format));
    params.look.grain_seed +=
        (uint32_t)(live->frames_rendered - 1); /* Grain that stands is dirt. */
    if (live_look_aim(live, &picture->image, &params) != EXIT_DONE)
        return REFOCUS_ERR_ARGUMENT;
    status = refocus_render_settings(live->engine->renderer, &params, out);
    live_times_add(&live->render.times, (double)(live_now_ns() - begin) / 1e6);
    return status;
}

const struct live_depth_map *live_pair(struct live *live, const struct live_picture *picture)
{
    const double fps = live->mode.fps > 0 ? live->mode.fps : 30;
    const int64_t begin = live_now_ns();
    const struct live_depth_map *map;
    bool paired;

    if (live->estimator) /* by number, and the newest that there is serves at once */
        map = live_depths_pair(&live->depths, picture->key, 0, 0, &paired);
    else /* depth may be late by one and a half frames */
        map = live_depths_pair(&live->depths, picture->timestamp_ns, (int64_t)(0.5e9 / fps) + 1,
                               picture->taken_ns + (int64_t)(1.5e9 / fps), &paired);
    live_times_add(&live->pair.times, (double)(live_now_ns() - begin) / 1e6);
    if (!map)
        live->without_depth++;
    else if (paired)
        live->paired++;
    else
        live->unpaired++;
    return map;
}

/* False when it is over. */
static bool process(struct live *live, struct live_picture *picture, int size[2], int placed[2])
{
    const int width = picture->image.width, height = picture->image.height;
    const struct live_depth_map *map = live_pair(live, picture);
    struct refocus_reason reason = {""};
    struct live_picture *out;
    bool memory;
    int status;

    if (!map)
        return !live_depths_have_failed(&live->depths);
    if (live->settings->steady > 0) {
        status = live_steady_run(&live->steady, live->settings->steady, &map, &picture->image);
        if (status != REFOCUS_OK) {
            if (status != REFOCUS_ERR_CANCELLED)
                live_fail(live, EXIT_FAILED, "--steady", refocus_strerror(status));
            return false;
        }
    }
    if (!live->engine->renderer || width > size[0] || height > size[1]) {
        if (!fit_renderer(live, width, height))
            return false;
        size[0] = width;
        size[1] = height;
    }
    if (width != placed[0] || height != placed[1]) {
        const int placing = live_look_place(live, width, height);

        if (placing != EXIT_DONE) {
            live_fail(live, placing, "", "");
            return false;
        }
        placed[0] = width;
        placed[1] = height;
    }
    out = live_queue_fill(&live->rendered, picture->image.format, width, height, &memory);
    if (!out)
        return false;
    out->image.matrix = picture->image.matrix;
    out->image.range = picture->image.range;
    status = memory ? refocus(live, picture, map, &out->image, &reason) : REFOCUS_ERR_MEMORY;
    if (status != REFOCUS_OK) {
        live_queue_return(&live->rendered, out);
        if (status != REFOCUS_ERR_CANCELLED)
            live_fail(live, EXIT_FAILED, reason.text[0] ? "--upsample" : live->settings->camera,
                      reason.text[0] ? reason.text : refocus_strerror(status));
        return false;
    }
    out->timestamp_ns = picture->timestamp_ns;
    out->taken_ns = picture->taken_ns;
    live_queue_put(&live->rendered, out);
    return true;
}

void live_render(struct live *live)
{
    const int64_t begin = live_now_ns();
    const double duration = live->settings->duration;
    const bool offline = live->settings->offline;
    int size[2] = {0, 0}, placed[2] = {0, 0}; /* Sizes of the renderer and of the last picture. */
    bool ended = false;

    while (!ended && !live_is_over(live)) {
        struct live_picture *picture = live_queue_take(&live->captured, &ended);
        bool go_on = true;

        if (picture) {
            advance(live, picture);
            if (offline && duration > 0 && (double)live->clock_ns / 1e9 >= duration)
                go_on = false;
            else
                go_on = process(live, picture, size, placed);
            live_queue_return(&live->captured, picture);
        }
        if (!offline && duration > 0 && (double)(live_now_ns() - begin) / 1e9 >= duration)
            go_on = false;
        if (!go_on || interrupt_came())
            break;
    }
    interrupt_watch(NULL);
    live_steady_end(&live->steady);
    free(live->wide.disparity);
    free(live->full.disparity);
    live_queue_close(&live->rendered);
}
