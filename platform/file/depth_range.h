/* depth_range.h: Google's words for what samples of depth mean. */
#ifndef RF_FILE_DEPTH_RANGE_H
#define RF_FILE_DEPTH_RANGE_H

#include "reading.h"
#include "xmp.h"

/* Near and Far as the file says them, and its unit. */
struct rf_depth_range {
    double near, far; /* both 0: not said */
    double metres;    /* in a unit; 0: no unit that is known */
};

/* Properties of GDepth and of Dynamic Depth's DepthMap, which mean the same. */
struct rf_range_keys {
    const char *name;           /* "GDepth" */
    const char *default_format; /* where Format is not said; NULL: that is damage */
    enum rf_xmp_key format, near, far, units;
};

/* Give read->samples their meaning in read->depth. */
int rf_set_range(struct rf_read *read, const struct rf_xmp *xmp, const struct rf_range_keys *keys,
                 struct rf_depth_range *range);

#endif
