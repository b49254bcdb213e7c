/* climb.c: takes one more step up or down a map from each pixel of a cell. */
#include "kernels/kernels.h"

bool RF_VEC(rf_climb)(const struct rf_climb_cell *c)
{
    const ptrdiff_t s = c->stride;
    const ptrdiff_t offset[RF_NO_DIRECTION + 1] = {1, -1, s, -s, s + 1, 1 - s, s - 1, -1 - s, 0};
    bool any = false;

    for (int i = 0; i < c->rows * c->columns; i++) {
        const ptrdiff_t at = i / c->columns * s + i % c->columns;
        const uint16_t was = c->from[at];
        const uint16_t next = c->from[at + offset[c->direction[at] >> (c->down ? 4 : 0) & 15]];
        const uint16_t step = (uint16_t)(c->down ? was - next : next - was);

        c->to[at] = next;
        if (c->length[at] != c->step - 1 || step < c->flat || step * RF_RAMP_ENDS < c->largest[at])
            continue;
        c->end[at] = next;
        c->largest[at] = step > c->largest[at] ? step : c->largest[at];
        c->length[at] = c->step;
        any = true;
    }
    return any;
}
