/** @file platform/opencv.h  Depth from two pictures or from one, by OpenCV.
 *
 * Part of librefocus-opencv, not of the core: pkg-config name `refocus-opencv`. A C
 * face: no exception gets out, and cv::setNumThreads() is left as it is.
 */
#ifndef REFOCUS_PLATFORM_OPENCV_H
#define REFOCUS_PLATFORM_OPENCV_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <refocus/image.h>
#include <refocus/sized.h>
#include <refocus/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Why something failed, in words that say what to do: one line, no full stop. The struct is
 *  complete. */
struct refocus_cv_reason {
    char text[256];
};

/** How the disparities of a pair are found. */
enum refocus_stereo_method {
    REFOCUS_STEREO_CHECKED = 0, /**< both ways; where they disagree by more than a
                                     pixel, in specks, and in patches far behind all else that
                                     are less than 1/500 of it, there is no value */
    REFOCUS_STEREO_PLAIN = 1,   /**< OpenCV's semi-global matching as it is: to compare
                                     with */
    REFOCUS_STEREO_WLS = 2,     /**< both ways, and filled by the weighted least squares
                                     filter of OpenCV contrib, from the module
                                     refocus-ximgproc */
};

/** The picture of a pair that comes first. */
enum refocus_stereo_order {
    REFOCUS_STEREO_LEFT_FIRST = 0,  /**< the left one */
    REFOCUS_STEREO_RIGHT_FIRST = 1, /**< the right one */
    REFOCUS_STEREO_ORDER_SEEN = 2,  /**< stripes of one picture tell, else the left one */
};

/** Votes on the order of a pair, `order` of struct refocus_stereo_report, are sure from here on. */
#define REFOCUS_STEREO_ORDER_SURE 0.15f

/** Stereo matching. Start from refocus_stereo_params_default(). */
struct refocus_stereo_params {
    uint32_t struct_size; /**< sizeof(struct refocus_stereo_params) */
    int32_t max_side;     /**< pictures are matched with a larger side of no more than this many
                               pixels, 64 at the least; default 1600 */
    float least_match;    /**< share of pixels that has to agree from left and right,
                               else the pair is refused; default 0.3 */
    uint32_t method;      /**< enum refocus_stereo_method */
    uint32_t order;       /**< enum refocus_stereo_order */
};

static inline struct refocus_stereo_params refocus_stereo_params_default(void)
{
    struct refocus_stereo_params params;

    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    params.max_side = 1600;
    params.least_match = (float)0.3;
    return params;
}

/** The result of the matching. Start from refocus_stereo_report_default(). */
struct refocus_stereo_report {
    uint32_t struct_size;  /**< sizeof(struct refocus_stereo_report), set by the caller */
    float vertical_offset; /**< pixels that the second picture lies lower in its middle; undone */
    float least, greatest; /**< disparities found, pixels of the first picture */
    float matched;         /**< share of pixels that agree from left and right */
    float order; /**< the picture that comes first, by stripes that one picture alone shows: -1 to
                      1; the left one above 0, the right one below, surely from
                      REFOCUS_STEREO_ORDER_SURE on. 0 where there are few stripes or both orders
                      are contradicted. Where the right one is taken for the first, `least` and
                      `greatest` have signs such that what is nearer has more */
    float turn;  /**< radians that the second picture is turned by, from right to down; undone */
    float grow;  /**< part of its size that the second picture is larger by; undone */
};

static inline struct refocus_stereo_report refocus_stereo_report_default(void)
{
    struct refocus_stereo_report report;

    memset(&report, 0, sizeof report);
    report.struct_size = sizeof report;
    return report;
}

