/* element.c: the class of the element `refocus`: its pads, states, events and queries. */
#include "element.h"

GST_DEBUG_CATEGORY(rf_gst_debug);

#define PROGRESSIVE ", interlace-mode = progressive"
#define VIDEO_CAPS                                                                                 \
    GST_VIDEO_CAPS_MAKE("{ " RF_GST_FORMATS_YUV ", " RF_GST_FORMATS_RGB ", " RF_GST_FORMATS_DEEP   \
                        " }")                                                                      \
    PROGRESSIVE

static GstStaticPadTemplate sink_template =
    GST_STATIC_PAD_TEMPLATE("sink", GST_PAD_SINK, GST_PAD_ALWAYS, GST_STATIC_CAPS(VIDEO_CAPS));
static GstStaticPadTemplate source_template =
    GST_STATIC_PAD_TEMPLATE("src", GST_PAD_SRC, GST_PAD_ALWAYS, GST_STATIC_CAPS(VIDEO_CAPS));
static GstStaticPadTemplate depth_template = GST_STATIC_PAD_TEMPLATE(
    "depth", GST_PAD_SINK, GST_PAD_REQUEST,
    GST_STATIC_CAPS(GST_VIDEO_CAPS_MAKE("{ " GST_VIDEO_NE(GRAY16) ", GRAY8 }") PROGRESSIVE));

G_DEFINE_TYPE(GstRefocus, rf_gst_element, GST_TYPE_AGGREGATOR)

static void set_property(GObject *object, guint id, const GValue *value, GParamSpec *spec)
{
    GstRefocus *const element = (GstRefocus *)object;

    if (!rf_gst_settings_have(id)) {
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, spec);
        return;
    }
    GST_OBJECT_LOCK(element);
    rf_gst_settings_set(&element->settings, id, value);
    GST_OBJECT_UNLOCK(element);
}

static void get_property(GObject *object, guint id, GValue *value, GParamSpec *spec)
{
    GstRefocus *const element = (GstRefocus *)object;

    if (!rf_gst_settings_have(id)) {
        G_OBJECT_WARN_INVALID_PROPERTY_ID(object, id, spec);
        return;
    }
    GST_OBJECT_LOCK(element);
    rf_gst_settings_get(&element->settings, id, value);
    GST_OBJECT_UNLOCK(element);
}

static GstAggregatorPad *create_new_pad(GstAggregator *aggregator, GstPadTemplate *template,
                                        const gchar *name, const GstCaps *caps)
{
    GstRefocus *const element = (GstRefocus *)aggregator;
    GstAggregatorPad *pad = NULL;

    (void)name;
    (void)caps;
    GST_OBJECT_LOCK(element);
    if (!element->depth) {
        pad = g_object_new(GST_TYPE_AGGREGATOR_PAD, "name", "depth", "direction", GST_PAD_SINK,
                           "template", template, NULL);
        element->depth = gst_object_ref(pad);
    }
    GST_OBJECT_UNLOCK(element);
    if (!pad)
        GST_WARNING_OBJECT(element, "there is one pad depth, and it is taken");
    return pad;
}

static void release_pad(GstElement *gst_element, GstPad *pad)
{
    GstRefocus *const element = (GstRefocus *)gst_element;
    GstAggregatorPad *depth;

    GST_OBJECT_LOCK(element);
    depth = element->depth;
    element->depth = NULL;
    GST_OBJECT_UNLOCK(element);
    gst_clear_object(&depth);
    GST_ELEMENT_CLASS(rf_gst_element_parent_class)->release_pad(gst_element, pad);
}

static gboolean start(GstAggregator *aggregator)
{
    GstRefocus *const element = (GstRefocus *)aggregator;
    struct refocus_reason reason = {""};

    gst_video_info_init(&element->info);
    gst_video_info_init(&element->depth_info);
    rf_gst_depths_end(&element->depths);
    element->rendered = element->dropped = 0;
    element->refused.text[0] = '\0';
    element->limited = element->stretched = false;
    element->flushed = 0;
    element->earliest = GST_CLOCK_TIME_NONE;
    if (!element->settings.depth_location)
        return TRUE;
    if (rf_gst_depths_read(&element->depths, &element->settings, &reason) == REFOCUS_OK)
        return TRUE;
    GST_ELEMENT_ERROR(element, RESOURCE, OPEN_READ,
                      ("%s: %s", element->settings.depth_location, reason.text), (NULL));
    return FALSE;
}

