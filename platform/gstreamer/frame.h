/* frame.h: frames of GStreamer as pictures of the library, without a copy. */
#ifndef RF_GSTREAMER_FRAME_H
#define RF_GSTREAMER_FRAME_H

#include <stdbool.h>
#include <gst/video/video.h>
#include <refocus/refocus.h>

#define RF_GST_FORMATS_YUV "NV12, NV21, I420, YV12, YUY2, GRAY8"
#define RF_GST_FORMATS_RGB "RGB, BGR, RGBA, BGRA, RGBx, BGRx"
#if G_BYTE_ORDER == G_LITTLE_ENDIAN
#define RF_GST_FORMATS_DEEP "P010_10LE"
#else
#define RF_GST_FORMATS_DEEP "P010_10BE"
#endif

/* The chroma that frames of grey have to the renderer, which knows none without. */
struct rf_gst_chroma {
    uint8_t *memory;
    size_t bytes;
};

/* Map a buffer as a frame of these caps. False where it is none: it has too few bytes, its metadata
 * lays rows out beyond its memory or within another, or its memory cannot be mapped. */
bool rf_gst_frame_map(GstVideoFrame *frame, const GstVideoInfo *info, GstBuffer *buffer,
                      GstMapFlags flags);

/* The picture that a frame holds, in the frame's memory. Of GRAY8 the planes of U and V are those
 * of `chroma`, set to neutral; false: there is no memory for them. */
bool rf_gst_picture(const GstVideoFrame *frame, struct rf_gst_chroma *chroma,
                    struct refocus_image *picture);
/* Whether it has more than 8 bits a channel. */
bool rf_gst_is_deep(const struct refocus_image *picture);
void rf_gst_chroma_end(struct rf_gst_chroma *chroma);

#endif
