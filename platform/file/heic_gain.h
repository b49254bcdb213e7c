/* heic_gain.h: the gain map of a HEIC or AVIF. */
#ifndef RF_FILE_HEIC_GAIN_H
#define RF_FILE_HEIC_GAIN_H

#include "heic_picture.h"

/* Whether that is the type of auxiliary images that are gain maps. */
bool rf_heic_is_gain_map(const char *type);
/* Read one into read->gain, if none was read. One that is damaged or unknown is passed over: the
 * photo is whole without it. */
int rf_heic_gain_auxiliary(struct rf_heic *heic, struct heif_image_handle *handle,
                           heif_item_id item, const char *type);
/* Read the gain map of the container's tone map, if there is one and no other was read. */
int rf_heic_gain_tone_map(struct rf_heic *heic);

#endif
