/* steady.c: keeps the edges of a video's depth from flickering.
 *
 * Votes are taken by a photo with noise, and close ones turn from frame to frame, although nothing
 * moves. An edge that moves changes the map: half a pixel of motion changes a ramp of 8 pixels by a
 * sixteenth of its contrast. So where the map is that of the last frame, the result is too. Small
 * differences are followed by a quarter a frame.
 */
#include "edges/edges.h"

#include <stdlib.h>

enum {
    SAME = 2,     /* codes of eight bits */
    SMALL = 1024, /* 1/64 of the range; larger ones are another decision */
};

void rf_find_still(const struct rf_edges *e, struct rf_last_edges *last)
{
    const bool none = last->width != e->width || last->height != e->height;

    for (int y = 0; y < e->height; y++) {
        const uint16_t *in = e->map + y * e->stride;
        uint8_t *was = last->map + (ptrdiff_t)y * e->width;
        uint8_t *still = last->still + (ptrdiff_t)y * e->width;

        for (int x = 0; x < e->width; x++) {
            const uint8_t now = (uint8_t)(in[x] >> 8);

            still[x] = !none && abs(now - was[x]) <= SAME;
            was[x] = still[x] ? was[x] : now;
        }
    }
}

void rf_hold_still(struct rf_edges *e, struct rf_last_edges *last)
{
    for (int y = 0; y < e->height; y++) {
        uint16_t *now = e->map + y * e->stride;
        uint16_t *was = last->result + (ptrdiff_t)y * e->width;
        const uint8_t *still = last->still + (ptrdiff_t)y * e->width;

        for (int x = 0; x < e->width; x++) {
            const int by = now[x] - was[x];

            if (still[x])
                now[x] = (uint16_t)(was[x] + (abs(by) < SMALL ? by / 4 : 0));
            was[x] = now[x];
        }
    }
    last->width = e->width;
    last->height = e->height;
}
