/* orient.h: pictures and points are turned upright by EXIF orientation, 1 to 8. */
#ifndef RF_FILE_ORIENT_H
#define RF_FILE_ORIENT_H

#include "reading.h"

int rf_raster_orient(const struct rf_read *read, struct rf_raster *raster, int orientation);
/* A point in fractions of the stored width and height becomes one of the upright picture. */
void rf_orient_point(double *x, double *y, int orientation);
/* The orientation that does what two do, one after the other. */
int rf_orient_both(int first, int second);
/* The orientation that undoes one. */
int rf_orient_inverse(int orientation);

#endif
