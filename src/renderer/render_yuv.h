/* render_yuv.h: what a photo of Y, U and V needs beside or in place of what others do. */
#ifndef RF_RENDER_YUV_H
#define RF_RENDER_YUV_H

#include "gather/frame.h"

/* REFOCUS_OK if the prepared photo, in Y, U and V or not, can be rendered so into f->out;
 * REFOCUS_ERR_UNSUPPORTED, or REFOCUS_ERR_ARGUMENT for a region that splits samples. */
int rf_check_yuv(const struct rf_frame *f, struct rf_rect region);

/* A step of the pre-filter for a band. */
void rf_smooth_yuv_band(const struct rf_frame *f, int step, int band, int worker);

#endif
