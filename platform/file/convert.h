/* convert.h: samples as they are stored become RGB8 photos or one channel of depth. */
#ifndef RF_FILE_CONVERT_H
#define RF_FILE_CONVERT_H

#include "reading.h"

/* The thresholds of an ordered dither of 8 x 8 pixels: 0 to 63, once each. */
void rf_dither_thresholds(uint8_t thresholds[64]);
/* read->image to RGB8; of more than 8 bits all that it holds goes to read->deep. */
int rf_image_to_rgb8(struct rf_read *read);
/* One channel from equal ones; REFOCUS_ERR_NO_DEPTH when they are not equal. */
int rf_raster_to_grey(const struct rf_read *read, struct rf_raster *raster);

#endif
