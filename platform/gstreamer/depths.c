/* depths.c: a map comes from a file or a buffer, becomes disparities, and is kept from flickering.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "depths.h"
#include "frame.h"

static bool reserve(struct rf_gst_depths *depths, int32_t width, int32_t height)
{
    const uint64_t samples = (uint64_t)width * (uint64_t)height;

    if (samples > depths->samples) {
        free(depths->own);
        depths->own = samples <= SIZE_MAX / 2 ? malloc((size_t)samples * 2) : NULL;
        depths->samples = depths->own ? (size_t)samples : 0;
    }
    return depths->own != NULL;
}

static void use_own(struct rf_gst_depths *depths, int32_t width, int32_t height)
{
    depths->disparity = refocus_disparity16(depths->own, width, height, (ptrdiff_t)width * 2);
}

static void let_go(struct rf_gst_depths *depths)
{
    if (depths->mapped)
        gst_video_frame_unmap(&depths->frame);
    depths->mapped = false;
}

/* Says which of the words for samples is not known. */
static int refuse_words(const struct rf_gst_settings *settings, struct refocus_reason *reason)
{
    struct refocus_depth_map map = refocus_depth_map_default();

    if (refocus_depth_set_invalid(&map, settings->invalid) != REFOCUS_OK)
        snprintf(reason->text, sizeof reason->text,
                 "invalid '%.60s' is not known; give zero, max or numbers, up to %d, with commas",
                 settings->invalid, REFOCUS_DEPTH_MOST_UNKNOWN);
    else
        snprintf(reason->text, sizeof reason->text,
                 "depth-unit '%.60s' is not known; give disparity, disparity/16, inverse, mm, m, "
                 "or a number per metre such as 5000/m",
                 settings->depth_unit);
    return REFOCUS_ERR_ARGUMENT;
}

int rf_gst_depths_read(struct rf_gst_depths *depths, const struct rf_gst_settings *settings,
                       struct refocus_reason *reason)
{
    struct refocus_depth_report report = refocus_depth_report_default();
    struct refocus_photo *file;
    int status = refocus_depth_read(&file, settings->depth_location, settings->depth_unit,
                                    settings->near_m, settings->far_m, NULL, reason);

    if (status != REFOCUS_OK)
        return status;
    if (refocus_depth_set_invalid(file->depth, settings->invalid) != REFOCUS_OK)
        status = refuse_words(settings, reason);
    else
        status = reserve(depths, file->depth->width, file->depth->height) ? REFOCUS_OK
                                                                          : REFOCUS_ERR_MEMORY;
    if (status == REFOCUS_OK)
        status = refocus_depth_to_disparity(file->depth, depths->own,
                                            (ptrdiff_t)file->depth->width * 2, &report);
    if (status == REFOCUS_OK) {
        use_own(depths, file->depth->width, file->depth->height);
        depths->range = (struct refocus_depth_range){report.near_m, report.far_m};
        depths->known = depths->still = true;
    } else if (reason->text[0] == '\0') {
        snprintf(reason->text, sizeof reason->text, "%s", refocus_strerror(status));
    }
    refocus_photo_free(&file);
    return status;
}

static bool is_disparity(const char *unit)
{
    return !unit || strcmp(unit, "disparity") == 0;
}

/* Makes a map of a frame by the settings; false: one of their words is not known. */
static bool describe(const GstVideoFrame *frame, const struct rf_gst_settings *settings,
                     struct refocus_depth_map *map)
{
    *map = refocus_depth_map_default();
    map->sample = GST_VIDEO_FRAME_FORMAT(frame) == GST_VIDEO_FORMAT_GRAY8 ? REFOCUS_SAMPLE_U8
                                                                          : REFOCUS_SAMPLE_U16;
    map->samples = GST_VIDEO_FRAME_PLANE_DATA(frame, 0);
    map->stride = GST_VIDEO_FRAME_PLANE_STRIDE(frame, 0);
    map->width = GST_VIDEO_FRAME_WIDTH(frame);
    map->height = GST_VIDEO_FRAME_HEIGHT(frame);
    return refocus_depth_set_unit(map, settings->depth_unit ? settings->depth_unit : "disparity") ==
               REFOCUS_OK &&
           refocus_depth_set_invalid(map, settings->invalid) == REFOCUS_OK;
}

/* Whether a map has a sample that holds a value. */
static bool has_reading(const struct refocus_depth_map *map)
{
    const bool bytes = map->sample == REFOCUS_SAMPLE_U8;

    for (int y = 0; y < map->height; y++) {
        const uint8_t *const row = (const uint8_t *)map->samples + y * map->stride;

        for (int x = 0; x < map->width; x++) {
            uint16_t v = row[x];

            if (!bytes)
                memcpy(&v, row + 2 * (size_t)x, sizeof v);
            if (!refocus_depth_is_code(map, v))
                return true;
        }
    }
    return false;
}

int rf_gst_depths_hold(struct rf_gst_depths *depths, const struct rf_gst_settings *settings,
                       GstBuffer *buffer, const GstVideoInfo *info, GstClockTime time)
{
    struct refocus_depth_map map;
    GstVideoFrame frame;

    if (!rf_gst_frame_map(&frame, info, buffer, GST_MAP_READ))
        return REFOCUS_ERR_FORMAT;
    if (describe(&frame, settings, &map)) {
        refocus_depth_follow_flags(&map, &depths->flags);
        map.flags |= depths->flags;
        if (!has_reading(&map)) {
            gst_video_frame_unmap(&frame);
            return REFOCUS_ERR_NO_DEPTH;
        }
    }
    let_go(depths);
    depths->frame = frame;
    depths->mapped = depths->known = depths->fresh = true;
    depths->still = false;
    depths->time = time;
    return REFOCUS_OK;
}