static gboolean stop(GstAggregator *aggregator)
{
    GstRefocus *const element = (GstRefocus *)aggregator;

    rf_gst_depths_end(&element->depths);
    rf_gst_shot_end(&element->shot);
    rf_gst_chroma_end(&element->chroma_in);
    rf_gst_chroma_end(&element->chroma_out);
    return TRUE;
}

static void forget_lateness(GstRefocus *element)
{
    GST_OBJECT_LOCK(element);
    element->earliest = GST_CLOCK_TIME_NONE;
    GST_OBJECT_UNLOCK(element);
}

static GstBuffer *clip(GstAggregator *aggregator, GstAggregatorPad *pad, GstBuffer *buffer)
{
    const GstClockTime start = GST_BUFFER_PTS(buffer);
    GstClockTime end = start;

    (void)aggregator;
    if (!GST_CLOCK_TIME_IS_VALID(start))
        return buffer;
    if (GST_BUFFER_DURATION_IS_VALID(buffer))
        end += GST_BUFFER_DURATION(buffer);
    if (gst_segment_clip(&pad->segment, GST_FORMAT_TIME, start, end, NULL, NULL))
        return buffer;
    gst_buffer_unref(buffer);
    return NULL;
}

/* The deadline is that of the next frame; without one there is nothing to be late with. */
static GstClockTime next_time(GstAggregator *aggregator)
{
    GstAggregatorPad *const sink = ((GstRefocus *)aggregator)->sink;
    GstBuffer *frame = gst_aggregator_pad_peek_buffer(sink);
    GstClockTime time = GST_CLOCK_TIME_NONE;

    if (frame && GST_BUFFER_PTS_IS_VALID(frame))
        time = gst_segment_to_running_time(&sink->segment, GST_FORMAT_TIME, GST_BUFFER_PTS(frame));
    gst_clear_buffer(&frame);
    return time;
}

static bool take_caps(GstRefocus *element, GstAggregatorPad *pad, GstEvent *event)
{
    GstCaps *caps;

    gst_event_parse_caps(event, &caps);
    if (pad != element->sink)
        return gst_video_info_from_caps(&element->depth_info, caps);
    gst_pad_mark_reconfigure(GST_AGGREGATOR_SRC_PAD(element));
    return gst_video_info_from_caps(&element->info, caps);
}

static bool take_segment(GstRefocus *element, GstEvent *event)
{
    const GstSegment *segment;

    gst_event_parse_segment(event, &segment);
    if (segment->format != GST_FORMAT_TIME) {
        GST_ELEMENT_ERROR(element, STREAM, FORMAT,
                          ("frames without times: put rawvideoparse or the like before it"),
                          (NULL));
        return false;
    }
    gst_aggregator_update_segment(&element->parent, segment);
    rf_gst_shot_forget(&element->shot);
    forget_lateness(element);
    return true;
}

static gboolean sink_event(GstAggregator *aggregator, GstAggregatorPad *pad, GstEvent *event)
{
    GstRefocus *const element = (GstRefocus *)aggregator;
    bool good = true;

    if (GST_EVENT_TYPE(event) == GST_EVENT_CAPS)
        good = take_caps(element, pad, event);
    else if (GST_EVENT_TYPE(event) == GST_EVENT_SEGMENT && pad == element->sink)
        good = take_segment(element, event);
    else if (GST_EVENT_TYPE(event) == GST_EVENT_FLUSH_STOP && pad != element->sink)
        g_atomic_int_set(&element->flushed, 1);
    if (good)
        return GST_AGGREGATOR_CLASS(rf_gst_element_parent_class)
            ->sink_event(aggregator, pad, event);
    gst_event_unref(event);
    return FALSE;
}

/* Frames go out as they come in, so downstream says which may come. */
static void answer_caps(GstRefocus *element, GstAggregatorPad *pad, GstQuery *query)
{
    GstCaps *caps = rf_gst_accepted_caps(element, pad != element->sink), *filter;

    if (pad == element->sink)
        gst_caps_take(&caps, gst_pad_peer_query_caps(GST_AGGREGATOR_SRC_PAD(element), caps));
    gst_query_parse_caps(query, &filter);
    if (filter)
        gst_caps_take(&caps, gst_caps_intersect_full(filter, caps, GST_CAPS_INTERSECT_FIRST));
    gst_query_set_caps_result(query, caps);
    gst_caps_unref(caps);
}

static void answer_accept_caps(GstRefocus *element, GstAggregatorPad *pad, GstQuery *query)
{
    GstCaps *const accepted = rf_gst_accepted_caps(element, pad != element->sink), *caps;

    gst_query_parse_accept_caps(query, &caps);
    gst_query_set_accept_caps_result(query, gst_caps_can_intersect(caps, accepted));
    gst_caps_unref(accepted);
}