/**
 * Disparities of a rectified stereo pair, in pixels of the first picture: a point at x
 * in it is at x - disparity in the second one, or at x + disparity if that is the left one.
 * Semi-global matching (Hirschmueller 2008), both ways; where they disagree by more than a pixel
 * there is NaN. The range of disparities is found at a reduced size, where from -8 to 24 % of the
 * width are searched, or what patches of the first picture that are found in the second one say.
 *
 * Pictures need not be rectified to the pixel: a shift, a turn and another scale of the second one,
 * by a fiftieth at the most, are told by patches of the first one, and undone.
 *
 * Exposures may differ: the darker picture is matched with the histogram of the brighter one.
 *
 * Beside a nearer surface each picture shows a stripe of what is behind that the other one does
 * not: the left picture on its left. Pairs in the other order have their stripes on the wrong side,
 * and stripes have the colour of what is behind.
 *
 * @param left, right  RGB8, of the same size, at least 64 x 32; the first one and the second one
 * @param disparity    receives width x height floats, larger = nearer
 * @param report       receives what was found, all 0 on an error; only its struct_size is read;
 *                     may be NULL
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_NO_DEPTH (the pictures do not
 *         match, or their disparities differ by less than a pixel), REFOCUS_ERR_MEMORY,
 *         REFOCUS_ERR_UNSUPPORTED (OpenCV refused; see the reason). On an error @p disparity holds
 * nothing of use. Thread-safe.
 */
REFOCUS_API int refocus_cv_stereo(const struct refocus_image *left,
                                  const struct refocus_image *right,
                                  const struct refocus_stereo_params *params, float *disparity,
                                  struct refocus_stereo_report *report,
                                  struct refocus_cv_reason *reason);

/** How a network wants its picture: value = (code - mean) scale, R G B. Start from
 *  refocus_network_default(). */
struct refocus_network {
    uint32_t struct_size;  /**< sizeof(struct refocus_network) */
    int32_t width, height; /**< size of its input, 32 to 2048 */
    float mean[3];         /**< codes 0..255 */
    float scale;           /**< default 1 */
    int32_t inverse;       /**< 1: its output grows with distance */
};

/** A network that takes the codes as they are, of an input whose size is still to be set. */
static inline struct refocus_network refocus_network_default(void)
{
    struct refocus_network network;

    memset(&network, 0, sizeof network);
    network.struct_size = sizeof network;
    network.scale = 1;
    return network;
}

/** Names of presets: "tcmonodepth", "midas-small", "depth-anything-small"; NULL ends them.
 *  Thread-safe. */
REFOCUS_API const char *refocus_cv_network_name(uint32_t index);

/**
 * A preset.
 *
 * @param network  receives it; only its struct_size is read
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT with @p network untouched. Thread-safe.
 */
REFOCUS_API int refocus_cv_network(uint32_t index, struct refocus_network *network);

/**
 * Take width and height from the shape of the input that an ONNX file states; a side
 * that is left open there, or no such shape, leaves what @p network holds.
 *
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_UNSUPPORTED (@p network has fields that
 *         this library does not know), REFOCUS_ERR_IO (no such file), REFOCUS_ERR_FORMAT (the
 *         shape is beyond 32 to 2048). On an error @p network is untouched.
 */
REFOCUS_API int refocus_cv_network_fit(struct refocus_network *network, const char *model,
                                       struct refocus_cv_reason *reason);

/** Depth of one picture, without a unit. Start from refocus_estimate_default(). */
struct refocus_estimate {
    uint32_t struct_size;  /**< sizeof(struct refocus_estimate), set by the caller */
    int32_t width, height; /**< samples */
    uint32_t reserved;     /**< 0 */
    float *samples;        /**< packed, larger = nearer; freed by refocus_cv_estimate_free() */
};

static inline struct refocus_estimate refocus_estimate_default(void)
{
    struct refocus_estimate estimate;

    memset(&estimate, 0, sizeof estimate);
    estimate.struct_size = sizeof estimate;
    return estimate;
}

/**
 * Depth of one picture by a network in an ONNX file, larger = nearer.
 *
 * @param estimate  receives the depth, or NULL samples on an error; only its struct_size is read,
 *                  so that samples that it has are lost, not freed; ended by
 *                  refocus_cv_estimate_free()
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT (where it is the struct_size of @p estimate that is out
 *         of its range, that is untouched), REFOCUS_ERR_UNSUPPORTED (a struct has fields that this
 *         library does not know), REFOCUS_ERR_IO (no such file), REFOCUS_ERR_FORMAT (no network
 *         that OpenCV reads, or not one with this input), REFOCUS_ERR_MEMORY
 */
