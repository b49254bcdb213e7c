/** @file depth_edges.h  Edges of a disparity map where the photo has them. */
#ifndef REFOCUS_DEPTH_EDGES_H
#define REFOCUS_DEPTH_EDGES_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <refocus/image.h>
#include <refocus/sized.h>
#include <refocus/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/** How to work. Start from refocus_depth_edges_params_default(). */
struct refocus_depth_edges_params {
    uint32_t struct_size; /**< sizeof(struct refocus_depth_edges_params) */
    int32_t threads;      /**< 1 to 64; 0 = one for each processor */
    uint32_t cpu;         /**< enum refocus_cpu of render.h; 0 = the best there is */
    uint32_t reserved;    /**< 0 */
};

static inline struct refocus_depth_edges_params refocus_depth_edges_params_default(void)
{
    struct refocus_depth_edges_params params;

    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    return params;
}

/** The findings of refocus_depth_edges(), which are written as far as struct_size goes. Lengths are
 *  pixels of the photo. Start from refocus_depth_edges_report_default(). */
struct refocus_depth_edges_report {
    uint32_t struct_size; /**< sizeof(struct refocus_depth_edges_report), set by the caller */
    float softness;       /**< standard deviation of the Gaussian that would make such edges of
                               sharp ones; 0.4 = sharp, 0 = there are too few edges to tell */
    float on_photo;       /**< share of the edges that lie on the photo's, 0 to 1, in the end */
    float grown;          /**< near surfaces were made smaller by so much; < 0: larger */
    float shift_x;        /**< the whole map was moved to the right by so much */
    float shift_y;        /**< the whole map was moved down by so much */
    uint32_t bent;        /**< 1: edges were moved block by block */
    uint32_t parted;      /**< 1: pixels of ramps were given to one of two surfaces */
    float changed;        /**< share of the pixels that differ by 1/255 or more from the map as
                               it was, brought to the photo's size by straight lines */
    float noise;          /**< standard deviation of the noise that was smoothed away, share of the
                               range, 0 to 1 */
    float specks;         /**< share of the samples that lay far off all of those around them, of
                               a map that was freed from such; 0 if they were too few */
};

static inline struct refocus_depth_edges_report refocus_depth_edges_report_default(void)
{
    struct refocus_depth_edges_report report;

    memset(&report, 0, sizeof report);
    report.struct_size = sizeof report;
    return report;
}

/**
 * Put the edges of a disparity map where the photo has them, for maps that are soft, coarse,
 * grown, shrunk, shifted or displaced by up to 5 pixels: those of phones, sensors and networks.
 *
 *   - Where the edges of the map do not lie on the photo's, what is common to all of them is
 *     undone, and then what is common to those of a block of 16 pixels; either only if they fit the
 *     photo clearly better then. A photo of something else can mislead it.
 *   - Each pixel of a ramp between two surfaces is given to the one that looks like it in the
 *     photo. Slopes and rounded things, which are longer ramps, stay.
 *   - Noise of 0.4 % of the range and more is smoothed away within surfaces. Where 0.4 % of the
 *     samples of a map of the photo's size are specks, by themselves far off all of those around
 *     them, each sample that is off the median of 5 x 5 takes that.
 *   - Wires and hair get back the disparity that a soft map mixed with what is behind them.
 *   - In a photo that is not sharp to the pixel, and in a still of more than 3 megapixels, pixels
 *     that mix both surfaces go to the nearer one, up to 3 beyond its edge: so its silhouette is as
 *     sharp as the photo when it is in focus, and no outline of it is left on what is in focus
 *     behind it.
 *
 * A map of the photo's size that is sharp and lies on the photo comes out as it is, to the code.
 * A small map whose samples were taken at points, as sensors do, and that lies on the photo is
 * brought to the photo's size by refocus_upsample(), and changed is 0. For a video
 * (REFOCUS_DEPTH_EDGES_STEADY) whether it does is not looked at, and on_photo is 0, too. Of large
 * photos with small maps the work is done at up to four times the map's size, and the rest by
 * refocus_upsample(). The result does not depend on threads or processor.
 *
 * @param photo   any format of 8 bits a channel, upright as the map is
 * @param map     covers the same view as the photo; see struct refocus_disparity
 * @param params  see struct refocus_depth_edges_params
 * @param out     receives 16-bit disparities of the photo's size, 65535 nearest; may not overlap
 *                the map
 * @param stride  bytes from a row of @p out to the next; even; may be negative
 * @param report  receives what was found; may be NULL
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_MEMORY (about 27 bytes a pixel of the
 *         size that the work is done at are needed, and 3 of the photo if it is Y, U, V),
 *         REFOCUS_ERR_SIZE, REFOCUS_ERR_UNSUPPORTED, REFOCUS_ERR_THREAD. On an error @p out holds
 *         nothing of use, and the report is untouched.
 *
 * Thread-safe.
 */
REFOCUS_API int refocus_depth_edges(const struct refocus_image *photo,
                                    const struct refocus_disparity *map,
                                    const struct refocus_depth_edges_params *params, uint16_t *out,
                                    ptrdiff_t stride, struct refocus_depth_edges_report *report);

#ifdef __cplusplus
}
#endif
#endif
