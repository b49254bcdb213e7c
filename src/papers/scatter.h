/* scatter.h: tables of how light is spread over circles of confusion. */
#ifndef RF_SCATTER_H
#define RF_SCATTER_H

#include <stdint.h>

#include "support/pool.h"

enum { RF_SPREAD_LEAST_TABLES = 73, RF_SPREAD_ONE = 1 << 24 };

/* The shares of its light that a sample gives to the pixels around it, Q24, for one blur radius.
 * Row dy
 * >= 0 begins at share + dy * (2 * reach + 1); its pixel dx is at [reach + dx]. Rows above are
 * the same as those below. The shares of all pixels sum to RF_SPREAD_ONE. */
struct rf_spread_table {
    double radius;
    int reach; /* pixels beyond the circle are 0 */
    uint32_t *share;
};

/* The number of tables for radii 0 .. max_radius at equal steps: 73, or four a pixel. */
int rf_spread_tables(double max_radius);
/* The pixels each way that table i has room for: as many as the next table reaches, so that the two
 * can be interpolated. */
int rf_spread_reach(double max_radius, int i);

/* Fills a table whose radius, reach and share are set. */
void rf_spread_fill(struct rf_spread_table *table, uint32_t spread, double airy_radius,
                    struct rf_run *run);

#endif
