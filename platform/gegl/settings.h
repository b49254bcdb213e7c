/* settings.h: the properties of the operation, as plain numbers. */
#ifndef RF_GEGL_SETTINGS_H
#define RF_GEGL_SETTINGS_H

#include <glib-object.h>

enum rf_gegl_shape {
    RF_GEGL_DISC,
    RF_GEGL_POLYGON,
    RF_GEGL_HEART,
    RF_GEGL_STAR,
};

enum rf_gegl_unit {
    RF_GEGL_DISPARITY,
    RF_GEGL_INVERSE,
    RF_GEGL_METRES,
};

/* The values of the depth map that are read. */
enum rf_gegl_values {
    RF_GEGL_STORED,
    RF_GEGL_PERCEPTUAL,
    RF_GEGL_LINEAR,
};

/* The meaning of white in a photo of floats. */
enum rf_gegl_light {
    RF_GEGL_AUTO,
    RF_GEGL_PHOTO,
    RF_GEGL_SCENE,
};

enum { RF_GEGL_STILL = 3 }; /* quality: standard, with the rays of a still */

struct rf_gegl_settings {
    double focus, focus_x, focus_y; /* a place counts before the disparity */
    double focus_width, focus_transition;
    double blur, highlights; /* 0: estimated */
    double rotation, curvature, squeeze, ring, edge, cat_eye, fringe;
    double near_m, far_m; /* 0: measured */
    int shape, blades;
    int quality, unit, values, light;
    int place_edges; /* a boolean */
};

/* The properties of a class whose instances have these settings. */
void rf_gegl_settings_install(GObjectClass *object_class);
void rf_gegl_settings_begin(struct rf_gegl_settings *settings);
void rf_gegl_settings_set(struct rf_gegl_settings *settings, guint id, const GValue *value);
void rf_gegl_settings_get(const struct rf_gegl_settings *settings, guint id, GValue *value);

#endif
