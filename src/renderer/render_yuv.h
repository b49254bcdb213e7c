/* render_yuv.h: the passes of a frame of Y, U and V. */
#ifndef RF_RENDER_YUV_H
#define RF_RENDER_YUV_H

#include "methods/method.h"

/* REFOCUS_OK if the prepared photo, in Y, U and V or not, can be rendered so into f->out;
 * REFOCUS_ERR_UNSUPPORTED, or REFOCUS_ERR_ARGUMENT for a region that splits samples. */
int rf_check_yuv(const struct rf_frame *f);

/* Render f->region of a photo of Y, U and V. */
void rf_run_yuv(struct rf_frame *f);

#endif
