/* behind.h: a second layer that the caller knows: light and depth of what the photo hides.
 *
 * Where the foreground is marked (mark.h) and the layer has something farther than the photo, that
 * is the hidden background, and known; push-pull inpaints the rest from both (inpaint.h). The layer
 * is kept as it came, as codes and disparities, since it is read at marked pixels alone.
 *
 * Rays that pass all that is seen meet the hidden background at one blur, about that of the deepest
 * around (gather/corners.h). So what is left out of the layer, as if it were not known, is
 *
 *     as near     what has no more blur than the surface that is seen before it: F of a mixture
 *                 (thin/thin.h) was read from it, and behind that lies another one
 *     passed      what would be seen as sharp as what is deeper, though many rays pass it: two or
 *                 more of eight places around, three quarters of its blur away, show something
 *                 deeper by more than `apart` (inpaint.h) and less out of focus. So it is with a
 *                 wire behind a wire before a sky in focus, but not with a wall behind a bar
 *
 * A blurred layer is smoothed as the photo is, where rays lie far apart (passes/prefilter.h): its
 * light is the mean over the square of 2^n - 1 pixels each way about a pixel, n the number of steps
 * of the pre-filter at its blur. With 64 rays a blur of 10 pixels takes one step, the mean of 3 x
 * 3, one of 20 pixels two, that of 7 x 7.
 */
#ifndef RF_BEHIND_H
#define RF_BEHIND_H

#include <stdbool.h>
#include <stdint.h>

#include <refocus/image.h>

#include "colour/transfer.h"
#include "focus/focus.h"
#include "image/planes.h"
#include "image/viewport.h"
#include "support/arena.h"
#include "support/executor.h"

/* The layer, of the whole photo. */
struct rf_behind {
    int width, height;   /* pixels, as of the photo; 0: there is none */
    uint8_t *code;       /* R, G, B, alpha of each pixel; alpha 0: nothing is known there */
    uint16_t *disparity; /* Q16, of each pixel */
};

/* Lays out a layer of a photo of at most this size. */
void rf_lay_out_behind(struct rf_behind *behind, struct rf_arena *arena, int max_width,
                       int max_height);

/* Copies a layer of R, G, B; map and image have the same size. */
void rf_behind_load(const struct rf_executor *exec, const struct refocus_image *image,
                    const struct refocus_disparity *map, struct rf_behind *behind);

/* Whether the layer has something at a pixel of the photo that is farther than `disparity`. */
static inline bool rf_is_behind(const struct rf_behind *behind, int x, int y, uint16_t disparity)
{
    const size_t at = (size_t)y * (size_t)behind->width + (size_t)x;

    return behind->code[4 * at + 3] && behind->disparity[at] < disparity;
}

struct rf_behind_pass {
    const struct rf_behind *behind;
    const struct rf_transfer *transfer; /* from codes to the light of the blend in use */
    const struct rf_focus_plan *plan;
    const int *above;                  /* |s| that each step of the pre-filter begins at, Q7.8 */
    int steps;                         /* number of those */
    struct rf_disparity_q16 disparity; /* read: the photo's */
    struct rf_blur_q8 blur;            /* read: of what is seen, which is F of separated mixtures */
    int apart;                         /* rf_layers_apart() */
    struct rf_background background;   /* written where its blur is RF_NO_BLUR */
};

/* Puts the layer into the hidden background of rows y0 to y1 - 1 of the window, once these are
 * marked. */
void rf_behind_rows(const struct rf_executor *exec, const struct rf_viewport *view,
                    const struct rf_behind_pass *pass, int y0, int y1, int worker);

#endif
