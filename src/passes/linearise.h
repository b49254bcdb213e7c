/* linearise.h: turns the codes of a photo into light that can be averaged.
 *
 * What is linear depends on the blend (colour/transfer.h); a change of blend goes back to the codes
 * and on from there, which is exact.
 */
#ifndef RF_LINEARISE_H
#define RF_LINEARISE_H

#include <refocus/image.h>

#include "colour/transfer.h"
#include "image/deep.h"
#include "image/planes.h"
#include "image/viewport.h"
#include "support/executor.h"

struct rf_linearise {
    const struct refocus_image *photo; /* R, G and B, as large as the window */
    const struct rf_transfer *transfer;
    struct rf_light_q12 light; /* written, with its border */
    struct rf_alpha_u8 alpha;  /* written */
};

/* Writes light and alpha of the whole window. */
void rf_linearise(const struct rf_executor *exec, const struct rf_viewport *view,
                  const struct rf_linearise *pass);

struct rf_linearise_deep {
    const struct rf_deep *photo;        /* as large as the window */
    const struct rf_transfer *transfer; /* linear light */
    struct rf_light_q12 light;          /* written up to white, with its border */
    struct rf_alpha_u8 alpha;           /* written */
    const struct refocus_image *guide;  /* written in RGB8, or NULL */
};

/* Does so with a deep photo. */
void rf_linearise_deep(const struct rf_executor *exec, const struct rf_viewport *view,
                       const struct rf_linearise_deep *pass);

/* Changes rows y0 to y1 - 1 of light from one blend to another. */
void rf_reblend_rows(const struct rf_viewport *view, const struct rf_transfer *from,
                     const struct rf_transfer *to, struct rf_light_q12 light, int y0, int y1);

#endif
