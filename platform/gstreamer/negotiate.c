/* negotiate.c: frames go out in the caps that they come in, into a pool of buffers. */
#include "element.h"

GstCaps *rf_gst_accepted_caps(GstRefocus *element, bool depth)
{
    const char *name = depth ? "depth" : "sink";
    GstCaps *caps, *rgb;
    uint32_t traits;

    caps = gst_pad_template_get_caps(gst_element_get_pad_template(GST_ELEMENT_CAST(element), name));
    GST_OBJECT_LOCK(element);
    traits = refocus_method_traits((uint32_t)element->settings.method);
    GST_OBJECT_UNLOCK(element);
    if (depth || traits & REFOCUS_METHOD_TAKES_YUV)
        return caps;
    rgb = gst_caps_from_string(GST_VIDEO_CAPS_MAKE("{ " RF_GST_FORMATS_RGB " }"));
    gst_caps_take(&caps, gst_caps_intersect(caps, rgb));
    gst_caps_unref(rgb);
    return caps;
}

GstFlowReturn rf_gst_update_caps(GstAggregator *aggregator, GstCaps *wanted, GstCaps **caps)
{
    GstRefocus *const element = (GstRefocus *)aggregator;
    GstCaps *const given = gst_pad_get_current_caps(GST_PAD_CAST(element->sink));

    if (!given)
        return GST_AGGREGATOR_FLOW_NEED_DATA;
    *caps = gst_caps_intersect(given, wanted);
    gst_caps_unref(given);
    return gst_caps_is_empty(*caps) ? GST_FLOW_NOT_NEGOTIATED : GST_FLOW_OK;
}

/* A frame is rendered while the next one is taken, so it goes out a frame's time late. */
gboolean rf_gst_negotiated(GstAggregator *aggregator, GstCaps *caps)
{
    const GstVideoInfo *const info = &((GstRefocus *)aggregator)->info;
    GstClockTime frame = 0;

    (void)caps;
    if (GST_VIDEO_INFO_FPS_N(info) > 0)
        frame = gst_util_uint64_scale(GST_SECOND, (guint64)GST_VIDEO_INFO_FPS_D(info),
                                      (guint64)GST_VIDEO_INFO_FPS_N(info));
    gst_aggregator_set_latency(aggregator, frame, frame);
    return TRUE;
}

static bool configure(GstBufferPool *pool, GstCaps *caps, guint size, guint least, guint most,
                      bool meta)
{
    GstStructure *config = gst_buffer_pool_get_config(pool);

    gst_buffer_pool_config_set_params(config, caps, size, least, most);
    if (meta)
        gst_buffer_pool_config_add_option(config, GST_BUFFER_POOL_OPTION_VIDEO_META);
    return gst_buffer_pool_set_config(pool, config);
}

gboolean rf_gst_decide_allocation(GstAggregator *aggregator, GstQuery *query)
{
    const GstVideoInfo *const info = &((GstRefocus *)aggregator)->info;
    const bool meta = gst_query_find_allocation_meta(query, GST_VIDEO_META_API_TYPE, NULL);
    const bool offered = gst_query_get_n_allocation_pools(query) > 0;
    guint size = (guint)GST_VIDEO_INFO_SIZE(info), asked = 0, least = 0, most = 0;
    GstBufferPool *pool = NULL;
    GstCaps *caps;
    bool good;

    gst_query_parse_allocation(query, &caps, NULL);
    if (offered)
        gst_query_parse_nth_allocation_pool(query, 0, &pool, &asked, &least, &most);
    size = MAX(size, asked);
    good = pool && configure(pool, caps, size, least, most, meta);
    if (!good) {
        gst_clear_object(&pool);
        pool = gst_video_buffer_pool_new();
        good = configure(pool, caps, size, least, most = 0, meta);
    }
    if (good && offered)
        gst_query_set_nth_allocation_pool(query, 0, pool, size, least, most);
    else if (good)
        gst_query_add_allocation_pool(query, pool, size, least, most);
    gst_object_unref(pool);
    return good;
}

/* Frames of any stride, as cameras make them, are taken where they lie. */
gboolean rf_gst_propose_allocation(GstAggregator *aggregator, GstAggregatorPad *pad,
                                   GstQuery *decide_query, GstQuery *query)
{
    (void)aggregator;
    (void)pad;
    (void)decide_query;
    gst_query_add_allocation_meta(query, GST_VIDEO_META_API_TYPE, NULL);
    return TRUE;
}
