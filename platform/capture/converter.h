/* converter.h: what a converter holds, and frames of MJPEG by libjpeg-turbo. */
#ifndef RF_CAPTURE_CONVERTER_H
#define RF_CAPTURE_CONVERTER_H

#include <refocus/platform/convert.h>

struct refocus_converter {
    uint8_t *row[3]; /* copies of the rows of each plane */
    size_t size[3];
    void *jpeg;      /* tjhandle */
    uint8_t *planes; /* a decoded picture of 4:2:2 in planes */
    size_t planes_size;
};

/* The frame is one of MJPEG, the reason never NULL, and the picture of the frame's size and one of
 * the format below, with room for each plane. */
int rf_convert_jpeg_rgb8(struct refocus_converter *converter, const struct refocus_frame *frame,
                         const struct refocus_image *out, struct refocus_reason *reason);
int rf_convert_jpeg_yuv(struct refocus_converter *converter, const struct refocus_frame *frame,
                        struct refocus_image *out, struct refocus_reason *reason);
/* The format that keeps its samples of Y, U and V, or REFOCUS_FORMAT_NONE. */
uint32_t rf_jpeg_image_format(struct refocus_converter *converter,
                              const struct refocus_frame *frame);
void rf_free_jpeg(struct refocus_converter *converter);

#endif
