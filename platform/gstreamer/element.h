/* element.h: the element `refocus`, and what its files share. */
#ifndef RF_GSTREAMER_ELEMENT_H
#define RF_GSTREAMER_ELEMENT_H

#include <gst/base/gstaggregator.h>
#include <gst/video/video.h>
#include "depths.h"
#include "frame.h"
#include "settings.h"
#include "shot.h"

GST_DEBUG_CATEGORY_EXTERN(rf_gst_debug);
#define GST_CAT_DEFAULT rf_gst_debug

typedef struct rf_gst_element {
    GstAggregator parent;
    GstAggregatorPad *sink;
    GstAggregatorPad *depth; /* NULL or a reference; under the object lock */

    /* Under the object lock: */
    struct rf_gst_settings settings;
    GstClockTime earliest; /* frames of a running time up to it come too late */

    gint flushed; /* atomic: the pad depth was flushed, and its map is still held */

    /* These belong to the streaming thread. */
    GstVideoInfo info, depth_info; /* GST_VIDEO_FORMAT_UNKNOWN: no caps yet */
    struct rf_gst_depths depths;
    struct rf_gst_shot shot;
    struct rf_gst_chroma chroma_in, chroma_out;
    struct rf_gst_settings used; /* settings of the last frame that could be rendered by its own */
    struct refocus_reason refused; /* words that the bus has about those that could not */
    bool limited;                  /* the bus knows of a blur that the method cannot have */
    bool stretched;                /* the bus knows of maps of another shape than frames have */
    guint64 rendered, dropped;
} GstRefocus;

typedef struct {
    GstAggregatorClass parent_class;
} GstRefocusClass;

GType rf_gst_element_get_type(void);

/* negotiate.c: which frames go in and out, and where those that go out lie. */
GstCaps *rf_gst_accepted_caps(GstRefocus *element, bool depth);
GstFlowReturn rf_gst_update_caps(GstAggregator *aggregator, GstCaps *wanted, GstCaps **caps);
gboolean rf_gst_negotiated(GstAggregator *aggregator, GstCaps *caps);
gboolean rf_gst_decide_allocation(GstAggregator *aggregator, GstQuery *query);
gboolean rf_gst_propose_allocation(GstAggregator *aggregator, GstAggregatorPad *pad,
                                   GstQuery *decide_query, GstQuery *query);

/* aggregate.c: a frame and its depth become a frame. */
GstFlowReturn rf_gst_aggregate(GstAggregator *aggregator, gboolean timeout);

#endif
