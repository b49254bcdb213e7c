/* strips.c: the disparities of a photo that is rendered in strips are made in little memory. The
 * renderer takes them at the photo's size then, and does not copy them. */
#include <math.h>
#include <stdlib.h>
#include "inputs/matte.h"
#include "line/report.h"
#include "outputs/resize.h"
#include "shot/strips.h"

/* Placing edges takes some 30 bytes a pixel: 120 MB for this many. */
enum { MOST_PIXELS = 4000000 };

/* The option that does not go with strips, or NULL. */
static const char *conflict_of(const struct engine_settings *engine,
                               const struct depth_settings *depth, bool behind)
{
    if (behind)
        return "--behind";
    if (depth->matte && !matte_is_none(depth->matte))
        return "--matte";
    return engine->fill == FILL_TEXTURED ? "--fill textured" : NULL;
}

static bool needs_whole_photo(const struct engine_settings *engine)
{
    return refocus_method_traits((uint32_t)engine->method) & REFOCUS_METHOD_WHOLE_PHOTO;
}

int strips_check(const struct engine_settings *engine, struct depth_settings *depth, bool behind)
{
    const char *conflict = conflict_of(engine, depth, behind);

    if (needs_whole_photo(engine))
        return report_failure(EXIT_WRONG, "--low-memory",
                              "method %s needs the whole photo; leave one out",
                              refocus_method_name((uint32_t)engine->method));
    if (conflict)
        return report_failure(EXIT_WRONG, "--low-memory", "it does not go with %s; leave one out",
                              conflict);
    depth->matte = "none";
    depth->deep = DEEP_NONE;
    depth->light = false;
    return EXIT_DONE;
}

bool strips_suit(const struct engine_settings *engine, const struct depth_settings *depth,
                 bool behind)
{
    return !engine->in_strips && !needs_whole_photo(engine) && !conflict_of(engine, depth, behind);
}

struct work {
    const struct engine_settings *engine;
    const struct input *input;
};

static uint16_t *new_map(const struct refocus_image *photo)
{
    const uint64_t bytes = (uint64_t)photo->width * (uint64_t)photo->height * sizeof(uint16_t);

    return bytes <= SIZE_MAX ? malloc((size_t)bytes) : NULL;
}

static struct refocus_disparity map_of(const uint16_t *samples, int width, int height)
{
    return refocus_disparity16(samples, width, height, (ptrdiff_t)width * 2);
}

static int upsample(const struct work *work, const struct refocus_image *photo,
                    const struct refocus_disparity *map, const uint8_t *confidence, uint16_t *out)
{
    struct refocus_upsample_params params = refocus_upsample_params_default();

    params.threads = (int32_t)work->engine->threads;
    params.cpu = (uint32_t)work->engine->cpu;
    params.confidence = confidence;
    params.confidence_stride = confidence ? map->width : 0;
    return refocus_upsample(photo, map, &params, out, (ptrdiff_t)photo->width * 2);
}

/* Put the edges of the map where the photo has them, at the size of the photo. */
static int place(const struct work *work, const struct refocus_image *photo, uint16_t *out,
                 struct refocus_depth_edges_report *report)
{
    const uint8_t *confidence = input_confidence(work->input);
    struct refocus_depth_edges_params params = refocus_depth_edges_params_default();
    struct refocus_disparity map =
        map_of(work->input->disparity, work->input->width, work->input->height);
    uint16_t *sure = NULL;
    int status = REFOCUS_OK;

    params.threads = (int32_t)work->engine->threads;
    params.cpu = (uint32_t)work->engine->cpu;
    if (confidence) { /* samples that were filled count least */
        sure = new_map(photo);
        status = sure ? upsample(work, photo, &map, confidence, sure) : REFOCUS_ERR_MEMORY;
        map = map_of(sure, photo->width, photo->height);
    }
    if (status == REFOCUS_OK)
        status =
            refocus_depth_edges(photo, &map, &params, out, (ptrdiff_t)photo->width * 2, report);
    free(sure);
    return status;
}

/* Place edges on a smaller picture of the photo. */
static int place_small(const struct work *work, const struct refocus_image *photo, int times,
                       uint16_t *out, struct refocus_depth_edges_report *report)
{
    const int width = (photo->width + times - 1) / times;
    const int height = (photo->height + times - 1) / times;
    struct refocus_image small;
    int status = resize_image(photo, width, height, &small);
    uint16_t *placed;
    struct refocus_disparity map;

    if (status != REFOCUS_OK)
        return status;
    placed = new_map(&small);
    status = placed ? place(work, &small, placed, report) : REFOCUS_ERR_MEMORY;
    free(small.plane[0]);
    map = map_of(placed, width, height);
    if (status == REFOCUS_OK)
        status = upsample(work, photo, &map, NULL, out);
    free(placed);
    return status;
}

int strips_disparity(const struct input *input, bool places_edges,
                     const struct engine_settings *engine, uint16_t **full,
                     struct refocus_depth_edges_report *report)
{
    const struct refocus_image *photo = input->photo->image;
    const struct work work = {engine, input};
    const struct refocus_disparity map = map_of(input->disparity, input->width, input->height);
    const int times =
        (int)ceil(sqrt((double)photo->width * (double)photo->height / (double)MOST_PIXELS));
    int status = REFOCUS_ERR_MEMORY;

    *full = new_map(photo);
    *report = refocus_depth_edges_report_default();
    if (*full && !places_edges)
        status = upsample(&work, photo, &map, input_confidence(input), *full);
    else if (*full && times > 1)
        status = place_small(&work, photo, times, *full, report);
    else if (*full)
        status = place(&work, photo, *full, report);
    if (status == REFOCUS_OK)
        return EXIT_DONE;
    free(*full);
    *full = NULL;
    return report_failure(EXIT_FAILED, input->depth_name, "the depth map: %s",
                          refocus_strerror(status));
}
