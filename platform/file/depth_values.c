/* depth_values.c: the values of a depth map that is linear in 1/z. */
#include "depth_values.h"

#include <math.h>

void rf_depth_from_disparity(struct refocus_depth_map *map, double value_min, double value_max,
                             double disparity_min, double disparity_max)
{
    map->meaning = REFOCUS_DEPTH_DISPARITY;
    map->value_near = value_max;
    map->value_far = value_min;
    if (disparity_max > 0.0) {
        map->near_m = 1.0 / disparity_max;
        map->far_m = disparity_min > 0.0 ? 1.0 / disparity_min : INFINITY;
        if (disparity_min < 0.0) {
            /* Nothing is farther than infinity: d = 0 is where the disparity is. */
            map->value_far +=
                (value_max - value_min) * -disparity_min / (disparity_max - disparity_min);
        }
    }
}
