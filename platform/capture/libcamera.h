#ifndef RF_CAPTURE_LIBCAMERA_H
#define RF_CAPTURE_LIBCAMERA_H

struct rf_source_ops;

/* The libcamera backend; NULL when it is not in this build or cannot be loaded. */
#ifdef RF_HAVE_LIBCAMERA
const struct rf_source_ops *rf_libcamera(void);
#else
static inline const struct rf_source_ops *rf_libcamera(void)
{
    return 0;
}
#endif

#endif
