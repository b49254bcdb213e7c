/* aggregate.c: each frame gets its depth by time, is refocused, and goes on. */
#include <string.h>
#include "element.h"

static GstClockTime running_time(GstAggregatorPad *pad, GstBuffer *buffer)
{
    GstClockTime time = GST_BUFFER_PTS(buffer);

    if (GST_CLOCK_TIME_IS_VALID(time))
        time = gst_segment_to_running_time(&pad->segment, GST_FORMAT_TIME, time);
    return time;
}

/* A GAP event reaches us as a buffer without memory. */
static bool is_gap(GstBuffer *buffer)
{
    return GST_BUFFER_FLAG_IS_SET(buffer, GST_BUFFER_FLAG_GAP) && gst_buffer_get_size(buffer) == 0;
}

static GstClockTime apart(GstClockTime a, GstClockTime b)
{
    return a > b ? a - b : b - a;
}

/* Whether a map that waits goes better with a frame than the one that is held. Without times each
 * frame takes the next map. */
static bool is_better(const struct rf_gst_depths *depths, GstClockTime next, GstClockTime frame)
{
    if (!depths->known || depths->still || !GST_CLOCK_TIME_IS_VALID(next) ||
        !GST_CLOCK_TIME_IS_VALID(frame) || !GST_CLOCK_TIME_IS_VALID(depths->time))
        return true;
    return next <= frame || apart(next, frame) < apart(depths->time, frame);
}

/* Without a clock that presses, the next map is waited for: it may be nearer, and the same files
 * make the same bytes. With one, a map within half a frame will do. */
static bool has_to_wait(GstRefocus *element, GstClockTime frame)
{
    const struct rf_gst_depths *const depths = &element->depths;
    const GstVideoInfo *const info = &element->info;
    GstClockTime half = GST_SECOND / 60;

    if (!GST_CLOCK_TIME_IS_VALID(gst_aggregator_get_latency(&element->parent)))
        return true;
    if (GST_VIDEO_INFO_FPS_N(info) > 0)
        half = gst_util_uint64_scale(GST_SECOND / 2, (guint64)GST_VIDEO_INFO_FPS_D(info),
                                     (guint64)GST_VIDEO_INFO_FPS_N(info));
    return !depths->known || depths->still || !GST_CLOCK_TIME_IS_VALID(depths->time) ||
           !GST_CLOCK_TIME_IS_VALID(frame) || apart(depths->time, frame) > half;
}

static GstFlowReturn fail(GstRefocus *element, const char *what)
{
    GST_ELEMENT_ERROR(element, STREAM, FAILED, ("%s", what), (NULL));
    return GST_FLOW_ERROR;
}

/* Says what one buffer lacks; a stream that runs for weeks does not end by it. */
static void warn(GstRefocus *element, const char *what)
{
    GST_ELEMENT_WARNING(element, STREAM, FORMAT, ("%s", what), (NULL));
}

/* The next map. One that was flushed away is forgotten here, as flushes come from other threads:
 * what comes behind a flush is seen after it. */
static GstBuffer *peek_depth(GstRefocus *element, GstAggregatorPad *pad)
{
    GstBuffer *const next = gst_aggregator_pad_peek_buffer(pad);

    if (g_atomic_int_compare_and_exchange(&element->flushed, 1, 0))
        rf_gst_depths_forget(&element->depths);
    return next;
}

/* Hold a map; false: it says nothing, and the one before it stays. */
static bool hold(GstRefocus *element, GstBuffer *map, GstClockTime time)
{
    int status;

    GST_OBJECT_LOCK(element);
    status =
        rf_gst_depths_hold(&element->depths, &element->settings, map, &element->depth_info, time);
    GST_OBJECT_UNLOCK(element);
    if (status == REFOCUS_ERR_NO_DEPTH)
        warn(element, "a depth map is left out: not one of its samples holds a value");
    else if (status != REFOCUS_OK)
        warn(element, "a depth map is left out: its buffer is no picture of its caps");
    return status == REFOCUS_OK;
}

/* Take the maps of the pad up to the one that is nearest to the frame: OK when that is held,
 * NEED_DATA when it may still come. */
static GstFlowReturn pair(GstRefocus *element, GstAggregatorPad *pad, GstClockTime frame,
                          gboolean timeout)
{
    struct rf_gst_depths *const depths = &element->depths;
    GstBuffer *next;

    while ((next = peek_depth(element, pad))) {
        const GstClockTime time = running_time(pad, next);

        if (!is_gap(next) && !is_better(depths, time, frame)) {
            gst_buffer_unref(next);
            return GST_FLOW_OK;
        }
        gst_aggregator_pad_drop_buffer(pad);
        if (!is_gap(next) && !hold(element, next, time)) {
            gst_buffer_unref(next);
            continue;
        }
        gst_buffer_unref(next);
        if (!GST_CLOCK_TIME_IS_VALID(time) || !GST_CLOCK_TIME_IS_VALID(frame))
            return GST_FLOW_OK;
    }
    if (gst_aggregator_pad_is_eos(pad) || timeout || !has_to_wait(element, frame))
        return GST_FLOW_OK;
    return GST_AGGREGATOR_FLOW_NEED_DATA;
}

