/* ring.c: buffers of sources that have no driver to own them. */
#include <stdlib.h>
#include <string.h>
#include "ring.h"

int rf_ring_take(struct rf_ring *ring, struct refocus_reason *reason)
{
    for (int i = 0; i < ring->count; i++)
        if (!(ring->taken >> i & 1)) {
            ring->taken |= (uint32_t)1 << i;
            return i;
        }
    rf_capture_fail(reason, REFOCUS_ERR_STATE, "every buffer is out; release one");
    return -1;
}

void rf_ring_give(struct rf_ring *ring, uint32_t buffer)
{
    ring->taken &= ~((uint32_t)1 << buffer);
}

bool rf_ring_reserve(struct rf_ring *ring, int buffer, uint64_t bytes)
{
    uint8_t *memory;

    if (ring->memory[buffer] && bytes <= ring->size[buffer])
        return true;
    if (bytes > SIZE_MAX / 2)
        return false;
    memory = malloc((size_t)bytes + 1);
    if (!memory)
        return false;
    free(ring->memory[buffer]);
    ring->memory[buffer] = memory;
    ring->size[buffer] = (size_t)bytes;
    return true;
}

void rf_ring_free(struct rf_ring *ring)
{
    for (int i = 0; i < RF_MOST_BUFFERS; i++)
        free(ring->memory[i]);
    memset(ring, 0, sizeof *ring);
}
