/* chroma.c: notes how a photo of Y, U and V is coded: matrix, range and subsampling. */
#include "image/chroma.h"

#include "image/format.h"

void rf_yuv_set_blend(struct rf_yuv *yuv, uint32_t blend)
{
    if (!yuv->curve_made || yuv->blend != blend)
        rf_yuv_curve_init(&yuv->curve, yuv->matrix, yuv->range, blend);
    yuv->curve_made = true;
    yuv->blend = blend;
}

void rf_yuv_begin(struct rf_yuv *yuv, const struct refocus_image *photo, uint32_t blend)
{
    yuv->on = rf_is_yuv8(photo->format);
    if (!yuv->on)
        return;
    yuv->down = rf_chroma_down(photo->format);
    yuv->curve_made = yuv->curve_made && yuv->matrix == photo->matrix && yuv->range == photo->range;
    yuv->matrix = photo->matrix;
    yuv->range = photo->range;
    rf_yuv_set_blend(yuv, blend);
}
