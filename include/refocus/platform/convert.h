/** @file platform/convert.h  Frames of cameras as pictures and depth maps for the core.
 *
 * Part of librefocus-capture. A converter holds the rows and tables that it works with: one thread
 * at a time may call into one.
 *
 * Frames are those of a source, or made by the program: see struct refocus_frame. One with fields
 * that this library does not know and that are not 0 is REFOCUS_ERR_UNSUPPORTED, and one whose
 * struct_size is out of its range REFOCUS_ERR_ARGUMENT.
 */
#ifndef REFOCUS_PLATFORM_CONVERT_H
#define REFOCUS_PLATFORM_CONVERT_H

#include <stdint.h>
#include <refocus/depth.h>
#include <refocus/image.h>
#include <refocus/platform/source.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A converter. Opaque. */
struct refocus_converter;

/** @return REFOCUS_OK or REFOCUS_ERR_MEMORY. Ended by refocus_converter_destroy(). */
REFOCUS_API int refocus_converter_create(struct refocus_converter **converter);

/** Free a converter and set the handle to NULL. A NULL handle is fine. */
REFOCUS_API void refocus_converter_destroy(struct refocus_converter **converter);

/**
 * The format that the core takes a frame's pixels in as they are: one with Y, U and V;
 * REFOCUS_FORMAT_NONE for what has to become RGB8 first. UYVY becomes YUYV.
 * Thread-safe.
 */
REFOCUS_API uint32_t refocus_frame_image_format(uint32_t frame_format);

/**
 * Find that format of a frame, for which a JPEG picture is looked at: 4:2:0 of even sides is
 * decoded as REFOCUS_FORMAT_I420, 4:2:2 of even width as REFOCUS_FORMAT_YUYV.
 * REFOCUS_FORMAT_NONE also for a damaged one, for a build without JPEG, without memory and for
 * wrong arguments.
 */
REFOCUS_API uint32_t refocus_convert_image_format(struct refocus_converter *converter,
                                                  const struct refocus_frame *frame);

/**
 * A frame of such a format, copied, or of MJPEG decoded. Reads each row of each plane once, whole
 * and in order: camera memory may be uncached.
 *
 * @param out  of the frame's size and of refocus_convert_image_format(); its matrix and
 *             range are set to the frame's, or to those of JPEG: BT.601 in the full range
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_UNSUPPORTED (refocus_convert_image_format()
 * says none), REFOCUS_ERR_FORMAT (a damaged JPEG), REFOCUS_ERR_MEMORY
 */
REFOCUS_API int refocus_convert_copy(struct refocus_converter *converter,
                                     const struct refocus_frame *frame, struct refocus_image *out,
                                     struct refocus_reason *reason);

/**
 * A frame as RGB8. Reads each row of each plane once, from the first to the last, in
 * whole rows: camera memory may be uncached. Y, U and V become R, G and B by BT.601 or
 * BT.709 as the frame says, each within 1 of the real value.
 *
 * @param out  RGB8 of the frame's size
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT (size or format of @p out, a stride below a
 *         row), REFOCUS_ERR_FORMAT (a damaged JPEG, or one of another size),
 *         REFOCUS_ERR_UNSUPPORTED (a format this build cannot convert),
 *         REFOCUS_ERR_MEMORY
 */
REFOCUS_API int refocus_convert_rgb8(struct refocus_converter *converter,
                                     const struct refocus_frame *frame,
                                     const struct refocus_image *out,
                                     struct refocus_reason *reason);

/**
 * The samples of a depth frame (GREY, Y16 or Z16), copied in the same way.
 *
 * @param samples  receives width x height values in the machine's byte order, packed;
 *                 8-bit ones are multiplied by 257
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_UNSUPPORTED (a colour format)
 */
REFOCUS_API int refocus_convert_samples(struct refocus_converter *converter,
                                        const struct refocus_frame *frame, uint16_t *samples,
                                        struct refocus_reason *reason);

/** A pinhole camera: pixel (x, y) of a point (X, Y, Z) is (fx X/Z + cx, fy Y/Z +
 *  cy). The struct is complete. */
struct refocus_pinhole {
    int32_t width, height;
    double fx, fy, cx, cy;
};

/** The position of the colour camera: a point of the depth camera, in metres, is turned by rotation
 * (rows) and then shifted. The struct is complete. */
struct refocus_calibration {
    struct refocus_pinhole depth, colour;
    double rotation[9];
    double translation_m[3];
};

/**
 * Register depth onto colour: warp every sample to the pixel of the colour camera that
 * sees it, the nearer one where two meet. A sample covers as many pixels as its share
 * of the picture; pixels that no sample reaches stay 0 (unknown).
 *
 * @param samples          calibration->depth.width x height distances, packed; 0 =
 *                         unknown
 * @param metres_per_unit  > 0
 * @param out              receives calibration->colour.width x height distances, packed
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT. Thread-safe.
 */
REFOCUS_API int refocus_register_depth(const struct refocus_calibration *calibration,
                                       const uint16_t *samples, double metres_per_unit,
                                       uint16_t *out);

#ifdef __cplusplus
}
#endif
#endif
