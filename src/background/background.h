/* background.h: what is behind the foreground.
 *
 * A blurred foreground lets through what is behind its edge. One picture does not show
 * that, so a second layer is made up: pixels that could be seen through are replaced by
 * what is farther away beside them.
 */
#ifndef RF_BACKGROUND_H
#define RF_BACKGROUND_H

#include "renderer/renderer.h"

/*
 * Fill r->behind from r->front.blur and r->smooth.
 *
 * Mark: p is foreground where some q lies farther behind than it is away,
 *
 *     max over q of (s(q) - |p - q| / 2) > s(p) + 1/2 pixel,
 *
 * a grey dilation of s by a cone; |p - q| is the octagonal distance with steps of 1 and
 * sqrt 2. Slope 1 would mark what can be seen through; slope 1/2 marks twice as deep, so that
 * what stays behind as a source on the foreground's side is always the farther one.
 * Fill: marked pixels take light and blur by push-pull from the rest.
 */
void rf_background(struct refocus_renderer *r);

#endif
