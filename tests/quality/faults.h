/* faults.h: maps with the faults of those that phones, sensors and networks make. */
#ifndef QUALITY_FAULTS_H
#define QUALITY_FAULTS_H

#include <stdint.h>

struct fault {
    const char *name;
    /* Makes a map of width / divisor x height / divisor samples, without padding between rows, of
     * exact disparities. Returns 0, or -1 without memory. */
    int (*make)(const uint16_t *exact, int width, int height, uint16_t *out);
    int divisor;
};

extern const struct fault faults[]; /* until one without a name */

#endif