REFOCUS_API int refocus_cv_estimate(const struct refocus_image *photo, const char *model,
                                    const struct refocus_network *network,
                                    struct refocus_estimate *estimate,
                                    struct refocus_cv_reason *reason);

/** Free the samples and set them to NULL, their size to 0. With NULL, or a struct_size out of its
 *  range, it does nothing. */
REFOCUS_API void refocus_cv_estimate_free(struct refocus_estimate *estimate);

/** A network that is read once and run as often as wanted, as for a camera. Opaque; one thread at
 *  a time may call into it. */
struct refocus_estimator;

/**
 * Read a network.
 *
 * @param estimator  receives the network, or NULL on an error; ended by
 *                   refocus_cv_estimator_destroy()
 * @return as refocus_cv_estimate(), but that the network's input and output are not yet
 *         tried
 */
REFOCUS_API int refocus_cv_estimator_create(struct refocus_estimator **estimator, const char *model,
                                            const struct refocus_network *network,
                                            struct refocus_cv_reason *reason);

/** Depth of one picture, larger = nearer. @return as refocus_cv_estimate() */
REFOCUS_API int refocus_cv_estimator_run(struct refocus_estimator *estimator,
                                         const struct refocus_image *photo,
                                         struct refocus_estimate *estimate,
                                         struct refocus_cv_reason *reason);

/** Free a network and set the handle to NULL. A NULL handle is fine. */
REFOCUS_API void refocus_cv_estimator_destroy(struct refocus_estimator **estimator);

/**
 * Joint bilateral upsampling (Kopf et al. 2007) of a map of disparities to the photo's
 * size: each pixel p is the mean of the 5x5 samples q around it,
 *
 *     d(p) = sum w d(q) / sum w,  w = exp(-|p - q|^2 / 2) (exp(-|I(p) - I(q)|^2 / 2 s^2) + 1e-9)
 *
 * with |p - q| in samples, and I the photo, which a sample has at its middle. Beyond the
 * map its last samples go on. The core's
 * refocus_upsample() measures better and is faster: tests/depth.md compares them.
 *
 * Thread-safe; rows are shared out to OpenCV's threads (cv::setNumThreads()), the same bytes with
 * any number of them.
 *
 * @param sigma_range  s of the likeness, in codes, > 0
 * @param out          width x height, packed; undefined after an error
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_MEMORY, or
 *         REFOCUS_ERR_UNSUPPORTED where OpenCV gives up
 */
REFOCUS_API int refocus_cv_upsample(const struct refocus_image *photo,
                                    const struct refocus_disparity *map, float sigma_range,
                                    uint16_t *out, struct refocus_cv_reason *reason);

/** Ways of OpenCV to bring a map to the photo's size. */
enum refocus_cv_filter {
    REFOCUS_CV_BILINEAR = 0,        /**< means of four samples; the photo is not looked
                                         at */
    REFOCUS_CV_JOINT_BILATERAL = 1, /**< refocus_cv_upsample() with a sigma of a
                                         tenth */
    /* From OpenCV contrib: bilinear, then smoothed by the photo. */
    REFOCUS_CV_GUIDED = 2,               /**< guided filter (He et al. 2010) */
    REFOCUS_CV_FAST_GLOBAL = 3,          /**< fast global smoother (Min et al. 2014) */
    REFOCUS_CV_JOINT_BILATERAL_FULL = 4, /**< joint bilateral filter at full size */
};

/** Names of the filters: "bilinear", "joint-bilateral", "guided", "fast-global",
 * "joint-bilateral-full"; NULL ends them. */
REFOCUS_API const char *refocus_cv_filter_name(uint32_t filter);

/**
 * refocus_cv_upsample() by any of these filters. Those of contrib are in a module,
 * refocus-ximgproc.so, that is looked for beside this library when it is first asked
 * for.
 *
 * @param filter  enum refocus_cv_filter
 * @return as refocus_cv_upsample(); REFOCUS_ERR_UNSUPPORTED when the module is not
 *         there
 */
REFOCUS_API int refocus_cv_upsample_by(uint32_t filter, const struct refocus_image *photo,
                                       const struct refocus_disparity *map, uint16_t *out,
                                       struct refocus_cv_reason *reason);

#ifdef __cplusplus
}
#endif
#endif
