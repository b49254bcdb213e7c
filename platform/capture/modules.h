/* modules.h: the sources and sinks that are in modules of their own. */
#ifndef RF_CAPTURE_MODULES_H
#define RF_CAPTURE_MODULES_H

struct rf_source_ops;
struct rf_sink_ops;

/* NULL when they are not in this build or cannot be loaded. */
const struct rf_source_ops *rf_libcamera(void);
const struct rf_source_ops *rf_pipewire_source(void);
const struct rf_sink_ops *rf_pipewire_sink(void);
const struct rf_sink_ops *rf_window(void);

#endif
