/** @file platform/sink.h  Where refocused frames go.
 *
 * Part of librefocus-capture. A sink is opened by name:
 *
 *     null                   nowhere, for timing
 *     window                 a window by SDL2, or the whole screen of a console (KMS)
 *     v4l2:/dev/video9       a V4L2 output node (virtual camera)
 *     pipewire:[NAME]        a camera of PipeWire, which browsers and calls list by its
 *                            name, else as "Refocused camera"
 *     y4m:FILE               a YUV4MPEG2 stream: RGB8 becomes 4:2:0 of limited range,
 *                            BT.709 from a width of 1280 or more than 576 rows on, else
 *                            BT.601, as players take it; pictures of Y, U and V keep their codes,
 * 4:2:0 or 4:2:2. The rate is the simplest fraction that is it to 13 digits, such as 30000:1001
 *     raw:FILE[,FORMAT]      frames without a header, one behind the other, rows without
 *                            gaps, as the source raw: reads them. FORMAT is RGB24
 *                            (default), BGR24, RGBX, BGRX, NV12, NV21, YUV420, YUYV or
 *                            UYVY; or `own`: that of the pictures, RGB24 of RGB8.
 *                            RGB8 becomes limited range, of the matrix as in y4m, where it
 *                            is one of Y, U and V; pictures of Y, U and V keep their codes, but
 *                            those of U and V where 4:2:0 becomes 4:2:2 (rows twice)
 *                            or 4:2:2 becomes 4:2:0 (the mean of two rows)
 *     frames-%04d.png        a picture each: .png .jpg .ppm; counted from 0
 *
 * FILE may be "-" for standard output, or a pipe. Of raw: the last comma of the name
 * begins the format, unless a dot or a slash follows it. One thread at a time may call into a sink.
 * The window has a thread of its own, which must be the only one of the process that uses SDL's
 * video.
 */
#ifndef REFOCUS_PLATFORM_SINK_H
#define REFOCUS_PLATFORM_SINK_H

#include <stdint.h>
#include <refocus/image.h>
#include <refocus/platform/file.h>
#include <refocus/platform/source.h>
#include <refocus/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A sink. Opaque. */
struct refocus_sink;

/**
 * Whether a sink would write over a file that is read. Sinks of files begin them anew when they are
 * started, so ask before that.
 *
 * @param sink   as for refocus_sink_open()
 * @param input  a source as for refocus_source_open(), or the name of a file
 * @return 1: both names lead to one file that is there, or two patterns of pictures have one in
 *         common; 0: they do not, or one of them is NULL; REFOCUS_ERR_MEMORY. Links are followed,
 *         pipes and devices do not count. Thread-safe.
 */
REFOCUS_API int refocus_sink_overwrites(const char *sink, const char *input);

/**
 * Open a sink. Nothing is written yet: a file that is there stays as it is until the sink is
 * started, and one that is made is removed by refocus_sink_close() if it never was.
 *
 * @param sink    receives the sink, or NULL on an error; ended by refocus_sink_close()
 * @param reason  receives words on an error; may be NULL, as in all functions here
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT (the name), REFOCUS_ERR_UNSUPPORTED,
 *         REFOCUS_ERR_GONE, REFOCUS_ERR_BUSY, REFOCUS_ERR_PERMISSION, REFOCUS_ERR_IO,
 *         REFOCUS_ERR_MEMORY
 */
REFOCUS_API int refocus_sink_open(struct refocus_sink **sink, const char *name,
                                  struct refocus_reason *reason);

/**
 * Say where the pictures come from, before refocus_sink_start(): `y4m` writes pixel_aspect into its
 * header, and chroma_place for pictures of 4:2:0. Nothing else of the mode counts. Without it
 * pixels are square, and U and V lie in the centre.
 *
 * @param mode  as refocus_source_start() gave it
 * @return REFOCUS_OK; REFOCUS_ERR_ARGUMENT: NULL, or one of these numbers is out of its range
 */
REFOCUS_API int refocus_sink_set_mode(struct refocus_sink *sink,
                                      const struct refocus_source_mode *mode);

/**
 * Set what is asked while a picture of a sequence is written, as `cancelled` of struct
 * refocus_write_options: other than 0 ends refocus_sink_write() with REFOCUS_ERR_CANCELLED, and of
 * this picture no file is left; its number is not used again. Other sinks write a frame whole. Not
 * while refocus_sink_write() runs in another thread.
 *
 * @param cancelled  called in the thread of refocus_sink_write(); NULL = nobody is asked
 * @return REFOCUS_OK; REFOCUS_ERR_ARGUMENT: there is no sink
 */
REFOCUS_API int refocus_sink_set_cancelled(struct refocus_sink *sink, int (*cancelled)(void *user),
                                           void *user);

/**
 * Say what will come: before the first frame, and whenever the size changes.
 *
 * @param fps  frames a second, of which 10000 at most count; 0 = 30
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_UNSUPPORTED (a stream of one size has
 * begun, or the device has no such size), and as refocus_sink_open()
 */
REFOCUS_API int refocus_sink_start(struct refocus_sink *sink, int width, int height, double fps,
                                   struct refocus_reason *reason);

/**
 * Whether pictures of a format can be written as they are, without a detour by R, G
 * and B: 0 or 1. RGB8 is taken by every sink; formats of Y, U and V by `null` and
 * `y4m`, by `raw` where its FORMAT is `own` or one of Y, U and V, and by `v4l2` where
 * the node has such a format: the same one, else one with as many samples, else any;
 * by `pipewire` all, of which those who look choose an order.
 */
REFOCUS_API int refocus_sink_takes(struct refocus_sink *sink, uint32_t format);

/**
 * refocus_sink_start() for pictures like this one: of its size, format, matrix and
 * range. A format that the sink does not take is REFOCUS_ERR_UNSUPPORTED.
 */
REFOCUS_API int refocus_sink_start_image(struct refocus_sink *sink,
                                         const struct refocus_image *like, double fps,
                                         struct refocus_reason *reason);

/**
 * Write a frame of the size and format that was announced.
 *
 * @param image  RGB8, or as refocus_sink_start_image() was told; not kept
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT (another size or format, a plane that is
 *         NULL, a stride below a row), REFOCUS_ERR_STATE, REFOCUS_ERR_GONE (the reader
 *         closed the pipe, the device is unplugged), REFOCUS_ERR_TIMEOUT (the device took
 *         none for a second, or of `pipewire:` not yet the ones before: the frame is
 *         dropped), REFOCUS_ERR_END (the user closed the
 *         window, or pressed Escape or q), REFOCUS_ERR_IO, REFOCUS_ERR_MEMORY,
 *         REFOCUS_ERR_CANCELLED (refocus_sink_set_cancelled()). Never raises SIGPIPE.
 */
REFOCUS_API int refocus_sink_write(struct refocus_sink *sink, const struct refocus_image *image,
                                   struct refocus_reason *reason);

/**
 * Write what is left, close, free, set the handle to NULL. A NULL handle is fine.
 * @return REFOCUS_OK, or what refocus_sink_write() returns when the rest was lost
 */
REFOCUS_API int refocus_sink_close(struct refocus_sink **sink, struct refocus_reason *reason);

#ifdef __cplusplus
}
#endif
#endif
