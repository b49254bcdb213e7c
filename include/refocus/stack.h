/** @file stack.h  Depth and an all-in-focus photo from pictures at several focus distances, or at
 *  several apertures. */
#ifndef REFOCUS_STACK_H
#define REFOCUS_STACK_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <refocus/image.h>
#include <refocus/sized.h>
#include <refocus/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A focus stack. Opaque; one thread at a time may call into it. */
struct refocus_stack;

/** Frames of a stack. */
enum { REFOCUS_STACK_LEAST_FRAMES = 2, REFOCUS_STACK_MOST_FRAMES = 32 };

/** How to treat frames that do not lie on each other. */
enum refocus_stack_align {
    REFOCUS_STACK_ALIGN_SIMILARITY, /**< scale (the focus breathes), shift and rotation (the hand
                                         shakes) are found and undone; the default */
    REFOCUS_STACK_ALIGN_NONE,       /**< frames are taken as they are */
    REFOCUS_STACK_ALIGN_COUNT
};

/** The order of focus of frames without positions. */
enum refocus_stack_order {
    REFOCUS_STACK_ORDER_ADDED,  /**< they follow each other as they are added, the farthest focus
                                     first; the default */
    REFOCUS_STACK_ORDER_FOUND,  /**< sharpness tells it, and edges, and what lies lower, which of
                                     its ends is far (see `direction` of the result). Where they do
                                     not, the order or its reverse is taken, whichever has more
                                     pairs of frames as they were added. Wrong where most blocks
                                     hold two depths: a fence blurred over all that is behind it */
    REFOCUS_STACK_ORDER_EITHER, /**< they follow each other as they are added. Edges, and what lies
                                     lower, tell which end is far; where they do not, it is the
                                     first */
    REFOCUS_STACK_ORDER_COUNT
};

/** The setting of the lens that differs between the frames. */
enum refocus_stack_kind {
    REFOCUS_STACK_FOCUS,            /**< the focus; the default */
    REFOCUS_STACK_APERTURE_NEAREST, /**< the aperture, and the nearest surface is in focus: how much
                                         a surface is blurred tells how far it is from the focus,
                                         but not on which side */
    REFOCUS_STACK_APERTURE_FARTHEST, /**< the aperture, and the farthest surface is in focus */
    REFOCUS_STACK_KIND_COUNT
};

/** How to work. Start from refocus_stack_params_default(). */
struct refocus_stack_params {
    uint32_t struct_size; /**< sizeof(struct refocus_stack_params) */
    int32_t width;        /**< pixels of each frame, 16 to REFOCUS_MAX_SIDE */
    int32_t height;       /**< pixels of each frame, 16 to REFOCUS_MAX_SIDE */
    int32_t frames;       /**< how many will be added, REFOCUS_STACK_LEAST_FRAMES to
                               REFOCUS_STACK_MOST_FRAMES */
    int32_t reference;    /**< the result has the geometry of this frame, 1 to frames in the order
                               that they are added in; 0 = the one in the middle of the focus */
    uint32_t align;       /**< enum refocus_stack_align */
    uint32_t order;       /**< enum refocus_stack_order; frames with positions go by those */
    int32_t threads;      /**< 1 to 64, which end with each call; 0 = one for each processor */
    uint32_t kind;        /**< enum refocus_stack_kind; of apertures, the photo is the frame of the
                               smallest one: `reference` is 0, and `order` is not used */
};

static inline struct refocus_stack_params
refocus_stack_params_default(int32_t width, int32_t height, int32_t frames)
{
    struct refocus_stack_params params;

    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    params.width = width;
    params.height = height;
    params.frames = frames;
    return params;
}

/** Results of refocus_stack_finish(). All pictures have the size of the frames and are the
 *  caller's; any may be NULL. Start from refocus_stack_result_default(). */
