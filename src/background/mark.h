/* mark.h: marks the foreground: pixels that rays pass because they are blurred.
 *
 * A blurred foreground uncovers some of the background at its edge. The photo does not show that,
 * so a second layer, the hidden background, is made up: the pixels of the foreground that rays
 * could pass are marked here and inpainted (inpaint.h) from farther ones beside them.
 *
 * p is foreground where some farther pixel q is near enough in the picture,
 *
 *     max over q of (s(q) - |p - q| / 2) > s(p),
 *
 * a grey dilation of s by a cone; |p - q| is the octagonal distance with steps of 1 and sqrt 2. If
 * p has the blur -6, a q of blur 0 that is 11 pixels away makes it foreground, as 0 - 5.5 > -6; one
 * that is 12 pixels away does not. Slope 1 would mark the pixels that rays could pass. Slope 1/2
 * marks twice as deep, so that what rays can see there is inpainted from the far side alone; and
 * the pixel beside an edge in focus from half a pixel of blur behind it on, from which on rays are
 * rounded to it.
 */
#ifndef RF_MARK_H
#define RF_MARK_H

#include "image/planes.h"
#include "image/viewport.h"
#include "support/executor.h"
#include "tiles/bins.h"

/* Signed blur, as it is stored, + 2^15, dilated from above and from below: 0 is below all blurs.
 * Padded; columns -1 and `width` are written. */
struct rf_dilated_blur {
    uint16_t *from_above, *from_below;
    ptrdiff_t stride;
};

struct rf_mark {
    int planes;                  /* planes of light: 3, or 1 where it is luminance */
    int reach;                   /* steps along a row that the cone is followed for: spread_row */
    struct rf_blur_q8 blur;      /* read */
    struct rf_light_q12 smooth;  /* read */
    const struct rf_bins *bins;  /* read: extremes of the blur of tiles */
    struct rf_dilated_blur cone; /* written by rf_background_dilate(), then read; its rows may lie
                                    in those of the background's light, which replace them */
    struct rf_background background; /* written: blur is RF_NO_BLUR in the foreground, light a copy
                                        of `smooth` */
};

/* How many steps the cone is followed for: it falls by half a pixel of blur for each pixel, and
 * blurs of a plain lens differ by K at most, those of tilts and fields by twice that. */
int rf_mark_reach(bool plain, int max_blur_radius, int unit);

/* Dilates along columns and diagonals: from above, or from below. Both may run at once. */
void rf_background_dilate(const struct rf_executor *exec, const struct rf_viewport *view,
                          const struct rf_mark *mark, bool upwards);

/* Dilates rows y0 to y1 - 1 along themselves and marks them. */
void rf_background_mark_rows(const struct rf_executor *exec, const struct rf_viewport *view,
                             const struct rf_mark *mark, int y0, int y1, int worker);

/*
 * Marks mixtures in a row of tiles, once its rows are marked. Beside a silhouette the photo mixes
 * both surfaces in a pixel. Where the map calls it background it would be the nearest source of all
 * that is inpainted behind the edge: a bright wall behind a dark thing would be grey there.
 *
 * A pixel p beside a surface that has more than 4 pixels of blur less, and is farther out of focus,
 * is a mixture if along most ways to that surface, which is more than a pixel wide,
 *
 *     background b, background a, p, surface f
 *
 * p is no texture of the background, |p - a| > 4 |a - b|, but lies between it and the surface,
 * |p - a| + |p - f| <= 9/8 |a - f|; distances are sums over channels. With a and b of light 2000
 * and 2010 and f of 400, p of 1200 is one; with b of 1700 it is not. a and b are not in front of p,
 * and b has no such surface beside it: not all of the farthest pixels are marked.
 */
void rf_background_leave_mixed(const struct rf_viewport *view, const struct rf_mark *mark,
                               int band);

/* Tells which pixels of a photo are no foreground, where no plane of all of it is stored: bit x % 8
 * of byte x / 8 of a row. */
struct rf_known {
    uint8_t *bits;
    ptrdiff_t stride;
};

/* Stores what is marked in the window, for a block of the photo that begins at a multiple of 8. */
void rf_known_store(const struct rf_known *known, const struct rf_viewport *view,
                    struct rf_blur_q8 marked, struct rf_rect block);

/* Marks rows y0 to y1 - 1 of the window as they were stored: reads `blur` and `smooth` of `mark`,
 * and writes its background, of three planes. */
void rf_known_mark_rows(const struct rf_known *known, const struct rf_viewport *view,
                        const struct rf_mark *mark, int y0, int y1);

#endif
