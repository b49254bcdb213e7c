/* photo_source.h: the whole photo, wherever it is kept: in planes, or as the caller's picture. */
#ifndef RF_PHOTO_SOURCE_H
#define RF_PHOTO_SOURCE_H

#include <refocus/image.h>

#include "colour/transfer.h"
#include "image/chroma.h"
#include "image/format.h"
#include "image/planes.h"

/*
 * Planes normally hold all of the photo. In strip mode they hold a block of it at a time, and the
 * steps that look at all of the photo at once read the picture and the map that the caller gave.
 */
struct rf_photo_source {
    int width, height;
    const struct rf_transfer *transfer; /* between codes and the light of the blend in use */
    struct rf_light_q12 light;          /* channel[0] == NULL: strip mode */
    struct rf_disparity_q16 disparity;
    const struct rf_yuv *yuv;  /* NULL: a photo of R, G and B; else light is luminance alone */
    struct rf_yuv_codes codes; /* if yuv: the codes of the whole photo */
    const struct refocus_image *image; /* these three are for strip mode */
    const struct refocus_disparity *map;
    int code_step; /* rf_code_step() of the map */
};

static inline bool rf_has_planes(const struct rf_photo_source *photo)
{
    return photo->light.channel[0] != NULL;
}

#endif
