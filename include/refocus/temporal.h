/** @file temporal.h  Depth of video that does not flicker. */
#ifndef REFOCUS_TEMPORAL_H
#define REFOCUS_TEMPORAL_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <refocus/image.h>
#include <refocus/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A filter over the depth maps of a video. Opaque; one thread at a time may call into it, but
 *  for refocus_temporal_cancel(). */
struct refocus_temporal;

/** How to filter. Start from refocus_temporal_params_default(). */
struct refocus_temporal_params {
    uint32_t struct_size; /**< sizeof(struct refocus_temporal_params) */
    int32_t width;        /**< size of the maps, samples, 1 to REFOCUS_MAX_SIDE */
    int32_t height;       /**< size of the maps, samples, 1 to REFOCUS_MAX_SIDE */
    uint32_t reserved;    /**< 0 */
    float strength;       /**< share of the past where nothing changes, 0 (off) to
                               0.95 */
    float noise;          /**< largest difference between frames that is noise, share of
                               the range of disparities, 0 to 0.25 */
};

static inline struct refocus_temporal_params refocus_temporal_params_default(int32_t width,
                                                                             int32_t height)
{
    struct refocus_temporal_params params;

    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    params.width = width;
    params.height = height;
    params.strength = (float)0.85;
    params.noise = (float)0.03;
    return params;
}

/**
 * Make a filter. It takes all its memory, about 41 bytes a sample, here.
 *
 * @param filter  receives the filter, or NULL on an error
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_MEMORY
 */
REFOCUS_API int refocus_temporal_create(struct refocus_temporal **filter,
                                        const struct refocus_temporal_params *params);

/** End a filter and set the handle to NULL; a NULL handle is fine. */
REFOCUS_API void refocus_temporal_destroy(struct refocus_temporal **filter);

/**
 * End the refocus_temporal_run() that is running, if any, early: it returns REFOCUS_ERR_CANCELLED
 * within eight rows of samples. Has no effect on later calls. With NULL it does nothing.
 * Thread-safe.
 */
REFOCUS_API void refocus_temporal_cancel(struct refocus_temporal *filter);

/** Forget the past: after a gap, or a cut that no photo shows. With NULL it does nothing. */
REFOCUS_API void refocus_temporal_reset(struct refocus_temporal *filter);

/**
 * Say that disparities have another scale from the next map on, because z0 or z1 have
 * moved: what was d is now
 *
 *     scale d + offset,    scale = (1/z0 - 1/z1) / (1/z0' - 1/z1')
 *                          offset = (1/z1 - 1/z1') / (1/z0' - 1/z1')
 *
 * with the new range primed; what falls out of 0 to 1 is clamped.
 *
 * @param scale   above 0
 * @param offset  finite
 * @return REFOCUS_OK, or REFOCUS_ERR_ARGUMENT with the filter as it was
 */
REFOCUS_API int refocus_temporal_rescale(struct refocus_temporal *filter, double scale,
                                         double offset);

/**
 * Filter the next map. Blocks of 8 x 8 samples are followed from the last frame, by the
 * photo where there is one; with p the filtered disparity of the last frame at the
 * place that a sample d came from, and n the frames that it has been seen in,
 *
 *     out = d + k (1 - (d - p)^2 / noise^2) (p - d),    k = min(strength, n / (n + 1))
 *
 * while |d - p| < noise and the photo is alike in both places. Else out = d at once, so
 * that nothing trails behind what moves. But where the photo is alike and d jumps, as it does
 * beside edges, the last seven frames vote, each by how alike it is: p stays until another
 * surface leads it by half of all votes, or until no frame of seven knows it, and out is then
 * the mean of those that voted for the other. A block of which most lies elsewhere in this
 * frame and in the last is believed at once.
 *
 * A photo that shows another scene than the last one is a cut, and the past is forgotten: means
 * of 16 x 16 cells share less than a quarter of their contrast. A change of the exposure is none,
 * up to four times the contrast, nor is movement by up to half a cell a frame.
 *
 * The scale of disparities has to be the same for all frames: give
 * refocus_depth_to_disparity() the near_m and far_m (value_near and value_far) that it
 * reported for the first one, or say how it changes by refocus_temporal_rescale(). Integer
 * arithmetic: the same bytes on every processor.
 *
 * @param photo   the photo of this frame, of any format of integers and any size, whose
 *                brightness is compared: the upper 8 bits of codes as they are, of Y, U and V
 *                those of Y; NULL = by depth alone
 * @param map     width x height samples
 * @param out     receives width x height samples of 16 bits; may be the map's own
 *                memory
 * @param stride  bytes from a row of @p out to the next; even; may be negative
 * @return REFOCUS_OK, or, with @p out untouched, REFOCUS_ERR_ARGUMENT,
 *         REFOCUS_ERR_UNSUPPORTED with a photo of floats, or REFOCUS_ERR_CANCELLED, and the
 *         filter has forgotten the past then
 */
REFOCUS_API int refocus_temporal_run(struct refocus_temporal *filter,
                                     const struct refocus_image *photo,
                                     const struct refocus_disparity *map, uint16_t *out,
                                     ptrdiff_t stride);

#ifdef __cplusplus
}
#endif
#endif