static gboolean sink_query(GstAggregator *aggregator, GstAggregatorPad *pad, GstQuery *query)
{
    GstRefocus *const element = (GstRefocus *)aggregator;

    if (GST_QUERY_TYPE(query) == GST_QUERY_CAPS)
        answer_caps(element, pad, query);
    else if (GST_QUERY_TYPE(query) == GST_QUERY_ACCEPT_CAPS)
        answer_accept_caps(element, pad, query);
    else
        return GST_AGGREGATOR_CLASS(rf_gst_element_parent_class)
            ->sink_query(aggregator, pad, query);
    return TRUE;
}

static gboolean src_event(GstAggregator *aggregator, GstEvent *event)
{
    GstRefocus *const element = (GstRefocus *)aggregator;
    GstClockTimeDiff late;
    GstClockTime time;

    if (GST_EVENT_TYPE(event) == GST_EVENT_QOS) {
        gst_event_parse_qos(event, NULL, NULL, &late, &time);
        GST_OBJECT_LOCK(element);
        if (!GST_CLOCK_TIME_IS_VALID(time))
            element->earliest = GST_CLOCK_TIME_NONE;
        else if (late > 0) /* a frame that is late by so much is followed by others */
            element->earliest = time + 2 * (GstClockTime)late;
        else
            element->earliest = time > (GstClockTime)-late ? time - (GstClockTime)-late : 0;
        GST_OBJECT_UNLOCK(element);
    }
    return GST_AGGREGATOR_CLASS(rf_gst_element_parent_class)->src_event(aggregator, event);
}

static void finalize(GObject *object)
{
    GstRefocus *const element = (GstRefocus *)object;

    stop(&element->parent);
    rf_gst_settings_end(&element->used);
    gst_clear_object(&element->depth);
    rf_gst_settings_end(&element->settings);
    G_OBJECT_CLASS(rf_gst_element_parent_class)->finalize(object);
}

static void rf_gst_element_class_init(GstRefocusClass *class)
{
    GObjectClass *const object_class = G_OBJECT_CLASS(class);
    GstElementClass *const element_class = GST_ELEMENT_CLASS(class);
    GstAggregatorClass *const aggregator_class = GST_AGGREGATOR_CLASS(class);

    GST_DEBUG_CATEGORY_INIT(rf_gst_debug, "refocus", 0, "refocus by depth");
    object_class->set_property = set_property;
    object_class->get_property = get_property;
    object_class->finalize = finalize;
    rf_gst_settings_install(object_class);
    gst_element_class_set_static_metadata(
        element_class, "Refocus by depth", "Filter/Effect/Video",
        "Shallow depth of field after the shot: blurs frames by their depth as a lens does",
        "librefocus");
    gst_element_class_add_static_pad_template_with_gtype(element_class, &source_template,
                                                         GST_TYPE_AGGREGATOR_PAD);
    gst_element_class_add_static_pad_template_with_gtype(element_class, &sink_template,
                                                         GST_TYPE_AGGREGATOR_PAD);
    gst_element_class_add_static_pad_template_with_gtype(element_class, &depth_template,
                                                         GST_TYPE_AGGREGATOR_PAD);
    element_class->release_pad = release_pad;
    aggregator_class->create_new_pad = create_new_pad;
    aggregator_class->start = start;
    aggregator_class->stop = stop;
    aggregator_class->clip = clip;
    aggregator_class->get_next_time = next_time;
    aggregator_class->sink_event = sink_event;
    aggregator_class->sink_query = sink_query;
    aggregator_class->src_event = src_event;
    aggregator_class->update_src_caps = rf_gst_update_caps;
    aggregator_class->negotiated_src_caps = rf_gst_negotiated;
    aggregator_class->decide_allocation = rf_gst_decide_allocation;
    aggregator_class->propose_allocation = rf_gst_propose_allocation;
    aggregator_class->aggregate = rf_gst_aggregate;
}

static void rf_gst_element_init(GstRefocus *element)
{
    GstPadTemplate *const template = gst_static_pad_template_get(&sink_template);

    rf_gst_settings_begin(&element->settings);
    rf_gst_depths_end(&element->depths);
    element->earliest = GST_CLOCK_TIME_NONE;
    gst_video_info_init(&element->info);
    gst_video_info_init(&element->depth_info);
    element->sink = g_object_new(GST_TYPE_AGGREGATOR_PAD, "name", "sink", "direction", GST_PAD_SINK,
                                 "template", template, NULL);
    gst_object_unref(template);
    gst_element_add_pad(GST_ELEMENT_CAST(element), GST_PAD_CAST(element->sink));
}