/* The samples where they lie if they are disparities, else disparities made of them. */
static int convert(struct rf_gst_depths *depths, const struct rf_gst_settings *settings,
                   struct refocus_reason *reason)
{
    struct refocus_depth_map map;

    if (!describe(&depths->frame, settings, &map))
        return refuse_words(settings, reason);
    if (is_disparity(settings->depth_unit) && !map.flags) {
        depths->disparity =
            map.sample == REFOCUS_SAMPLE_U8
                ? refocus_disparity8(map.samples, map.width, map.height, map.stride)
                : refocus_disparity16(map.samples, map.width, map.height, map.stride);
        return REFOCUS_OK;
    }
    map.flags |= depths->flags;
    map.near_m = settings->near_m;
    map.far_m = settings->far_m;
    if (map.meaning == REFOCUS_DEPTH_DISTANCE && !(map.near_m > 0 && map.far_m > map.near_m)) {
        snprintf(reason->text, sizeof reason->text,
                 "depth in %.60s needs the metres between which it lies: give near and far",
                 settings->depth_unit);
        return REFOCUS_ERR_ARGUMENT;
    }
    if (!reserve(depths, map.width, map.height))
        return REFOCUS_ERR_MEMORY;
    use_own(depths, map.width, map.height);
    return refocus_depth_to_disparity(&map, depths->own, (ptrdiff_t)map.width * 2, NULL);
}

static int fit_filter(struct rf_gst_depths *depths, double strength)
{
    const int32_t width = depths->disparity.width, height = depths->disparity.height;
    struct refocus_temporal_params params = refocus_temporal_params_default(width, height);

    if (depths->filter && depths->filter_width == width && depths->filter_height == height &&
        depths->filter_strength == strength)
        return REFOCUS_OK;
    refocus_temporal_destroy(&depths->filter);
    params.strength = (float)strength;
    depths->filter_width = width;
    depths->filter_height = height;
    depths->filter_strength = strength;
    return refocus_temporal_create(&depths->filter, &params);
}

static int calm(struct rf_gst_depths *depths, double strength, const struct refocus_image *photo)
{
    const struct refocus_disparity map = depths->disparity;
    int status = fit_filter(depths, strength);

    if (status != REFOCUS_OK)
        return status;
    /* Depth that is older by more than a second shows another moment. */
    if (GST_CLOCK_TIME_IS_VALID(depths->time) && GST_CLOCK_TIME_IS_VALID(depths->filter_time) &&
        (depths->time < depths->filter_time || depths->time - depths->filter_time > GST_SECOND))
        refocus_temporal_reset(depths->filter);
    depths->filter_time = depths->time;
    if (!reserve(depths, map.width, map.height))
        return REFOCUS_ERR_MEMORY;
    use_own(depths, map.width, map.height);
    return refocus_temporal_run(depths->filter, photo, &map, depths->own, depths->disparity.stride);
}

int rf_gst_depths_use(struct rf_gst_depths *depths, const struct rf_gst_settings *settings,
                      const struct refocus_image *photo, struct refocus_reason *reason)
{
    int status = REFOCUS_OK;

    if (depths->still)
        return REFOCUS_OK;
    if (depths->fresh || is_disparity(settings->depth_unit))
        depths->range = (struct refocus_depth_range){settings->near_m, settings->far_m};
    if (!depths->fresh)
        return REFOCUS_OK;
    status = convert(depths, settings, reason);
    if (status == REFOCUS_OK && settings->steady > 0)
        status = calm(depths, settings->steady, photo);
    depths->fresh = status != REFOCUS_OK;
    return status;
}

/* Whether one of two shapes is wider than the other by more than an eighth. */
static bool differ(guint64 width, guint64 height, guint64 other_width, guint64 other_height)
{
    const guint64 wide = width * other_height, high = height * other_width;

    return 8 * wide > 9 * high || 8 * high > 9 * wide;
}

bool rf_gst_depths_are_stretched(const struct rf_gst_depths *depths, const GstVideoInfo *info)
{
    enum { FEWEST = 16 }; /* the shape of fewer samples says nothing */
    const struct refocus_disparity *const map = &depths->disparity;
    const guint64 width = (guint64)GST_VIDEO_INFO_WIDTH(info);
    const guint64 height = (guint64)GST_VIDEO_INFO_HEIGHT(info);

    if (MIN(map->width, map->height) < FEWEST || MIN(width, height) < FEWEST ||
        map->width == map->height)
        return false;
    return differ((guint64)map->width, (guint64)map->height, width, height) &&
           differ((guint64)map->width, (guint64)map->height,
                  width * (guint64)GST_VIDEO_INFO_PAR_N(info),
                  height * (guint64)GST_VIDEO_INFO_PAR_D(info));
}

void rf_gst_depths_forget(struct rf_gst_depths *depths)
{
    let_go(depths);
    depths->known = depths->still;
    depths->flags = 0;
    depths->time = depths->filter_time = GST_CLOCK_TIME_NONE;
    refocus_temporal_reset(depths->filter);
}

void rf_gst_depths_end(struct rf_gst_depths *depths)
{
    let_go(depths);
    refocus_temporal_destroy(&depths->filter);
    free(depths->own);
    memset(depths, 0, sizeof *depths);
    depths->time = depths->filter_time = GST_CLOCK_TIME_NONE;
}
