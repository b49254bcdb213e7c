/* highlights.h: light that the photo's white point cut off, given back to small lamps.
 *
 * A lamp out of focus is a disc whose brightness is the lamp's, spread over the disc. In the
 * photo the lamp is clipped to white, so its disc comes out grey. Pixels are taken for
 * clipped lamps when they are nearly white and stand alone: many times brighter than
 * what is around them. Never large clipped areas: a white wall is just white.
 *
 *     level      ramp of max(R, G, B) from 0.94 to 1
 *     isolation  ramp of luminance / mean luminance of the 25x25 pixels around, 3 to 6
 *     added      (gain - 1) * level * isolation * hue
 *
 * The hue is that of the lamp's rim: the pixels around that are brighter than their
 * surroundings but not clipped. What is added acts on pixels that are blurred; the sharp ones
 * stay as they are.
 */
#ifndef RF_HIGHLIGHTS_H
#define RF_HIGHLIGHTS_H

#include <stdint.h>

struct refocus_renderer;
struct rf_rect;

struct rf_highlight {
    uint16_t x, y;
    uint16_t added[3]; /* Q12 light at full gain of 4, at most 3 * 4095 */
    uint16_t is_edge;  /* for this lens: of something bright and sharper, left alone */
};

/* Most highlights of a picture; further ones, row by row, stay as they are. */
static inline uint64_t rf_highlight_capacity(int width, int height)
{
    return (uint64_t)width * height / 64 + 64;
}

/* Add to the highlights of the photo in use those in a part of the window, in its blend. Pixels 12
 * away from the part are looked at. */
void rf_find_highlights(struct refocus_renderer *r, struct rf_rect part);

/* In the window, for the lens setting of r->front.blur and r->bins: tell edges from lamps, and note in its
 * tile how far a lamp is blurred. */
void rf_mark_highlights(struct refocus_renderer *r);

/* Add what they lost, gain 1 to 4: returns how many were done before the run was cancelled, all
 * if it was not. And take it away again. */
uint64_t rf_add_highlights(struct refocus_renderer *r, float gain);
void rf_remove_highlights(struct refocus_renderer *r, float gain, uint64_t count);

#endif