static GstFlowReturn find_depth(GstRefocus *element, GstClockTime frame, gboolean timeout)
{
    GstFlowReturn flow = GST_FLOW_OK;
    GstAggregatorPad *pad;

    GST_OBJECT_LOCK(element);
    pad = element->depth ? gst_object_ref(element->depth) : NULL;
    GST_OBJECT_UNLOCK(element);
    if (pad)
        flow = pair(element, pad, frame, timeout);
    if (flow == GST_FLOW_OK && !element->depths.known && !pad)
        flow = fail(element, "no depth: link the pad depth, or give depth-location");
    else if (flow == GST_FLOW_OK && !element->depths.known && gst_aggregator_pad_is_eos(pad))
        flow = fail(element, "the pad depth ended without a depth map");
    gst_clear_object(&pad);
    return flow;
}

static bool comes_too_late(GstRefocus *element, GstClockTime time)
{
    bool late;

    GST_OBJECT_LOCK(element);
    late = element->settings.qos && GST_CLOCK_TIME_IS_VALID(time) &&
           GST_CLOCK_TIME_IS_VALID(element->earliest) && time <= element->earliest;
    GST_OBJECT_UNLOCK(element);
    return late;
}

static void leave_out(GstRefocus *element, GstBuffer *frame, GstClockTime time)
{
    GstMessage *message;

    element->dropped++;
    message = gst_message_new_qos(
        GST_OBJECT_CAST(element), FALSE, time,
        gst_segment_to_stream_time(&element->sink->segment, GST_FORMAT_TIME, GST_BUFFER_PTS(frame)),
        GST_BUFFER_PTS(frame), GST_BUFFER_DURATION(frame));
    gst_message_set_qos_stats(message, GST_FORMAT_BUFFERS, element->rendered, element->dropped);
    gst_element_post_message(GST_ELEMENT_CAST(element), message);
}

/* Times, flags and metas stay those of the frame, but for what says how its memory is laid out. */
static gboolean copy_meta(GstBuffer *from, GstMeta **meta, gpointer user)
{
    const GstMetaInfo *const info = (*meta)->info;
    GstMetaTransformCopy whole = {FALSE, 0, (gsize)-1};

    if (info->transform_func &&
        !gst_meta_api_type_has_tag(info->api,
                                   g_quark_from_static_string(GST_META_TAG_MEMORY_STR)) &&
        !gst_meta_api_type_has_tag(info->api, g_quark_from_static_string("memory-reference")))
        info->transform_func(user, *meta, from, g_quark_from_static_string("gst-copy"), &whole);
    return TRUE;
}

static GstBuffer *new_frame(GstRefocus *element, GstBuffer *frame)
{
    GstBufferPool *pool = gst_aggregator_get_buffer_pool(&element->parent);
    GstBuffer *out = NULL;

    if (pool && gst_buffer_pool_set_active(pool, TRUE))
        gst_buffer_pool_acquire_buffer(pool, &out, NULL);
    gst_clear_object(&pool);
    if (out) {
        gst_buffer_copy_into(out, frame, GST_BUFFER_COPY_FLAGS | GST_BUFFER_COPY_TIMESTAMPS, 0, -1);
        gst_buffer_foreach_meta(frame, copy_meta, out);
    }
    return out;
}

static int render_by(GstRefocus *element, const struct rf_gst_settings *settings, GstClockTime time,
                     const struct refocus_image *photo, const struct refocus_image *picture,
                     struct refocus_reason *reason)
{
    int status = rf_gst_depths_use(&element->depths, settings, photo, reason);

    if (status == REFOCUS_OK)
        status = rf_gst_shot_take(&element->shot, settings, &element->depths, time, photo, picture,
                                  reason);
    if (status != REFOCUS_OK && reason->text[0] == '\0')
        g_snprintf(reason->text, sizeof reason->text, "%s", refocus_strerror(status));
    return status;
}

/* Properties that change while frames come are no unit: `near` is set before `far`. By what cannot
 * be rendered, the settings of the last frame hold. */
static int render_by_last(GstRefocus *element, GstClockTime time, const struct refocus_image *photo,
                          const struct refocus_image *picture, struct refocus_reason *reason)
{
    if (strcmp(reason->text, element->refused.text) != 0) {
        GST_ELEMENT_WARNING(element, LIBRARY, SETTINGS,
                            ("%s; frames are rendered by the settings before", reason->text),
                            (NULL));
        element->refused = *reason;
    }
    return render_by(element, &element->used, time, photo, picture, reason);
}

/* The library's part: pictures in the memory of both buffers. */
static int render(GstRefocus *element, GstClockTime time, GstVideoFrame *in, GstVideoFrame *out,
                  struct refocus_reason *reason)
{
    struct rf_gst_settings settings;
    struct refocus_image photo, picture;
    int status;

