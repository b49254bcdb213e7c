/* background.h: what is behind the foreground.
 *
 * A blurred foreground lets through what is behind its edge. One picture does not show
 * that, so a second layer, r->behind, is made up: pixels that could be seen through are
 * replaced by what is beside them and farther away.
 *
 * Mark: p is foreground where some q lies farther behind than it is away,
 *
 *     max over q of (s(q) - |p - q| / 2) > s(p) + 1/2 pixel,
 *
 * a grey dilation of s by a cone; |p - q| is the octagonal distance with steps of 1 and
 * sqrt 2. Slope 1 would mark what can be seen through; slope 1/2 marks twice as deep,
 * so that the sources nearest to what is seen lie on the far side. Fill: marked pixels
 * take light and blur by push-pull from the rest, in a pyramid.
 *
 * The steps, in this order; rows may be shared out within a step.
 */
#ifndef RF_BACKGROUND_H
#define RF_BACKGROUND_H

#include "renderer/renderer.h"

/* The dilation but for its steps along rows: from above, and from below. Both
 * directions may run at once. Uses the planes r->background.light.channel[0] and [1]. */
void rf_background_dilate(struct refocus_renderer *r, bool upwards);

/* The steps along rows, `reach` of them at the most, and the mark; copies r->smooth.channel. */
void rf_background_mark_rows(struct refocus_renderer *r, uint16_t *scratch, int reach, int y0,
                             int y1);

/* The part of levels 1 to `levels` that lies over a row of tiles by itself: up to
 * RF_BAND_LEVELS, of which it is a row. */
enum { RF_BAND_LEVELS = 4 };
void rf_background_push_band(struct refocus_renderer *r, int band, int levels);

/* Fill: up the pyramid from a level to another, and down again; level 0 with its
 * border. All of it is 0 to r->levels. */
void rf_background_push(struct refocus_renderer *r, int from, int to);
void rf_background_pull(struct refocus_renderer *r, int from, int to);

/*
 * Whether the fill of the pixels in `need` is that of the whole photo, though only a
 * window is there: between push and pull. The mark and the light of the window are
 * those of the whole photo in `exact`. Unknown pixels ask for their parents, and so on,
 * until all are known.
 */
bool rf_background_is_exact(const struct refocus_renderer *r, struct rf_rect need,
                            struct rf_rect exact);

/*
 * Columns x0 to x1 - 1 of a row, x0 even, that hold the next of what is unknown of n blurs,
 * beginning with {0}; false: there is no more. Away from the sides of the picture the first two
 * and the last two of them are known: what the pull takes from beyond them is not used.
 */
enum { RF_UNKNOWN_STEP = 64 };
struct rf_unknown {
    int x0, x1;
};
bool rf_next_unknown(const int16_t *blur, int n, struct rf_unknown *run);

/*
 * The same for a photo of Y, U and V. Chroma of 4:2:0 is as large as level 1 of the
 * pyramid and is filled from there on; a sample is known if any of its pixels is. That
 * of 4:2:2 is made as small for it: what is filled in has half its rows.
 */
void rf_background_yuv_mark_rows(struct refocus_renderer *r, uint16_t *scratch, int reach, int y0,
                                 int y1);
void rf_background_yuv_fill(struct refocus_renderer *r);

#endif
