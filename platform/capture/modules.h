/* modules.h: the libcamera source and the window sink, which are modules of their own. */
#ifndef RF_CAPTURE_MODULES_H
#define RF_CAPTURE_MODULES_H

struct rf_source_ops;
struct rf_sink_ops;

/* The libcamera source and the window sink; NULL when they are not in this build or
 * cannot be loaded. */
const struct rf_source_ops *rf_libcamera(void);
const struct rf_sink_ops *rf_window(void);

#endif
