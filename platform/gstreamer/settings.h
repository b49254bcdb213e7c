/* settings.h: the properties of the element, as plain numbers and texts. */
#ifndef RF_GSTREAMER_SETTINGS_H
#define RF_GSTREAMER_SETTINGS_H

#include <stdbool.h>
#include <gst/gst.h>
#include <refocus/refocus.h>

struct rf_gst_settings {
    double focus, focus_x, focus_y, focus_distance; /* shot.c says in which order they count */
    double blur, f_number, focal_length, sensor_width;
    double near_m, far_m;
    double highlights; /* 0: estimated */
    double steady;
    int method, quality; /* indices of the enumerations */
    int threads;
    int place_edges, qos; /* booleans */
    char *aperture, *depth_location, *depth_unit, *invalid;

    struct refocus_aperture_params shape; /* read from `aperture` */
    bool shape_known;
    unsigned shape_number; /* another one for another shape */
};

/* The properties of a class whose instances have settings at get_settings(). */
void rf_gst_settings_install(GObjectClass *object_class);
void rf_gst_settings_begin(struct rf_gst_settings *settings);
/* A copy has texts of its own. */
void rf_gst_settings_copy(struct rf_gst_settings *copy, const struct rf_gst_settings *settings);
void rf_gst_settings_end(struct rf_gst_settings *settings);
void rf_gst_settings_set(struct rf_gst_settings *settings, guint id, const GValue *value);
void rf_gst_settings_get(const struct rf_gst_settings *settings, guint id, GValue *value);
bool rf_gst_settings_have(guint id);

/* Ray samples a pixel of a quality. */
int rf_gst_quality_rays(int quality);
bool rf_gst_quality_is_best(int quality);

/* "disc", "polygon:6", "polygon:6:15", "heart", "star" or "star:7"; false: not known. */
bool rf_gst_read_shape(const char *text, struct refocus_aperture_params *shape);

#endif
