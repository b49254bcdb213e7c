/* ring.h: buffers of sources that have no driver to own them. */
#ifndef RF_CAPTURE_RING_H
#define RF_CAPTURE_RING_H

#include "backend.h"

struct rf_ring {
    struct refocus_frame frame[RF_MOST_BUFFERS];
    uint8_t *memory[RF_MOST_BUFFERS]; /* owned */
    size_t size[RF_MOST_BUFFERS];
    int count;
    uint32_t taken;
};

/* A free buffer; -1 and the reason where there is none. */
int rf_ring_take(struct rf_ring *ring, struct refocus_reason *reason);
void rf_ring_give(struct rf_ring *ring, uint32_t buffer);
/* Memory of at least so many bytes for a taken buffer. */
bool rf_ring_reserve(struct rf_ring *ring, int buffer, uint64_t bytes);
void rf_ring_free(struct rf_ring *ring);

#endif
