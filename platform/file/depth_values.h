/* depth_values.h: what the values of a depth map mean. */
#ifndef RF_FILE_DEPTH_VALUES_H
#define RF_FILE_DEPTH_VALUES_H

#include <refocus/depth.h>

/* A map linear in 1/z whose values have these disparities, in 1/m: the greatest value is nearest.
 */
void rf_depth_from_disparity(struct refocus_depth_map *map, double value_min, double value_max,
                             double disparity_min, double disparity_max);

#endif
