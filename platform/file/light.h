/* light.h: pictures by the curves of HDR become linear light, 1 = white. */
#ifndef RF_FILE_LIGHT_H
#define RF_FILE_LIGHT_H

#include "reading.h"

/* Curves and primaries by their numbers in ITU-T H.273, as HEIC, AVIF and JPEG XL give them. */
enum {
    RF_CURVE_BT709 = 1,
    RF_CURVE_LINEAR = 8,
    RF_CURVE_SRGB = 13,
    RF_CURVE_PQ = 16,
    RF_CURVE_HLG = 18
};
enum { RF_PRIMARIES_BT709 = 1, RF_PRIMARIES_BT2020 = 9, RF_PRIMARIES_P3 = 12 };

/* Whether codes by that curve are light that may be brighter than white. */
bool rf_curve_is_hdr(int curve);
/* Integers of 16 bits in three channels, by PQ or HLG, or floats, become floats of linear light
 * with the primaries of BT.709; those of others are changed, and what then is below 0 is 0. White
 * is 203 cd/m2 of PQ and 75 % of the signal of HLG (ITU-R BT.2408). */
int rf_raster_to_light(const struct rf_read *read, struct rf_raster *raster, int curve,
                       int primaries);
/* Note that the picture is light by such a curve. */
void rf_note_curve(const struct rf_read *read, int curve, int primaries);

#endif
