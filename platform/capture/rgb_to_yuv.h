/* rgb_to_yuv.h: RGB8 pictures become frames in the formats that sinks want. */
#ifndef RF_CAPTURE_RGB_TO_YUV_H
#define RF_CAPTURE_RGB_TO_YUV_H

#include <stdbool.h>
#include <refocus/platform/source.h>

/* An RGB8 picture as a frame of its own matrix, limited range, each chroma sample the mean of its
 * pixels; or as packed RGB. The frame's planes are written to. */
void rf_encode(const struct refocus_image *image, const struct refocus_frame *frame);
bool rf_can_encode(uint32_t format);

#endif
