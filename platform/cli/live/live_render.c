/* The thread that refocuses: depth to each frame, prepare, render, on to the output. */
#include <stdlib.h>
#include "line/interrupt.h"
#include "live/live.h"

/* A renderer for pictures of this size; the old one goes. */
static bool fit_renderer(struct live *live, int width, int height)
{
    struct refocus_renderer_params params = refocus_renderer_params_default(
        width, height, (float)live->focus.blur_most);
    const int64_t begin = live_now_ns();
    char why[256];
    int status;

    interrupt_watch(NULL);
    refocus_renderer_destroy(&live->engine->renderer);
    params.threads = (int32_t)live->settings->engine.threads;
    params.cpu = (uint32_t)live->settings->engine.cpu;
    params.methods = live->engine->methods;
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
    refocus_renderer_get_info(live->engine->renderer, &live->engine->info);
    return true;
}

/* The point that is asked for, by the disparities that are prepared. */
static void find_focus(struct live *live, int width, int height)
{
    uint16_t *disparity;
    double point[2], seconds;
    int x, y;

    live_focus_size(&live->focus, width, height);
    if (!live_focus_point(&live->focus, point, &seconds))
        return;
    x = isnan(point[0]) ? width / 2 : (int)fmin(fmax(point[0], 0), width - 1);
    y = isnan(point[1]) ? height / 2 : (int)fmin(fmax(point[1], 0), height - 1);
    disparity = malloc((size_t)width * (size_t)height * 2);
    if (disparity && refocus_get_view(live->engine->renderer, REFOCUS_VIEW_DISPARITY,
                                      disparity, (ptrdiff_t)width * 2) == REFOCUS_OK)
        live_focus_pull(&live->focus, input_surface_at(disparity, width, height, x, y),
                        seconds);
    free(disparity);
}

/* Where the camera's own lens is in focus, when nobody says otherwise. */
static void follow_lens(struct live *live, float dioptres)
{
    double near_m, far_m;

    pthread_mutex_lock(&live->depths.lock);
    near_m = live->range.near_m;
    far_m = live->range.far_m;
    pthread_mutex_unlock(&live->depths.lock);
    live->lens_dioptres = dioptres;
    if (!isfinite(dioptres) || !(near_m > 0 && far_m > near_m))
        return;
    pthread_mutex_lock(&live->focus.lock);
    if (live->focus.follow_lens) {
        const double far = 1 / far_m;
        const double d = ((double)dioptres - far) / (1 / near_m - far);

        live->focus.at_given = false;
        live->focus.from = live->focus.to = d < 0 ? 0 : d > 1 ? 1 : d;
        live->focus.duration_ns = 0;
    }
    pthread_mutex_unlock(&live->focus.lock);
}

static int refocus(struct live *live, const struct live_picture *picture,
                   const struct live_depth_map *map, const struct refocus_image *out)
{
    struct refocus_render_params params = live->engine->params;
    const struct refocus_disparity disparity = refocus_disparity16(
        map->disparity, map->width, map->height, (ptrdiff_t)map->width * 2);
    int64_t begin = live_now_ns(), prepared;
    double focus, blur;
    int status = refocus_prepare(live->engine->renderer, &picture->image, &disparity);

    if (status != REFOCUS_OK)
        return status;
    prepared = live_now_ns();
    live_times_add(&live->prepare.times, (double)(prepared - begin) / 1e6);
    follow_lens(live, picture->lens_dioptres);
    find_focus(live, picture->image.width, picture->image.height);
    begin = live_now_ns();
    live_focus_get(&live->focus, begin, &focus, &blur);
    params.focus_disparity = (float)focus;
    params.max_blur_radius = (float)blur;
    status = refocus_render(live->engine->renderer, &params, out);
    live_times_add(&live->render.times, (double)(live_now_ns() - begin) / 1e6);
    return status;
}

/* The depth of a picture, or NULL; counts which it was. */
static const struct live_depth_map *pair(struct live *live,
                                         const struct live_picture *picture)
{
    const double fps = live->mode.fps > 0 ? live->mode.fps : 30;
    const int64_t begin = live_now_ns();
    const struct live_depth_map *map;
    bool paired;

    if (live->estimator) /* by number, and the newest that there is serves at once */
        map = live_depths_pair(&live->depths, picture->key, 0, &paired);
    else
        map = live_depths_pair(&live->depths, picture->timestamp_ns,
                               (int64_t)(0.5e9 / fps) + 1, &paired);
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
static bool process(struct live *live, struct live_picture *picture, int size[2])
{
    const int width = picture->image.width, height = picture->image.height;
    const struct live_depth_map *map = pair(live, picture);
    struct live_picture *out;
    bool memory;
    int status;

    if (!map)
        return true;
    if (live->settings->steady > 0) {
        status = live_steady_run(&live->steady, live->settings->steady, &map, &picture->image);
        if (status != REFOCUS_OK) {
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
    out =
        live_queue_fill(&live->rendered, picture->image.format, width, height, &memory);
    if (!out)
        return false;
    out->image.matrix = picture->image.matrix;
    out->image.range = picture->image.range;
    status = memory ? refocus(live, picture, map, &out->image) : REFOCUS_ERR_MEMORY;
    if (status != REFOCUS_OK) {
        live_queue_return(&live->rendered, out);
        if (status != REFOCUS_ERR_CANCELLED)
            live_fail(live, EXIT_FAILED, live->settings->camera,
                      refocus_strerror(status));
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
    int size[2] = {0, 0};
    bool ended = false;

    while (!ended && !live_is_over(live)) {
        struct live_picture *picture = live_queue_take(&live->captured, &ended);
        bool go_on = true;

        if (picture) {
            go_on = process(live, picture, size);
            live_queue_return(&live->captured, picture);
        }
        if (duration > 0 && (double)(live_now_ns() - begin) / 1e9 >= duration)
            go_on = false;
        if (!go_on || interrupt_came())
            break;
    }
    interrupt_watch(NULL);
    live_steady_end(&live->steady);
    live_queue_close(&live->rendered);
}
