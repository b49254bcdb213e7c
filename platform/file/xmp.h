/* xmp.h: the XMP properties that say what is depth. */
#ifndef RF_FILE_XMP_H
#define RF_FILE_XMP_H

#include "reading.h"

enum rf_xmp_key {
    RF_XMP_EXTENDED, /* xmpNote:HasExtendedXMP */
    RF_XMP_DEPTH_FORMAT,
    RF_XMP_DEPTH_NEAR,
    RF_XMP_DEPTH_FAR,
    RF_XMP_DEPTH_UNITS,
    RF_XMP_DEPTH_MIME,
    RF_XMP_DEPTH_DATA,
    RF_XMP_IMAGE_MIME,
    RF_XMP_IMAGE_DATA,
    RF_XMP_FOCUS_X,
    RF_XMP_FOCUS_Y,
    RF_XMP_FOCUS_DISTANCE,
    RF_XMP_FOCUS_BLUR,
    RF_XMP_APPLE_TYPE,
    RF_XMP_APPLE_FLOAT_MIN,
    RF_XMP_APPLE_FLOAT_MAX,
    RF_XMP_APPLE_INT_MIN,
    RF_XMP_APPLE_INT_MAX,
    RF_XMP_APPLE_ACCURACY,
    RF_XMP_APPLE_APERTURE,
    RF_XMP_GAIN_MAP, /* hdrgm:Version */
    RF_XMP_KEYS
};
/* The properties above as text, NUL-terminated; NULL: not there. */
struct rf_xmp {
    char *value[RF_XMP_KEYS];
    size_t length[RF_XMP_KEYS];
};
void rf_xmp_free(struct rf_xmp *xmp);
/* A property as a number; *found is false when it is absent. A property that is no number fails. */
int rf_xmp_number(const struct rf_read *read, const struct rf_xmp *xmp, enum rf_xmp_key key,
                  const char *name, bool *found, double *value);
/* f-number of the blur that an iPhone shows; 0: not said. */
double rf_xmp_simulated_f_number(const struct rf_xmp *xmp);

#endif
