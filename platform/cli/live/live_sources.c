/* live_sources.c: the cameras and depth that refocus live takes. */
#include <stdlib.h>
#include <string.h>
#include "line/report.h"
#include "live/live_calibration.h"
#include "live/live_depth_camera.h"
#include "live/live_estimate.h"
#include "live/live_lens.h"
#include "live/live_sources.h"
#include "live/live_stack.h"

/* The most that refocus_source_start() takes. */
#define MOST_FPS 10000

/* A signal ends the wait for a camera, too: all that follows is then over before it begins. */
static int open_camera(struct live *live, const char *name, bool depth,
                       struct refocus_source **source, struct refocus_source_mode *mode)
{
    const struct refocus_source_mode *const other = depth ? &live->mode : &live->depth_mode;
    struct refocus_source *opened;
    const struct live_settings *settings = live->settings;
    struct refocus_source_config config = refocus_source_config_default();
    struct refocus_reason reason = {""};
    int status;

    *mode = refocus_source_mode_default();
    if (!depth) {
        config.format = (uint32_t)settings->format;
        config.width = isnan(settings->size[0]) ? 0 : (int32_t)settings->size[0];
        config.height = isnan(settings->size[0]) ? 0 : (int32_t)settings->size[1];
    }
    config.fps = isnan(settings->fps) ? 0 : settings->fps;
    config.default_fps = fmin(other->fps, MOST_FPS);
    config.flags =
        (settings->fast ? REFOCUS_SOURCE_FAST : 0) | (settings->loop ? REFOCUS_SOURCE_LOOP : 0) |
        (settings->dmabuf ? REFOCUS_SOURCE_DMABUF : 0) | (depth ? REFOCUS_SOURCE_DEPTH : 0);
    status = refocus_source_open(&opened, name, &reason);
    pthread_mutex_lock(&live->lock);
    *source = opened;
    pthread_mutex_unlock(&live->lock);
    if (status == REFOCUS_OK && !depth) {
        const int asked = live_lens_ask(opened, name, &settings->autofocus);

        if (asked != EXIT_DONE)
            return asked;
    }
    if (status == REFOCUS_OK)
        status = refocus_source_start(opened, &config, mode, &reason);
    if (status != REFOCUS_OK && !(status == REFOCUS_ERR_CANCELLED && live_is_over(live)))
        return report_failure(input_exit_code(status), name, "%s",
                              reason.text[0] ? reason.text : refocus_strerror(status));
    return EXIT_DONE;
}

/* Pictures have no rate of their own: of two sources of files they are opened last, and take that
 * of the other. */
static int open_cameras(struct live *live)
{
    const char *const camera = live->settings->camera, *const depth = live->settings->depth.file;
    const uint32_t kind = refocus_source_kind(depth);
    const bool depth_first =
        kind == REFOCUS_SOURCE_KIND_FILE && strncmp(camera, "file:", strlen("file:")) == 0;
    int status = EXIT_DONE;

    if (depth_first)
        status = open_camera(live, depth, true, &live->depth_camera, &live->depth_mode);
    if (status == EXIT_DONE)
        status = open_camera(live, camera, false, &live->camera, &live->mode);
    if (status == EXIT_DONE && kind && !depth_first)
        status = open_camera(live, depth, true, &live->depth_camera, &live->depth_mode);
    return status;
}

int live_sources_open(struct live *live)
{
    const struct live_settings *settings = live->settings;
    int status = EXIT_DONE;

    if (settings->calibration)
        status = live_read_calibration(&live->calibration, settings->calibration);
    /* A network takes a while to load, in which a camera that runs would lose frames. */
    if (status == EXIT_DONE && settings->estimate.model[0])
        status = live_estimate_open(live);
    if (status == EXIT_DONE)
        status = open_cameras(live);
    if (status == EXIT_DONE && settings->stack.steps > 0)
        status = live_stack_open(live);
    else if (status == EXIT_DONE && !live->estimator && !live->depth_camera)
        status = live_read_fixed_depth(live);
    return status;
}

void live_sources_close(struct live *live)
{
    refocus_source_close(&live->camera);
    refocus_source_close(&live->depth_camera);
    live_estimate_close(live);
    live_stack_close(live);
    free(live->calibration);
}