    if (!rf_gst_picture(in, &element->chroma_in, &photo) ||
        !rf_gst_picture(out, &element->chroma_out, &picture))
        return REFOCUS_ERR_MEMORY;
    GST_OBJECT_LOCK(element);
    rf_gst_settings_copy(&settings, &element->settings);
    GST_OBJECT_UNLOCK(element);
    status = render_by(element, &settings, time, &photo, &picture, reason);
    if (status == REFOCUS_OK) {
        rf_gst_settings_end(&element->used);
        element->used = settings;
        element->refused.text[0] = '\0';
        return REFOCUS_OK;
    }
    rf_gst_settings_end(&settings);
    return element->rendered ? render_by_last(element, time, &photo, &picture, reason) : status;
}

/* Once, until there is a blur that the method can have. */
static void tell_limit(GstRefocus *element)
{
    if (element->shot.limited && !element->limited)
        GST_ELEMENT_WARNING(element, LIBRARY, SETTINGS,
                            ("the blur asked for is more than the method %s can have, %d pixels",
                             refocus_method_name((uint32_t)element->used.method),
                             (int)element->shot.made.max_blur_radius),
                            (NULL));
    element->limited = element->shot.limited;
}

/* Once, until there is a map of the shape of frames. */
static void tell_shape(GstRefocus *element)
{
    const struct refocus_disparity *const map = &element->depths.disparity;
    const bool stretched = rf_gst_depths_are_stretched(&element->depths, &element->info);

    if (stretched && !element->stretched)
        GST_ELEMENT_WARNING(element, STREAM, FORMAT,
                            ("the depth of %dx%d samples is stretched to the shape of frames, "
                             "%dx%d; give depth of these frames, as upright as they are",
                             (int)map->width, (int)map->height,
                             GST_VIDEO_INFO_WIDTH(&element->info),
                             GST_VIDEO_INFO_HEIGHT(&element->info)),
                            (NULL));
    element->stretched = stretched;
}

static GstFlowReturn refocus(GstRefocus *element, GstBuffer *buffer, GstClockTime time)
{
    GstBuffer *const result = new_frame(element, buffer);
    struct refocus_reason reason = {""};
    GstVideoFrame in, out;
    int status;

    if (!result)
        return GST_FLOW_FLUSHING;
    if (!rf_gst_frame_map(&in, &element->info, buffer, GST_MAP_READ)) {
        gst_buffer_unref(result);
        warn(element, "a frame is left out: its buffer is no picture of its caps");
        leave_out(element, buffer, time);
        return GST_FLOW_OK;
    }
    if (!rf_gst_frame_map(&out, &element->info, result, GST_MAP_WRITE)) {
        gst_video_frame_unmap(&in);
        gst_buffer_unref(result);
        return fail(element, "the memory for frames cannot be written");
    }
    status = render(element, time, &in, &out, &reason);
    gst_video_frame_unmap(&out);
    gst_video_frame_unmap(&in);
    if (status != REFOCUS_OK) {
        gst_buffer_unref(result);
        return fail(element, reason.text[0] ? reason.text : refocus_strerror(status));
    }
    tell_limit(element);
    tell_shape(element);
    element->rendered++;
    return gst_aggregator_finish_buffer(&element->parent, result);
}

GstFlowReturn rf_gst_aggregate(GstAggregator *aggregator, gboolean timeout)
{
    GstRefocus *const element = (GstRefocus *)aggregator;
    GstAggregatorPad *const sink = element->sink;
    GstBuffer *const frame = gst_aggregator_pad_peek_buffer(sink);
    GstFlowReturn flow = GST_FLOW_OK;
    GstClockTime time, stream_time;

    if (!frame)
        return gst_aggregator_pad_is_eos(sink) ? GST_FLOW_EOS : GST_AGGREGATOR_FLOW_NEED_DATA;
    time = running_time(sink, frame);
    if (!is_gap(frame))
        flow = find_depth(element, time, timeout);
    if (flow != GST_AGGREGATOR_FLOW_NEED_DATA)
        gst_aggregator_pad_drop_buffer(sink);
    if (flow == GST_FLOW_OK && !is_gap(frame)) {
        gst_aggregator_selected_samples(aggregator, GST_BUFFER_PTS(frame), GST_BUFFER_DTS(frame),
                                        GST_BUFFER_DURATION(frame), NULL);
        stream_time =
            gst_segment_to_stream_time(&sink->segment, GST_FORMAT_TIME, GST_BUFFER_PTS(frame));
        if (GST_CLOCK_TIME_IS_VALID(stream_time))
            gst_object_sync_values(GST_OBJECT_CAST(element), stream_time);
        /* Live and no depth yet: as a camera that has not begun. */
        if (!element->depths.known || comes_too_late(element, time))
            leave_out(element, frame, time);
        else
            flow = refocus(element, frame, time);
    }
    gst_buffer_unref(frame);
    return flow;
}
