/* known.h: light above white that a photo holds, in place of an estimate of what clipping took.
 *
 * Runs of pixels above white are listed as highlights with just that light. Where a part of the
 * photo has more of them than its list holds, tiles that are above white as a whole are left to the
 * rays, or all of them if that does not suffice, and at the sides of the photo those that are so by
 * half, as rays find them repeated beyond: rf_boost_known() adds their light to what rays hit
 * then, spread as the pre-filter spreads light up to white.
 */
#ifndef RF_HIGHLIGHTS_KNOWN_H
#define RF_HIGHLIGHTS_KNOWN_H

#include "background/pyramid.h"
#include "highlights/highlights.h"

/* The gain that lists of known light are for, which adds a third of `boost` RF_KNOWN_UNIT times:
 * they hold up to 65535 RF_KNOWN_UNIT of Q12 above white, 336 times white. */
enum { RF_KNOWN_GAIN = 64, RF_KNOWN_UNIT = (RF_KNOWN_GAIN - 1) / 3 };

/* Q7.8: pixels that are less blurred have their own light, all of it (gather/encode_deep.c). */
enum { RF_KNOWN_FROM = 128 };

/* Gives the lists of photos up to that size the memory that known light needs beyond that of all.
 */
void rf_lay_out_known(struct rf_highlights *highlights, struct rf_arena *arena, int max_width,
                      int max_height);

/* Lists the light of a photo. What a cancelled run leaves is of no use. */
void rf_list_known(const struct rf_executor *exec, const struct rf_deep *photo,
                   struct rf_highlights *highlights);

/* The light above white of a pixel of the photo, Q12. */
void rf_known_excess(const struct rf_deep *photo, int x, int y, int excess[3]);

/* The light above white of pixels `from` to `to` - 1 of a run, in all, Q12. */
void rf_known_light(const struct rf_deep *photo, const struct rf_highlight *run, int from, int to,
                    double light[3]);

/* Whether any light of the photo is left to the rays. */
bool rf_leaves_known(const struct rf_highlight_window *window);

/* Whether a tile of the window is left to the rays. */
bool rf_known_is_left(const struct rf_highlight_window *window, int tx, int ty);

/* Adds to `smooth`, up to `most` there, the light that is left to the rays and that of what is in
 * focus, this to the hidden background, too; notes the brightest in bins. `gap` as of
 * rf_boost_highlights(). */
void rf_boost_known(const struct rf_executor *exec, const struct rf_highlight_window *window,
                    struct rf_light_q12 smooth, struct rf_background background, double gap,
                    int most);

/* Counts its tiles as foreground: see rf_raise_highlights(). */
void rf_raise_known(const struct rf_executor *exec, const struct rf_highlight_window *window,
                    const struct rf_foreground_cells *foreground);

/* The hidden background is inpainted from light up to white. Adds the light above it that wide
 * areas have, in a row of tiles, to level 1 of the pyramid that has been pushed from level 0: up to
 * 4 times white in all. Afterwards notes in bins how bright what was inpainted is there. */
void rf_push_known(const struct rf_highlight_window *window, const struct rf_focus_plan *plan,
                   struct rf_disparity_q16 disparity, const struct rf_pyramid *pyramid, int band);
void rf_note_behind(const struct rf_executor *exec, const struct rf_highlight_window *window,
                    struct rf_light_q12 behind, int band);

#endif
