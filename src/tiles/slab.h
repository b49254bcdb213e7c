/* slab.h: a range of signed blur that a tile's rays meet at one offset. */
#ifndef RF_SLAB_H
#define RF_SLAB_H

#include <stdint.h>

enum {
    RF_TILE = 16,  /* tiles are RF_TILE x RF_TILE pixels */
    RF_BINS = 256, /* of signed blur in a tile; no more slabs than bins */
};

/* Ray u sees the slab at round(u centre). */
struct rf_slab {
    int16_t low;    /* a pixel of blur s is hit if 0 <= s - low <= width */
    uint16_t width;
    int16_t centre; /* Q7.8 */
};

#endif
