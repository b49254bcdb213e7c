/* yuv.h: the passes over the planes of a photo of Y, U and V; see struct rf_yuv.
 *
 * Rows y0 to y1 - 1 are of the picture, from an even one on; those of chroma follow from them.
 */
#ifndef RF_PLANES_YUV_H
#define RF_PLANES_YUV_H

#include "passes/planes.h"
#include "renderer/renderer.h"

/* The renderer's planes are those of such a photo: of Y, U and V, or of R, G and B again. Before
 * rf_use(). */
void rf_yuv_begin(struct refocus_renderer *r, const struct refocus_image *photo);

/* For rf_use(): the planes of the window. */
void rf_yuv_use(struct refocus_renderer *r);

/* A picture in RGB8 in the memory of disparities and what is free beside the codes of U and V. */
struct refocus_image rf_yuv_guide(const struct refocus_renderer *r);

/*
 * Photo rows to luma and chroma. Each byte of the photo is read once, each row of a plane in
 * one go, rows in order. `guide`, if not NULL, receives the picture in RGB8, for those who look
 * for edges. `scratch` has 4 bytes a pixel of a row and a few more.
 */
void rf_yuv_convert_rows(struct refocus_renderer *r, const struct refocus_image *photo,
                         const struct refocus_image *guide, uint8_t *scratch, int y0, int y1);

/* Change to the curve of another blend, and rows to the curve. */
void rf_yuv_set_blend(struct refocus_renderer *r, uint32_t blend);
void rf_yuv_reblend_rows(struct refocus_renderer *r, uint8_t *scratch, int y0, int y1);

/* The blur of chroma: that of its sharpest pixel, so that no colour of what is in focus is
 * smeared. r->blur.at is final. */
void rf_yuv_blur_rows(struct refocus_renderer *r, int y0, int y1);

/* A step of the pre-filter, for a row of tiles, as rf_prefilter_rows(): of luma, and of chroma,
 * whose distances are in its samples. */
void rf_yuv_prefilter_luma(struct refocus_renderer *r, uint16_t *out, const uint16_t *in,
                           const int above[RF_PREFILTER_STEPS], bool fades, int step,
                           uint16_t *scratch, int ty);
void rf_yuv_prefilter_chroma(struct refocus_renderer *r, uint16_t *out, const uint16_t *in,
                             const int above[RF_PREFILTER_STEPS], bool fades, int step,
                             uint16_t *scratch, int ty);

/* Weights of eq. 5 for luma of a row of tiles, in yuv.weight; those of the background over its
 * blur. */
void rf_yuv_weigh_rows(struct refocus_renderer *r, int ty);

/* The same as kernels.h, weigh1, has it: light of both layers is times the weight then, and chroma
 * times that of the first pixel of a sample. Notes the brightest of each tile. */
void rf_yuv_premultiply_rows(struct refocus_renderer *r, uint16_t *scratch, int ty);

/*
 * How far the mean of light, or of chroma, that is the same everywhere may be from 4 times that
 * when both layers are premultiplied: 1/2 of Q13 times Q12, or of Q12 times Q12, by the least
 * weight, and 1/2. Of weights of RF_YUV_LEAST_WEIGHT / 4096 and more it is at most 15.
 */
enum { RF_YUV_LEAST_WEIGHT = 586 };
static inline uint16_t rf_yuv_within(const struct refocus_renderer *r, int chroma)
{
    return (uint16_t)(1 + (4096 << chroma) / (r->light_weight[0] >> 3));
}

/* rf_extend_rows() of rows c0 to c1 - 1 of a plane of chroma. */
void rf_extend_chroma(const struct refocus_renderer *r, void *plane, int c0, int c1);

/* End of the rows of chroma of rows that end at y1. */
static inline int rf_chroma_end(const struct refocus_renderer *r, int y1)
{
    return (y1 + r->yuv.down) >> r->yuv.down;
}

#endif
