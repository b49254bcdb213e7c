/* settings.h: reads the public parameters of a render into struct rf_settings. */
#ifndef RF_RENDERER_SETTINGS_H
#define RF_RENDERER_SETTINGS_H

#include "support/log.h"
#include "support/settings.h"

/* Read params and all that they point at once, with defaults in place of what is not there, and
 * check the ranges of refocus/params.h and refocus/methods.h.
 * REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_UNSUPPORTED (a field of a newer library). */
int rf_read_settings(const struct rf_log *log, struct rf_settings *settings,
                     const struct refocus_render_params *params);

/* A copy whose maps are its own. */
void rf_keep_settings(struct rf_settings *kept, const struct rf_settings *settings);

#endif