struct refocus_stack_result {
    uint32_t struct_size; /**< sizeof(struct refocus_stack_result) */
    uint32_t reserved;    /**< 0 */
    uint8_t *photo;       /**< all in focus: R, G, B, 3 bytes a pixel */
    ptrdiff_t photo_stride;
    uint16_t *disparity; /**< 65535 = the nearest focus of the stack, 0 = the farthest, in between
                            in proportion to the positions; the address is even */
    ptrdiff_t disparity_stride; /**< bytes; even */
    uint8_t *confidence;        /**< 255 = measured, 0 = filled from what is around */
    ptrdiff_t confidence_stride;
    float measured; /**< receives the share of pixels whose depth was measured, 0 to 1; near 0 where
                         frames are alike or show nothing but flat colour */
    float moved;    /**< receives how far the farthest corner of a frame was moved, in pixels */
    float disorder; /**< receives the share of measured samples whose sharpness has two peaks over
                         the frames: hardly any in a stack, most where the order or the positions
                         are wrong. A reversed order has no more than the right one: see `direction`
                     */
    float moving;   /**< receives the share of the photo where something moved between the frames:
                         those that differ from the reference are left out there, and its depth is
                         filled from around it */
    float order_margin; /**< receives how sure an order is that was found: how much deeper the
                             valleys between peaks of sharpness would be in the next best one, a
                             block of the picture, in parts of its sharpest frame. Below 0.01 it
                             may be wrong; 1 where there was nothing to find */
    float alike; /**< receives the least correlation of the luminance of a frame, as it was aligned,
                      with its neighbour's, the greatest of three scales: 0.8 and more in stacks;
                    where it is below 0.5 the camera was moved too far, or frames show different
                    places */
    int32_t reference; /**< receives the number of the frame whose geometry the result has */
    /** Receives the numbers of the frames, from 1, from the farthest focus to the nearest; 0 after
     *  them. */
    uint8_t order[REFOCUS_STACK_MOST_FRAMES];
    float direction; /**< receives which end of the order that frames were added in, or that was
                          found, is far, by the edges between surfaces, which are as blurred as the
                          nearer one is, and where these say little, or less than what lies lower
                          and the opposite of it, by that as well, which is nearer in most pictures:
                          -1 to 1. 1/25 and more: the first frame; -1/25
                          and less: the last, and the order is its reverse. In between they do not
                          tell. 0 where the order was not to be told */
    float blur; /**< receives, of apertures, the blur radius in the frame of the widest one of what
                     is farthest from the focus, in pixels: K of its depth of field; else 0 */
    uint32_t by_rows; /**< receives 1 where edges say little or are outweighed, so that `direction`
                         is by what lies lower, too; else 0. That is doubtful where no ground is
                         seen: 16 of 16 photos that it was chosen by and tried with were right, an
                         engraved surface through a macro lens was wrong */
    uint32_t matched; /**< receives how many frames got the exposure or the white of the reference
                       */
    float exposure;   /**< receives how much their light was of the reference's, of the frame and
                           the channel that differ most: 1/4 to 2; 1 where `matched` is 0 */
    const struct refocus_image *light; /**< receives the light of `photo`, which is not NULL then,
                           of a stack of kind REFOCUS_STACK_FOCUS: REFOCUS_FORMAT_RGB_HALF or
                           REFOCUS_FORMAT_RGB_FLOAT, linear, 1 = white. What is clipped in the photo
                           is above 1 where frames of another focus tell by how much. NULL: none */
};

static inline struct refocus_stack_result refocus_stack_result_default(void)
{
    struct refocus_stack_result result;

    memset(&result, 0, sizeof result);
    result.struct_size = sizeof result;
    return result;
}

/**
 * Make an empty stack. It takes all its memory here: for each frame 3 bytes a pixel and 2 a
 * sample of the map that the work is done at, which has at most 3 million samples; 3 more a sample
 * for each depth, 13 to 17 with nine frames and fewer, their number rounded up to 16 or 24, else
 * one for each frame, rounded up to 16, 24 or 32; some 10 a sample and 3 a pixel; for each thread
 * 12 a frame and sample of a row. Nine frames of 1920x1080 take 276 MB, of 4000x3000 665 MB. Of
 * apertures there are at most 960 samples along the longer side, some 100 bytes each: two frames of
 * 4000x3000 take 154 MB.
 *
 * @param stack  receives it, or NULL on an error
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_MEMORY, REFOCUS_ERR_SIZE (it would need
 *         more memory than can be addressed), REFOCUS_ERR_UNSUPPORTED (a field of a newer library)
 */
