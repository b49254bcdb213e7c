/* mark.h: marks the foreground, the pixels that a blur lets be seen through.
 *
 * A blurred foreground uncovers some of what its edge hides. One picture does not show that, so a
 * second layer, the hidden background, is made up: pixels that could be seen through are marked
 * here and inpainted (inpaint.h) from what is beside them and farther away.
 *
 * p is foreground where some pixel q is farther than p by more blur than its distance in the
 * picture,
 *
 *     max over q of (s(q) - |p - q| / 2) > s(p) + 1/2 pixel,
 *
 * a grey dilation of s by a cone; |p - q| is the octagonal distance with steps of 1 and sqrt 2.
 * Slope 1 would mark what can be seen through; slope 1/2 marks twice as deep, so that the sources
 * nearest to what is seen lie on the far side.
 */
#ifndef RF_MARK_H
#define RF_MARK_H

#include "image/planes.h"
#include "image/viewport.h"
#include "support/executor.h"

/* Signed blur + 2^15, dilated from above and from below: 0 is below all blurs. Padded; columns -1
 * and `width` are written. */
struct rf_dilated_blur {
    uint16_t *from_above, *from_below;
    ptrdiff_t stride;
};

struct rf_mark {
    int planes;                  /* planes of light: 3, or 1 where it is luminance */
    int reach;                   /* steps along a row that the cone is followed for, at most
                                    2 RF_SPREAD_MARGIN - 1 */
    struct rf_blur_q8 blur;      /* read */
    struct rf_light_q12 smooth;  /* read */
    struct rf_dilated_blur cone; /* written by rf_background_dilate(), then read; its rows may lie
                                    in those of the background's light, which replace them */
    struct rf_background background; /* written: blur is RF_NO_BLUR in the foreground, light a copy
                                        of `smooth` */
};

/* Dilates along columns and diagonals: from above, or from below. Both may run at once. */
void rf_background_dilate(const struct rf_executor *exec, const struct rf_viewport *view,
                          const struct rf_mark *mark, bool upwards);

/* Dilates rows y0 to y1 - 1 along themselves and marks them. */
void rf_background_mark_rows(const struct rf_executor *exec, const struct rf_viewport *view,
                             const struct rf_mark *mark, int y0, int y1, int worker);

#endif
