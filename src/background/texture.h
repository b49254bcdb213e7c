/* texture.h: continues the texture and the edges of the background into what is hidden.
 *
 * The pull of inpaint.h leaves unknown pixels smooth. Known ones differ from what it would make of
 * them, u, by residuals. From those of known pixels of the same surface around, r_i, the residual
 * of an unknown pixel is predicted at each level of the pyramid,
 *
 *     light = u + sum of w_i r_i,    (T_ij + N_i) w = t
 *
 * the best linear prediction (Wiener; kriging). T are covariances of the known pixels, t those with
 * the unknown one, both by the autocovariance of the residuals in the block around; N is noise,
 * more at level 0 beside unknown pixels, where the photo mixes both sides. What repeats or goes on
 * along a line is continued; where nothing can be told, w is small and u stays. An edge that is 6
 * pixels away from a hole of 5 goes through it by residuals of level 0, one of a hole of 30 by
 * those of level 3.
 *
 * Residuals are in codes, in which dark and bright texture weigh as they are seen.
 *
 * Only where the hidden background is nearly in focus is any of this seen, so at level i, of
 * pixels 2^i wide, all of it is done up to a blur of 3 of them and nothing from 4 on.
 */
#ifndef RF_TEXTURE_H
#define RF_TEXTURE_H

#include "background/pyramid.h"
#include "colour/transfer.h"
#include "image/viewport.h"
#include "support/executor.h"

/* Q7.8: the blur from which on level 0 is smooth. */
enum { RF_TEXTURE_BLUR = 4 << 8 };

/* Scratch of a worker. */
struct rf_texture_scratch;
uint64_t rf_texture_scratch_bytes(void);

struct rf_texture {
    struct rf_texture_scratch *scratch; /* one of each worker */
    const struct rf_transfer *transfer; /* residuals are in codes */
    int same;                           /* blurs of one surface differ by no more, as is stored */
    int unit;                           /* unit of the blurs */
};

/* Pulls all levels, as rf_background_pull() does, with texture. */
void rf_background_pull_textured(const struct rf_executor *exec, const struct rf_viewport *view,
                                 const struct rf_pyramid *pyramid,
                                 const struct rf_texture *texture);

#endif
