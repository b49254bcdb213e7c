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

int rf_gst_depths_read(struct rf_gst_depths *depths, const struct rf_gst_settings *settings,
                       struct refocus_reason *reason)
{
    struct refocus_depth_report report = refocus_depth_report_default();
    struct refocus_photo *file;
    int status = refocus_depth_read(&file, settings->depth_location, settings->depth_unit,
                                    settings->near_m, settings->far_m, NULL, reason);

    if (status != REFOCUS_OK)
        return status;
    status =
        reserve(depths, file->depth->width, file->depth->height) ? REFOCUS_OK : REFOCUS_ERR_MEMORY;
    if (status == REFOCUS_OK)
        status = refocus_depth_to_disparity(file->depth, depths->own,
                                            (ptrdiff_t)file->depth->width * 2, &report);
    if (status == REFOCUS_OK) {
        use_own(depths, file->depth->width, file->depth->height);
        depths->range = (struct refocus_depth_range){report.near_m, report.far_m};
        depths->known = depths->still = true;
    } else {
        snprintf(reason->text, sizeof reason->text, "%s", refocus_strerror(status));
    }
    refocus_photo_free(&file);
    return status;
}

static bool is_disparity(const char *unit)
{
    return !unit || strcmp(unit, "disparity") == 0;
}

static bool is_distance(const char *unit)
{
    struct refocus_depth_map map = refocus_depth_map_default();

    return !is_disparity(unit) && refocus_depth_set_unit(&map, unit) == REFOCUS_OK &&
           map.meaning == REFOCUS_DEPTH_DISTANCE;
}

/* Whether a map of distances has a sample other than 0, which is no value. */
static bool has_reading(const GstVideoFrame *frame)
{
    const size_t row = (size_t)GST_VIDEO_FRAME_COMP_WIDTH(frame, 0) *
                       (size_t)GST_VIDEO_FRAME_COMP_PSTRIDE(frame, 0);

    for (int y = 0; y < GST_VIDEO_FRAME_HEIGHT(frame); y++) {
        const uint8_t *const bytes = (const uint8_t *)GST_VIDEO_FRAME_PLANE_DATA(frame, 0) +
                                     (ptrdiff_t)y * GST_VIDEO_FRAME_PLANE_STRIDE(frame, 0);

        for (size_t i = 0; i < row; i++)
            if (bytes[i])
                return true;
    }
    return false;
}

int rf_gst_depths_hold(struct rf_gst_depths *depths, const struct rf_gst_settings *settings,
                       GstBuffer *buffer, const GstVideoInfo *info, GstClockTime time)
{
    GstVideoFrame frame;

    if (!rf_gst_frame_map(&frame, info, buffer, GST_MAP_READ))
        return REFOCUS_ERR_FORMAT;
    if (is_distance(settings->depth_unit) && !has_reading(&frame)) {
        gst_video_frame_unmap(&frame);
        return REFOCUS_ERR_NO_DEPTH;
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
    const int32_t width = GST_VIDEO_FRAME_WIDTH(&depths->frame);
    const int32_t height = GST_VIDEO_FRAME_HEIGHT(&depths->frame);
    const ptrdiff_t stride = GST_VIDEO_FRAME_PLANE_STRIDE(&depths->frame, 0);
    const void *const samples = GST_VIDEO_FRAME_PLANE_DATA(&depths->frame, 0);
    const bool bytes = GST_VIDEO_FRAME_FORMAT(&depths->frame) == GST_VIDEO_FORMAT_GRAY8;
    struct refocus_depth_map map = refocus_depth_map_default();

    if (is_disparity(settings->depth_unit)) {
        depths->disparity = bytes ? refocus_disparity8(samples, width, height, stride)
                                  : refocus_disparity16(samples, width, height, stride);
        return REFOCUS_OK;
    }
    map.sample = bytes ? REFOCUS_SAMPLE_U8 : REFOCUS_SAMPLE_U16;
    map.samples = samples;
    map.stride = stride;
    map.width = width;
    map.height = height;
    map.near_m = settings->near_m;
    map.far_m = settings->far_m;
    if (refocus_depth_set_unit(&map, settings->depth_unit) != REFOCUS_OK) {
        snprintf(reason->text, sizeof reason->text,
                 "depth-unit '%.60s' is not known; give disparity, inverse, mm, m, or a number per "
                 "metre such as 5000/m",
                 settings->depth_unit);
        return REFOCUS_ERR_ARGUMENT;
    }
    if (map.meaning == REFOCUS_DEPTH_DISTANCE && !(map.near_m > 0 && map.far_m > map.near_m)) {
        snprintf(reason->text, sizeof reason->text,
                 "depth in %.60s needs the metres between which it lies: give near and far",
                 settings->depth_unit);
        return REFOCUS_ERR_ARGUMENT;
    }
    if (!reserve(depths, width, height))
        return REFOCUS_ERR_MEMORY;
    use_own(depths, width, height);
    return refocus_depth_to_disparity(&map, depths->own, (ptrdiff_t)width * 2, NULL);
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

void rf_gst_depths_forget(struct rf_gst_depths *depths)
{
    let_go(depths);
    depths->known = depths->still;
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
