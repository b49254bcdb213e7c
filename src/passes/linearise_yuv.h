/* linearise_yuv.h: turns the codes of a photo of Y, U and V into luminance and chroma.
 *
 * The equations are in colour/yuv.h. The codes are kept, so that a change of blend begins with
 * them, and what does not change is written as it came.
 */
#ifndef RF_LINEARISE_YUV_H
#define RF_LINEARISE_YUV_H

#include <refocus/image.h>

#include "image/chroma.h"
#include "image/planes.h"
#include "image/viewport.h"
#include "support/executor.h"

struct rf_linearise_yuv {
    const struct rf_yuv_curve *curve;
    struct rf_chroma_size size;
    const struct refocus_image *photo; /* Y, U and V, as large as the window */
    const struct refocus_image *guide; /* written: the picture in RGB8, for those who
                                          look for edges; or NULL */
    struct rf_yuv_codes codes;         /* written */
    struct rf_light_q12 light;         /* written, with its border: channel[0] is luminance */
    struct rf_chroma_q12 chroma;       /* written, with its border */
};

/* Writes codes, luminance and chroma of the whole window. Each byte of the photo is read once, each
 * row of a plane in one go, rows in order. */
void rf_linearise_yuv(const struct rf_executor *exec, const struct rf_viewport *view,
                      const struct rf_linearise_yuv *pass);

/* Writes luminance and chroma of rows y0 to y1 - 1, y0 even, from the codes; photo and guide are
 * not used. */
void rf_reblend_yuv_rows(const struct rf_executor *exec, const struct rf_viewport *view,
                         const struct rf_linearise_yuv *pass, int y0, int y1, int worker);

#endif
