/* shot.h: a renderer that fits the frames and the settings. */
#ifndef RF_GSTREAMER_SHOT_H
#define RF_GSTREAMER_SHOT_H

#include "depths.h"
#include "settings.h"

struct rf_gst_shot {
    struct refocus_renderer *renderer;
    struct refocus_renderer_params made; /* parameters of the renderer */
    struct refocus_aperture *aperture;
    unsigned shape_number; /* shape of the aperture; 0: there is none */
};

/* Refocus a frame. On an error `reason` says why in words. */
int rf_gst_shot_take(struct rf_gst_shot *shot, const struct rf_gst_settings *settings,
                     const struct rf_gst_depths *depths, const struct refocus_image *photo,
                     const struct refocus_image *out, struct refocus_reason *reason);
void rf_gst_shot_end(struct rf_gst_shot *shot);

#endif
