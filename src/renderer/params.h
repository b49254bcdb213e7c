/* params.h: whether a renderer can render settings whose fields are all in their ranges. */
#ifndef RF_PARAMS_H
#define RF_PARAMS_H

#include "renderer/renderer.h"
#include "support/log.h"

/* REFOCUS_OK, or REFOCUS_ERR_ARGUMENT: a method that the renderer has no memory for, more blur than
 * it is made for, or settings that do not go together. */
int rf_check_settings(const struct rf_log *log, const struct refocus_renderer *r,
                      const struct rf_settings *settings);

/* REFOCUS_OK if the prepared photo, in Y, U and V or not, can be rendered so into f->out;
 * REFOCUS_ERR_UNSUPPORTED, or REFOCUS_ERR_ARGUMENT for a region that splits samples. */
int rf_check_yuv(const struct rf_log *log, const struct rf_frame *f, struct rf_rect region);

/* REFOCUS_OK, or REFOCUS_ERR_UNSUPPORTED for what a deep photo, or a deep f->out, cannot have. */
int rf_check_deep(const struct rf_log *log, const struct rf_frame *f, struct rf_rect region);

#endif
