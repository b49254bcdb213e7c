/* inpaint.h: makes up the light and blur of the hidden background by push-pull.
 *
 * Marked pixels (mark.h) take light and blur from the known ones around them. Push: each level of
 * a pyramid has the mean light and the farthest blur of those of 2 x 2 pixels of the level before
 * that are known, or of the deeper ones of them. Pull: from the last level down, unknown pixels
 * take from the four nearest pixels of the level above, or from the deeper ones of them. Gortler et
 * al. 1996, section 3.4.
 *
 * A photo of Y, U and V has luminance alone in level 0. Chroma of 4:2:0 is as large as level 1 and
 * is inpainted from there on; a sample is known if any of its pixels is. That of 4:2:2 is made as
 * small for it: what is inpainted has half its rows.
 */
#ifndef RF_INPAINT_H
#define RF_INPAINT_H

#include <assert.h>

#include "background/pyramid.h"
#include "image/chroma.h"
#include "image/viewport.h"
#include "support/executor.h"

/* Push as far as a row of tiles goes by itself: from a level to another, or to RF_BAND_LEVELS,
 * whose pixels are as high as the row. */
enum { RF_BAND_LEVELS = 4 };
void rf_background_push_band(const struct rf_executor *exec, const struct rf_pyramid *pyramid,
                             int band, int from, int to);

/* Push from a level to another, and pull from `to` down to `from`; level 0 gets its border. All of
 * it is from 0 to pyramid->levels. */
void rf_background_push(const struct rf_executor *exec, const struct rf_pyramid *pyramid, int from,
                        int to);
void rf_background_pull(const struct rf_executor *exec, const struct rf_viewport *view,
                        const struct rf_pyramid *pyramid, int from, int to);

/*
 * A marked area ends at known pixels on both sides: at the background, and farther in at the
 * foreground itself. If both were mixed, a bright sky behind a dark cap would be grey there, and
 * light of a subject in focus would get into the background beside it. So of children and of
 * parents whose blurs are more than `apart` apart push and pull take the deeper ones alone: a
 * quarter of the largest blur, which is a quarter of the range of disparities, with any lens. With
 * a tenth, one of the scenes with exact maps loses 0.28 dB, where a surface between the foreground
 * and the background is hidden, too.
 *
 * How far an inpainted surface goes on before a deeper one is not known: it would end with the cell
 * of a coarse level, in a straight edge that is seen where the deeper one is in focus. There pull
 * mixes both.
 */
static inline int16_t rf_layers_apart(float max_blur_radius, int unit)
{
    return (int16_t)((int)(max_blur_radius * (256.0f / 4)) >> unit);
}
static_assert((int)REFOCUS_MAX_BLUR_RADIUS * 64 >> RF_MAX_UNIT < INT16_MAX, "quarters of a blur");

/* Chroma that is read and written beside the pyramid, for a photo of Y, U and V. */
struct rf_inpaint_chroma {
    struct rf_chroma_size size;
    struct rf_chroma_q12 smooth;     /* read */
    struct rf_chroma_q12 background; /* written, with its border */
};

/* Push and pull of all levels of a photo of Y, U and V. */
void rf_background_inpaint_yuv(const struct rf_executor *exec, const struct rf_viewport *view,
                               const struct rf_pyramid *pyramid,
                               const struct rf_inpaint_chroma *chroma);

/*
 * Between push and pull: whether the pixels in `need` will be inpainted as in the whole photo,
 * though only a window is there. The mark and the light of the window are those of the whole photo
 * in `exact`. Unknown pixels ask for their parents, and so on, until all are known.
 */
bool rf_background_is_exact(const struct rf_viewport *view, const struct rf_pyramid *pyramid,
                            struct rf_rect need, struct rf_rect exact);

/*
 * Finds columns x0 to x1 - 1 of a row, x0 even, that hold the next of the unknown ones among n
 * blurs, beginning with {0}; false: there is no more. Away from the sides of the picture the first
 * two and the last two of them are known: what the pull takes from beyond them is not used.
 */
enum { RF_UNKNOWN_STEP = 64 };
struct rf_unknown {
    int x0, x1;
};
bool rf_next_unknown(const int16_t *blur, int n, struct rf_unknown *run);

#endif
