/* render_yuv.h: the steps that only photos of Y, U and V need. */
#ifndef RF_RENDER_YUV_H
#define RF_RENDER_YUV_H

#include "gather/frame.h"
#include "passes/prefilter.h"
#include "support/log.h"

/* REFOCUS_OK if the prepared photo, in Y, U and V or not, can be rendered so into f->out;
 * REFOCUS_ERR_UNSUPPORTED, or REFOCUS_ERR_ARGUMENT for a region that splits samples. */
int rf_check_yuv(const struct rf_log *log, const struct rf_frame *f, struct rf_rect region);

/* The pre-filter of chroma; the background's planes are not in use yet. */
struct rf_prefilter_chroma rf_chroma_prefilter(const struct rf_frame *f);

#endif