REFOCUS_API int refocus_stack_create(struct refocus_stack **stack,
                                     const struct refocus_stack_params *params);

/** End a stack and set the handle to NULL; a NULL handle is fine. */
REFOCUS_API void refocus_stack_destroy(struct refocus_stack **stack);

/**
 * Add the next frame. Its pixels are copied.
 *
 * @param frame     of R, G and B, 8 bits a channel, of the stack's size. Exposure and white
 *                  balance may differ: see refocus_stack_finish().
 * @param position  of the focus in dioptres, 1 / metres, or any number that is proportional to them
 *                  up to an offset: larger = nearer. NAN if it is not known: frames without
 *                  positions are taken for equally far apart, in the order of enum
 *                  refocus_stack_order. Either all frames have one or none has. Of apertures, their
 *                  diameters: 1 / f-number, or what is proportional to it, above 0; NAN for both of
 *                  two frames, of which the sharper one then has the smaller aperture.
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT (not an image of that size, a format of Y, U and V,
 *         an infinite position, one that another frame has, one where others had none, an aperture
 *         of 0 and less, more than two without), REFOCUS_ERR_UNSUPPORTED (a format of more than 8
 *         bits), REFOCUS_ERR_STATE (there are as many as were announced), REFOCUS_ERR_THREAD; on
 *         an error the stack is as it was
 */
REFOCUS_API int refocus_stack_add(struct refocus_stack *stack, const struct refocus_image *frame,
                                  double position);

