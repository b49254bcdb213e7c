/* picture.h: pixels of GEGL's buffers, in formats that the library takes. */
#ifndef RF_GEGL_PICTURE_H
#define RF_GEGL_PICTURE_H

#include <stdbool.h>
#include <gegl.h>
#include <refocus/refocus.h>
#include "settings.h"

/* How much of what a buffer holds is kept. */
enum rf_gegl_depth {
    RF_GEGL_CODES_8,  /* codes by the curve of sRGB, as they are */
    RF_GEGL_CODES_16, /* such codes of 16 bits */
    RF_GEGL_FLOATS,   /* linear light */
};

struct rf_gegl_format {
    enum rf_gegl_depth depth;
    bool has_alpha;
    const Babl *space;
    const Babl *babl; /* the format that comes out */
};

/* The format of what comes out for a photo of this one; NULL: floats. */
struct rf_gegl_format rf_gegl_format_of(const Babl *photo, const Babl *space);

/* A photo out of a buffer, and memory for what comes out, to be freed with picture_free(). The
 * second may lie in the first. */
struct rf_gegl_picture {
    struct refocus_image photo, out;
};

/* false: there is not enough memory, and nothing is to be freed. */
bool rf_gegl_picture_read(struct rf_gegl_picture *picture, GeglBuffer *buffer,
                          const GeglRectangle *whole, const GeglRectangle *part,
                          const struct rf_gegl_format *format, enum rf_gegl_light light);
void rf_gegl_picture_free(struct rf_gegl_picture *picture);

/* The samples of a depth map, NaN where its alpha is 0, to be freed; NULL: not enough memory. */
float *rf_gegl_depth_read(GeglBuffer *buffer, const GeglRectangle *whole,
                          enum rf_gegl_values values);

#endif
