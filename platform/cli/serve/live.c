/* live.c: frames of cameras in place of a photo. All clients look at the newest one, each with
 * settings of its own. */
#include <stdlib.h>
#include <refocus/platform/source.h>
#include "inputs/painted.h"
#include "live/live_options.h"
#include "outputs/outputs.h"
#include "serve/serving.h"
#include "view/reduce.h"

/* Time to wait for a frame: the first one, with its depth; a newer one. */
enum { FIRST_MS = 10000, NEWER_MS = 500 };
enum { STILL_QUALITY = 95 };

void serve_live_none(struct serve_base *base)
{
    base->live = live_settings_none;
}

/* Files begin again at their end, as if they were a camera. */
int serve_live_check(struct serve_base *base)
{
    struct live_settings *const live = &base->live;

    if (!live->camera) {
        const struct depth_settings *const depth = &live->depth;
        const char *const option = depth->unit             ? "--depth-unit"
                                   : !isnan(depth->near_m) ? "--near"
                                   : !isnan(depth->far_m)  ? "--far"
                                                           : NULL;

        if (live->depth.file)
            return report_failure(EXIT_WRONG, "--depth",
                                  "it goes with --live; a photo gets its map by 'refocus depth "
                                  "PHOTO --depth MAP -o NEW.jpg'");
        return option ? report_failure(EXIT_WRONG, option, "it goes with --live; give that too")
                      : EXIT_DONE;
    }
    live->loop = refocus_source_kind(live->camera) != REFOCUS_SOURCE_KIND_CAMERA;
    live->policy = POLICY_NEWEST;
    return live_check_settings(live);
}

/* A map is brought to the photo's size by its nearest samples, for looking up single ones: what is
 * rendered has the map itself. */
static void enlarge(const struct live_depth_map *map, int width, int height, uint16_t *placed)
{
    for (int y = 0; y < height; y++) {
        const uint16_t *const row =
            map->disparity + (size_t)((int64_t)y * map->height / height) * (size_t)map->width;

        for (int x = 0; x < width; x++)
            placed[(size_t)y * (size_t)width + (size_t)x] = row[(int64_t)x * map->width / width];
    }
}

/* Frames of another size than before, or the first one. */
static int change_size(struct serving *s)
{
    const struct refocus_image *const photo = &s->taken.photo;

    serve_watch(NULL);
    refocus_renderer_destroy(&s->small);
    refocus_renderer_destroy(&s->full);
    free(s->small_photo);
    free(s->small_disparity);
    free(s->placed);
    s->placed = malloc(2 * (size_t)photo->width * (size_t)photo->height);
    return s->placed ? serve_reduce(s)
                     : report_failure(EXIT_FAILED, s->work->name, "not enough memory");
}

/* Make the frame that was taken the photo that is open. */
static int open_frame(struct serving *s, int old_width, int old_height)
{
    const struct live_depth_map *const map = s->taken.depth;
    const struct refocus_image *const photo = &s->taken.photo;
    struct input *const input = &s->input;
    int status = EXIT_DONE;

    s->as_photo = (struct refocus_photo){
        .image = &s->taken.photo, .depth = &s->no_depth, .info = &s->no_info, .deep = &s->no_image};
    input->photo_name = s->work->name;
    input->photo = &s->as_photo;
    input->most_blur = REFOCUS_PLAIN_BLUR_RADIUS;
    painted_begin(input, &s->base.depth);
    input->disparity = map->disparity;
    input->width = map->width;
    input->height = map->height;
    if (live_range_is_known(&map->range)) {
        input->report.near_m = 1 / map->range.near;
        input->report.far_m = 1 / map->range.far; /* INFINITY for 0 */
    }
    if (photo->width != old_width || photo->height != old_height)
        status = change_size(s);
    else
        rf_reduce_photo(photo, s->reduction, s->small_photo);
    if (status != EXIT_DONE)
        return status;
    enlarge(map, photo->width, photo->height, s->placed);
    s->small_stale = s->full_stale = s->has_depth = true;
    return EXIT_DONE;
}

/* Take a newer frame, if one comes within that time. */
static int take(struct serving *s, int wait_ms)
{
    const int width = s->taken.photo.width, height = s->taken.photo.height;
    bool came;
    int status = live_feed_next(s->feed, wait_ms, &s->taken, &came);

    if (status == EXIT_DONE && came) {
        status = open_frame(s, width, height);
        s->frame++;
    }
    return status;
}

int serve_live_open(struct serving *s)
{
    int status = EXIT_DONE;

    if (!s->feed)
        status = live_feed_open(&s->feed, s->live);
    if (status == EXIT_DONE && s->frame == 0)
        status = take(s, FIRST_MS);
    if (status == EXIT_DONE && s->frame == 0)
        status = report_failure(EXIT_FAILED, s->work->name,
                                "no frame comes that has depth; check the cameras");
    return status;
}

int serve_live_still(struct serving *s, struct refocus_blob *bytes)
{
    const struct live_depth_map *const map = s->taken.depth;
    struct refocus_depth_write depth = refocus_depth_write_default();
    struct refocus_write_options options = output_keeps(NULL);
    struct refocus_reason reason = {""};
    char *path = NULL;
    int status = serve_temporary("jpg", &path);

    if (status != EXIT_DONE)
        return status;
    depth.disparity = map->disparity;
    depth.width = map->width;
    depth.height = map->height;
    depth.stride = 2 * (ptrdiff_t)map->width;
    depth.near_m = s->input.report.near_m;
    depth.far_m = s->input.report.far_m;
    options.quality = STILL_QUALITY;
    options.unsynced = 1;
    status = output_write_image(path, &s->taken.photo, &options);
    if (status == EXIT_DONE && refocus_photo_write_depth(path, path, &depth, &reason) != REFOCUS_OK)
        status = report_failure(EXIT_FAILED, s->work->name, "%s", reason.text);
    return serve_take_back(status, path, bytes);
}

void serve_answer_live_frame(struct serving *s, const struct rf_web_ask *ask, const char *bytes)
{
    if (!s->feed) {
        report_failure(EXIT_WRONG, s->work->name, "it is a photo; ask for pictures");
        answer_failure(s, ANSWER_WRONG);
    } else if (s->frame <= ask->after && take(s, NEWER_MS) != EXIT_DONE) {
        answer_failure(s, ANSWER_FAILED);
    } else {
        answer_frame(s->frame);
        serve_answer_overlay(s, ask, bytes);
    }
}
