/* draw.h: lamps, drawn as discs.
 *
 * What is out of focus by s spreads over the pixels p whose rays meet it, p + u s(q) =
 * q (Yang et al. 2016, eq. 4): a disc of radius |s| around q. Rays are too few to show
 * a lamp of a pixel or two as an even disc with a crisp rim, and every ray of a full
 * mask, rounded to whole pixels, shows it as a mesh. So what lamps lost is kept out of
 * the planes that rays look into, and what they have more than what is beside them is
 * taken out, where their discs are larger than what so many rays show evenly (taken.c);
 * each tile adds both to its means:
 *
 *     mean(p) += (added + own) (p's part of the run's pixels in sight) / (pi s^2)
 *
 * Of the pixels [a, b] of a run, a row of the disc shows those from max(a, x + left) to
 * min(b, x + right), its chord there. What is nearer hides half of it each where the
 * ways from p to a place left and right of its middle, one above and one below it,
 * others in each row, meet one of the tile's nearer slabs, by the same test as a ray
 * does: one way alone shows thin things in between as dots, and edges as steps. Other
 * openings have their own area in place of pi. Rows of large discs are drawn as one,
 * their chords' mean, where nothing hides them.
 *
 * Of openings that are evenly open and whose rows are one chord or two, discs, irises, hearts
 * and stars, by the sweep and without eq. 5, whose weights differ from pixel to pixel;
 * else the light is added to what rays meet (highlights.h). The first chords of all rows
 * are drawn as one opening, and so are the second ones.
 *
 * 12 views and 4 of K = 40, standard: 32.09 dB with what lamps lost, 32.11 with all that
 * they have more; nightlights before the focus 25.77 and 25.83.
 */
#ifndef RF_DRAW_H
#define RF_DRAW_H

#include "gather/frame.h"

/* Whether this frame's lamps are drawn. */
bool rf_draws_lamps(const struct rf_frame *f);

/* Of lamps of the window that are marked, takes what they have more than what is beside
 * them out of the light that is pre-filtered: that of tiles that r->bins say is then in
 * r->background.light.channel. */
void rf_take_lamps_out(struct refocus_renderer *r);

/* Adds lamps to the means of a tile, Q14 and 65535 at most, of so many planes. */
void rf_draw_lamps(const struct rf_frame *f, const struct rf_tile_plan *plan, int tx, int ty,
                   uint16_t *const mean[3], int planes);

#endif
