/* settings.h: all that a render is asked for, flat, as the core reads it: the public structs of one
 * feature each end in renderer/settings.c. */
#ifndef RF_SETTINGS_H
#define RF_SETTINGS_H

#include <stdint.h>

#include <refocus/params.h>

struct rf_settings {
#define RF_FIELD_REAL                            float
#define RF_FIELD_SIGNED                          int32_t
#define RF_FIELD_UNSIGNED                        uint32_t
#define RENDER(type, field, ...)                 RF_FIELD_##type field;
#define SETTING(type, feature, field, name, ...) RF_FIELD_##type name;
#include "support/settings.def"

    const struct refocus_aperture *aperture;
    struct refocus_band band[REFOCUS_MAX_BANDS - 1];

    /* Maps of the caller, or NULL; they point at the copies below. */
    const struct refocus_disparity *focus_map, *sharp_map, *field_map;
    struct refocus_disparity own_focus_map, own_sharp_map, own_field_map;
};

#endif
