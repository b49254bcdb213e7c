/* disparity.h: copies a disparity map as large as the photo to its plane, and smooths its steps. */
#ifndef RF_PASSES_DISPARITY_H
#define RF_PASSES_DISPARITY_H

#include <refocus/image.h>

#include "image/planes.h"
#include "support/executor.h"

struct rf_copy_disparity {
    const struct refocus_disparity *map;
    int step; /* rf_code_step() of the map; 0: codes are left as they are */
    struct rf_disparity_q16 disparity; /* written, from the map's first sample on */
    struct rf_disparity_q16 spare[2];  /* overwritten from there on, if step is not 0 */
};

/* Writes disparities as Q16, and slopes in place of the steps of a map that has few codes. */
void rf_copy_disparity(const struct rf_executor *exec, const struct rf_copy_disparity *pass);

#endif