/**
 * Make depth and the photo. An order that is wanted is found first: the one in which the sharpness
 * of blocks, 144 along the longer side, has the fewest and shallowest valleys between two peaks;
 * the order that frames were added in stays where it is as good. With E the sharpness of a frame,
 * the sum of absolute second differences over one and two pixels, and E_k the mean of its square
 * over a Gaussian of 1.4 samples, and that over squares of 9 and 17, frame k costs
 *
 *     sum over the three of (max E - E_k) / (max E + noise)
 *
 * at a sample. Costs are aggregated along eight directions (semi-global matching, Hirschmueller
 * 2008), where steps of depth are cheaper across edges of the photo; the least one, with a parabola
 * through its neighbours, is the depth.
 *
 * With nine frames and fewer, depths between frames have costs, too: with s_k the share of frame k
 * in the sum of all E_k, and x_k the steps between its focus and the depth, a depth costs
 *
 *     sum of abs(s_k - m_k) / 2,  m_k in proportion to 1 / (1 + rho x_k^2)
 *
 * in place of the above, by the best of six rho. Two frames have one rho for all of the photo:
 * their focus should be on the nearest and the farthest surface.
 *
 * Frames of another exposure or white than the reference's get those of it, a channel's gain being
 * the median over blocks of the picture, 24 across, of the ratio of mean light (sRGB), of blocks
 * that are neither dark nor clipped nor vary by more than 3/10; differences below 1/50 are left.
 * Where n of them have quartiles that are apart by more than sqrt(n) / 20 of the median, in any
 * channel, blocks that vary count as well, and differences below 1/10 are left; where these do not
 * agree either, or the light is above twice that of the reference or below a quarter, frames
 * stay as they are.
 *
 * Where the mean of colour over a window, a tenth of the photo wide, is another one than in the
 * reference, something has moved: such a frame is not used there, and depth is filled from around
 * it. A blur wider than the window may be taken for movement; what moves and has the colour of what
 * is behind it is not seen.
 *
 * In the photo a frame fades into the next one, towards the reference, beside such places, and over
 * a 128th of the longer side where it ends before the photo does.
 *
 * A sample is sure where the least sharp frame has less than half of the E_k of the sharpest: noise
 * is alike in all. Each sample takes the depth of most of the sure ones around it, on its side of
 * the photo's edges. So what is flat, clipped or grainy takes the depth of what is around it. The
 * less sure a sample is, the more it becomes the mean of depth around it, weighted by how sure that
 * is and not across edges of the photo (normalised convolution, Knutsson & Westin 1993, with a
 * recursive filter as in Gastal & Oliveira 2011): from one surface to the next without a step. The
 * noise of the frames is measured where sharpness goes up and down from frame to frame, and less
 * than it is neither sure nor an edge.
 * Integer arithmetic: the same bytes on every processor and with any number of threads.
 *
 * Windows of sharpness take the silhouette of a surface for part of what is behind. So where depths
 * that are a quarter of all apart lie within 8 samples (not with two frames), edges of the frame
 * that is focused on the nearer one count, and votes are counted once more, those for the nearer
 * side by half. With more than three frames depth along silhouettes is then the median of 9 x 9
 * samples, weighted by how alike their colours are (Ma et al. 2013).
 *
 * In the photo, the blur of nearer surfaces lies over what is in focus behind. With F and A the
 * light and the coverage of the pixels around, each spread over its circle of confusion, a pixel
 * with A up to 3/4 becomes (I - F) / (1 - A) in linear light, of sRGB; each channel keeps a quarter
 * of its light. Where what is nearer is clipped, the pixel is that of the frame that is focused on
 * it. The blur radius is that of ten, up to a fortieth of the longer side for the whole range, by
 * which the photo predicts the frames best away from depth edges, and a parabola through its
 * neighbours; if it leaves more than three
 * quarters of the squared error that no blur leaves, the photo stays as it is. Noise and JPEG take
 * a little from what is clipped, by which renderers tell how much light was lost: with m the mean
 * of the codes of a channel within two pixels that are above 242, one of them, w, becomes
 * w + (255 - w) t u with t = (m - 250) / 3 and u = (w - 242) / 8, both from 0 to 1.
 *
 * Frames of several apertures differ by blur alone. The narrowest, spread in linear light (sRGB)
 * over discs of 0 to 23 samples, n r_k of label n, is compared with each other one, r_k^2 = (a_k^2
 * - a_0^2) / (a_widest^2 - a_0^2) with a the diameters: depth from defocus (Ens & Lawrence 1993).
 * With E_n the mean over frames and channels of the absolute difference in codes, and M_n that of
 * its square over squares of 1, 9 and 17 samples, a label costs
 *
 *     sum over the three of (M_n - min M) / (max M + noise)
 *
 * Costs are aggregated and depth is filled as above; sure is where the least M_n is below half of
 * the greatest. Means over squares of 49 samples are made the same before: other exposures do not
 * matter, nor light that falls off towards the corners. Clipped places of the wider frames are not
 * compared. Samples are 1/960 of the longer side at least, and twice as large, twice more and so
 * on while more than 1/20 of the sure ones have the two largest blurs; what has them then is not
 * sure. The range ends where 1/50 of the sure ones lie beyond. Pixels get the depth of the four
 * samples around, by nearness and colour (Kopf et al. 2007). Depth is wrong where something moves
 * between the frames; the photo is one of them.
 *
 * What is clipped where it is in focus is below white where it is blurred. So the light of the
 * photo is L + x, with L its codes undone by sRGB and x >= 0 what it lacks where a code is 250 or
 * more, or 230 and another channel 250: the x by which L + x, each pixel spread over its circle of
 * confusion, predicts the frames best, of pixels as of squares that are 1/480 of the longer side at
 * least, where what is hidden or beyond the border is as bright as L beside it. It is found by four
 * rounds of simultaneous iterative reconstruction (SIRT, Gilbert 1972), in which frames that are
 * clipped tell that light is not below white, and which become finer, so that the middle of a large
 * surface takes what is found around it. Where no blur radius explains the frames, and of two
 * frames, x is 0. For light the call takes 115 bytes a square, and 8 for each frame, which it gives
 * back: with nine frames at most 43 MB.
 *
 * A stack is finished once: what aligns its frames overwrites them.
 *
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_STATE (fewer than two frames, no reference
 *         yet, or finished before), REFOCUS_ERR_THREAD, REFOCUS_ERR_MEMORY (for light),
 *         REFOCUS_ERR_UNSUPPORTED; on an error nothing is written, and the stack is as it was
 */
REFOCUS_API int refocus_stack_finish(struct refocus_stack *stack,
                                     struct refocus_stack_result *result);

#ifdef __cplusplus
}
#endif
#endif
