/* coverage.h: the coverage layer, which thin structures are splatted into; private to this folder.
 *
 * Thin structures far before the focus are splatted: alpha N and alpha of cells of 4 x 4 pixels are
 * added up and spread evenly over a disc around their centroid, in cells, and between the middles
 * of cells the layer is interpolated,
 *
 *     layer = sum of alpha N / pi s^2,  coverage = sum of alpha / pi s^2
 *     out   = layer + (1 - coverage) mean
 *
 * A disc is drawn as the differences along its rows, so its cost is that of its height.
 */
#ifndef RF_COVERAGE_H
#define RF_COVERAGE_H

#include <stdint.h>

#include "thin/thin.h"

struct rf_coverage_source {
    int32_t x, y;    /* the disc's centre, cells in Q8 from the picture's corner */
    int32_t radius;  /* radius of its disc, cells in Q8 */
    int32_t each[4]; /* alpha N and alpha that each cell of the disc gets, in the unit of
                        struct rf_coverage */
};

#endif
