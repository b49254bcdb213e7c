/* convert.h: samples as they are stored become RGB8 photos or one channel of depth. */
#ifndef RF_FILE_CONVERT_H
#define RF_FILE_CONVERT_H

#include "reading.h"

int rf_raster_to_rgb8(const struct rf_read *read, struct rf_raster *raster);
/* One channel from equal ones; REFOCUS_ERR_NO_DEPTH when they are not equal. */
int rf_raster_to_grey(const struct rf_read *read, struct rf_raster *raster);

#endif
