/* depths.h: the depth map that the present frame goes with. */
#ifndef RF_GSTREAMER_DEPTHS_H
#define RF_GSTREAMER_DEPTHS_H

#include <stdbool.h>
#include <gst/video/video.h>
#include <refocus/platform/file.h>
#include "settings.h"

struct rf_gst_depths {
    bool known;        /* there is a map */
    bool still;        /* the map is of a file and holds for all frames */
    bool fresh;        /* no frame has used the map yet */
    GstClockTime time; /* running time of the map, or none */
    GstVideoFrame frame;
    uint32_t flags; /* refocus_depth_follow_flags() gave them for the last map */
    bool mapped;    /* `frame` is that of the map */

    uint16_t *own; /* disparities that are not the buffer's own samples */
    size_t samples;
    struct refocus_disparity disparity; /* the map, once it is not fresh any more */
    struct refocus_depth_range range;   /* 0, 0: not known */

    struct refocus_temporal *filter;
    int32_t filter_width, filter_height;
    double filter_strength;
    GstClockTime filter_time;
};

/* Read the map of a file, which then holds for all frames. */
int rf_gst_depths_read(struct rf_gst_depths *depths, const struct rf_gst_settings *settings,
                       struct refocus_reason *reason);

/* Hold the map of a buffer, by reference, until the next one. FORMAT: its buffer is no picture of
 * its caps; NO_DEPTH: it has not one reading. Then the map before it stays. */
int rf_gst_depths_hold(struct rf_gst_depths *depths, const struct rf_gst_settings *settings,
                       GstBuffer *buffer, const GstVideoInfo *info, GstClockTime time);

/* The map as disparities, for a frame of this picture: depths->disparity and depths->range. */
int rf_gst_depths_use(struct rf_gst_depths *depths, const struct rf_gst_settings *settings,
                      const struct refocus_image *photo, struct refocus_reason *reason);

/* Whether the map has neither the shape of frames as they are stored nor as they are shown, and so
 * is another picture's, or lies on its side. A square is what networks make of any frame. */
bool rf_gst_depths_are_stretched(const struct rf_gst_depths *depths, const GstVideoInfo *info);

/* Forget maps of the pad and the past: after a flush. */
void rf_gst_depths_forget(struct rf_gst_depths *depths);
void rf_gst_depths_end(struct rf_gst_depths *depths);

#endif
