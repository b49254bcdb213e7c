/* colour.h: how likely a colour is the object's, from counts of both sides. */
#ifndef RF_STROKES_COLOUR_H
#define RF_STROKES_COLOUR_H

#include <stdint.h>
#include "pyramid.h"

enum { RF_BINS = 16 * 32 * 32 };
struct rf_likeness {
    uint32_t object[RF_BINS], outside[RF_BINS]; /* counts, then smoothed */
    uint32_t scratch[RF_BINS];
    int16_t score[RF_BINS]; /* > 0: the object's; RF_BIT = twice as likely */
};
enum { RF_BIT = 16 };
static inline int rf_bin(struct rf_colour c)
{
    return c.y >> 4 << 10 | c.u >> 3 << 5 | c.v >> 3;
}
void rf_likeness_clear(struct rf_likeness *likeness);
void rf_likeness_settle(struct rf_likeness *likeness);

#endif
