/* gain_map.h: the gain map of a photo: a small picture that says by how much each pixel of the
 * photo's 8 bits, its base rendition, is brighter in the light that the camera saw.
 *
 * With linear light, S of the base rendition and H of the other one,
 *
 *     H = (S + base_offset) 2^gain - other_offset
 *
 * for each channel, gain interpolated between the samples of the map. Ultra HDR (XMP of Adobe and
 * Google), ISO 21496-1 and Apple's maps all become this: see gain_values.c. Writers of photos find
 * the map of one that was read by rf_photo_gain_map(), upright as its picture is.
 */
#ifndef RF_FILE_GAIN_MAP_H
#define RF_FILE_GAIN_MAP_H

#include <refocus/platform/file.h>
#include "raster.h"

/* The values beside the samples. Members of 3 are of R, G and B. */
struct rf_gain_values {
    double least[3], greatest[3]; /* log2 of the gain of samples 0 and 255 */
    double gamma[3];              /* gain = least + (greatest - least) (sample / 255)^(1 / gamma) */
    double base_offset[3], other_offset[3];
    double base_headroom, other_headroom; /* log2 of the brightest over white; of two renditions */
};

enum { RF_GAIN_MOST_STOPS = 16 }; /* the limit of a gain, either way */

struct rf_gain_map {
    struct rf_raster samples; /* 8 bits, 1 or 3 channels; pixels NULL: there is none */
    struct rf_gain_values values;
    float gain[3][256]; /* log2 of the gain of each sample */
};

/* The map of a photo; NULL: it has none. It ends with the photo. */
const struct rf_gain_map *rf_photo_gain_map(const struct refocus_photo *photo);

#endif
