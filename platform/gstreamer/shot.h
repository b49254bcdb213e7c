/* shot.h: a renderer that fits the frames and the settings. */
#ifndef RF_GSTREAMER_SHOT_H
#define RF_GSTREAMER_SHOT_H

#include "depths.h"
#include "settings.h"

/* A place of the frames that is focused on, the metres between which depth lies, and a moment. */
struct rf_gst_aim {
    double x, y;
    struct refocus_depth_range range;
    GstClockTime time;
};

struct rf_gst_shot {
    struct refocus_renderer *renderer;
    struct refocus_renderer_params made; /* parameters of the renderer */
    struct refocus_aperture *aperture;
    unsigned shape_number; /* shape of the aperture; 0: there is none */
    GstClockTime time;     /* running time of the last frame */
    bool begun, cut;       /* there was a frame; the next one does not follow on it */
    bool aimed;            /* the last frame focused on the surface at a place: */
    struct rf_gst_aim aim;
    float surface; /* disparity in focus */
    bool limited;  /* the method cannot have the blur that was asked for */
};

/* The next frame does not follow on the last: their highlights and their focus are not compared. */
void rf_gst_shot_forget(struct rf_gst_shot *shot);

/* Refocus a frame of this running time, or none. On an error `reason` says why in words. */
int rf_gst_shot_take(struct rf_gst_shot *shot, const struct rf_gst_settings *settings,
                     const struct rf_gst_depths *depths, GstClockTime time,
                     const struct refocus_image *photo, const struct refocus_image *out,
                     struct refocus_reason *reason);
void rf_gst_shot_end(struct rf_gst_shot *shot);

#endif
