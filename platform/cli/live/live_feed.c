/* live_feed.c: the frames of cameras, each with its depth. The range of its disparities only grows,
 * so that a focus stays where it is. */
#include <stdlib.h>
#include "line/report.h"
#include "live/live_colour.h"
#include "live/live_depth_camera.h"
#include "live/live_estimate.h"
#include "live/live_feed.h"
#include "live/live_render.h"
#include "live/live_sources.h"

enum { FEED_THREADS = 3 };

/* The first range is wider than what is seen, by these parts of its ends in 1/m. */
#define NEARER  1.25
#define FARTHER 0.5

struct live_feed {
    struct live live;
    struct live_settings settings;
    struct engine engine;
    struct live_picture *held;
    struct live_depth_map wide;
    struct live_range range;
};

static int start(struct live_feed *feed)
{
    static void *(*const main_of[FEED_THREADS])(void *) = {live_colour_thread, live_depth_thread,
                                                           live_estimate_thread};
    const bool wanted[FEED_THREADS] = {true, feed->live.depth_camera, feed->live.estimator};

    for (int i = 0; i < FEED_THREADS; i++) {
        pthread_t thread;

        if (wanted[i] && pthread_create(&thread, NULL, main_of[i], &feed->live) != 0)
            return report_failure(EXIT_FAILED, "live", "a thread could not be started");
    }
    return EXIT_DONE;
}

int live_feed_open(struct live_feed **feed, const struct live_settings *settings)
{
    struct live_feed *const opened = calloc(1, sizeof *opened);
    int status;

    *feed = opened;
    if (!opened)
        return report_failure(EXIT_FAILED, "live", "not enough memory");
    opened->settings = *settings;
    status = live_begin(&opened->live, &opened->settings, &opened->engine);
    if (status != EXIT_DONE) {
        *feed = NULL;
        free(opened);
        return status;
    }
    status = live_sources_open(&opened->live);
    return status == EXIT_DONE ? start(opened) : status;
}

/* Widen the range by what a map shows; all maps are brought to it. */
static int widen(struct live_feed *feed, const struct live_depth_map **depth)
{
    const struct live_range *const seen = &(*depth)->range;
    struct live_range *const range = &feed->range;

    if (!live_range_is_known(seen))
        return REFOCUS_OK;
    if (!live_range_is_known(range)) {
        *range = *seen;
        if (isnan(feed->settings.depth.near_m))
            range->near *= NEARER;
        if (isnan(feed->settings.depth.far_m))
            range->far *= FARTHER;
    }
    range->near = fmax(range->near, seen->near);
    range->far = fmin(range->far, seen->far);
    return live_depth_widen(&feed->wide, depth, range);
}

static int failed(struct live_feed *feed)
{
    struct live *const live = &feed->live;

    pthread_mutex_lock(&live->lock);
    const int status =
        live->exit_code == EXIT_DONE
            ? report_failure(EXIT_FAILED, live->settings->camera, "no more frames come")
            : report_failure(live->exit_code, live->what, "%s", live->why);
    pthread_mutex_unlock(&live->lock);
    return status;
}

int live_feed_next(struct live_feed *feed, int wait_ms, struct live_frame *frame, bool *came)
{
    const int64_t until = live_now_ns() + (int64_t)wait_ms * 1000000;
    const struct live_depth_map *depth = NULL;
    struct live *const live = &feed->live;
    struct live_picture *picture = NULL;
    bool ended = false;

    *came = false;
    while (!depth && !ended) {
        picture = live_queue_take(&live->captured, &ended);
        depth = picture ? live_pair(live, picture) : NULL;
        if (picture && !depth)
            live_queue_return(&live->captured, picture);
        if (!depth && live_now_ns() > until)
            break;
    }
    if (!depth)
        return ended || live_is_over(live) ? failed(feed) : EXIT_DONE;
    if (feed->held)
        live_queue_return(&live->captured, feed->held);
    feed->held = picture;
    if (widen(feed, &depth) != REFOCUS_OK)
        return report_failure(EXIT_FAILED, live->settings->camera, "not enough memory");
    frame->photo = picture->image;
    frame->depth = depth;
    *came = true;
    return EXIT_DONE;
}
