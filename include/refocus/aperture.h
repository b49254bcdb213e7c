/** @file aperture.h  The shape of the aperture, which the rays pass through.
 *
 * A mask is drawn as the photographer sees it from behind the camera, x to the
 * right and y down: a light behind the plane in focus shows the mask as drawn, a
 * light in front of it shows the mask turned by 180 degrees. So the ray that
 * passes the mask at (x, y), in units of K, is (u, v) = (-x, -y) of
 * Yang et al. 2016, eq. 4.
 */
#ifndef REFOCUS_APERTURE_H
#define REFOCUS_APERTURE_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <refocus/sized.h>
#include <refocus/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Largest side of an aperture mask in pixels, and most rays of a set. */
enum { REFOCUS_MAX_APERTURE_SIDE = 255, REFOCUS_MAX_RAYS = 1024 };

/** An aperture. Opaque, never changes after its creation, may be shared by threads. */
struct refocus_aperture;

/**
 * A round aperture of radius K.
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_MEMORY; on an error
 *         *aperture is NULL. Ended by refocus_aperture_destroy().
 */
REFOCUS_API int refocus_aperture_create_disc(struct refocus_aperture **aperture);

/**
 * A regular polygon with @p blades corners on the circle of radius K.
 *
 * @param blades       3 to 16
 * @param rotation_deg angle of one corner, counter-clockwise from the right as the
 *                     mask is seen; any finite number
 */
REFOCUS_API int refocus_aperture_create_polygon(struct refocus_aperture **aperture, int blades,
                                                double rotation_deg);

/**
 * Any shape: a greyscale picture, 255 = open, 0 = closed. The larger side of the
 * picture spans 2K, its centre is the centre of the lens.
 *
 * @param width, height  1 to REFOCUS_MAX_APERTURE_SIDE
 * @param stride         bytes from a row to the next; may be negative
 * @return also REFOCUS_ERR_ARGUMENT when no pixel is open
 */
REFOCUS_API int refocus_aperture_create_mask(struct refocus_aperture **aperture,
                                             const uint8_t *mask, int width, int height,
                                             ptrdiff_t stride);

/** Outlines that no iris has, drawn upright at rotation 0. */
enum refocus_figure {
    REFOCUS_FIGURE_NONE = 0,
    REFOCUS_FIGURE_HEART = 1,
    REFOCUS_FIGURE_STAR = 2, /**< a star of `blades` points, 0 = 5 */
};
enum { REFOCUS_FIGURE_COUNT = 3 };

/**
 * The parameters of an aperture. Start from refocus_aperture_params_default(), a disc.
 *
 * The outline is a mask's, a figure's, or an iris's. An iris of n blades with curvature
 * c has corners on the circle of radius K, and arcs between them that bulge c times as
 * far as that circle. With opening o > 0 it is an iris in a round barrel that it just
 * clears when wide open (o = 1, a disc) and that has been closed to o times that: o =
 * N0 / N of a lens of f/N0 at f/N; the result is enlarged to reach K again.
 *
 * Over the outline light is spread by v = (rho^2 - hole^2) / (1 - hole^2), rho = 0 in
 * the middle and 1 at the edge: evenly, or with edge e > 0 by 1 - e + 5 e v^4, a disc
 * with a bright edge as of an over-corrected lens, or with e < 0 by 1 + e - 2 e (1 - v),
 * a disc that fades out. Lenses do the one before and the other behind the focus.
 */
struct refocus_aperture_params {
    uint32_t struct_size;            /**< sizeof(struct refocus_aperture_params) */
    int32_t blades;                  /**< 3 to 16; 0 = round */
    double rotation_deg;             /**< angle of one corner, counter-clockwise from the right,
                                          as seen; of the whole figure; -3600 to 3600; not of
                                          masks */
    double curvature;                /**< 0 straight blades, to 1 */
    double opening;                  /**< 0 = no barrel, else above it to 1 */
    double squeeze;                  /**< width / height of what is drawn, 0.5 to 2; below 1 as of
                                          an anamorphic lens */
    double hole;                     /**< radius of a stop in the middle, 0 to 0.9: rings */
    double edge_behind;              /**< e of what is behind the focus, -1 to 1 */
    double edge_before;              /**< e of what is before it, -1 to 1; only `sweep` tells them
                                          apart */
    uint32_t figure;                 /**< enum refocus_figure */
    int32_t mask_width, mask_height; /**< as of refocus_aperture_create_mask() */
    uint32_t reserved;               /**< 0 */
    const uint8_t *mask;             /**< NULL = none; in place of blades and figure */
    ptrdiff_t mask_stride;
};

static inline struct refocus_aperture_params refocus_aperture_params_default(void)
{
    struct refocus_aperture_params params;

    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    params.squeeze = 1;
    return params;
}

/**
 * Any of these. Params that say no more than one of the functions above make the same
 * aperture, whose rays are the same.
 *
 * @return as refocus_aperture_create_mask(); REFOCUS_ERR_ARGUMENT also for a figure
 *         together with curvature or an opening, and a mask together with any of
 *         figure, blades, rotation, curvature and opening
 */
REFOCUS_API int refocus_aperture_create(struct refocus_aperture **aperture,
                                        const struct refocus_aperture_params *params);

/** Free an aperture and set the handle to NULL. A NULL handle is fine. */
REFOCUS_API void refocus_aperture_destroy(struct refocus_aperture **aperture);

/** A ray: where it passes the aperture, in units of K, and its share. */
struct refocus_ray {
    int16_t u, v;    /**< Q15: (u, v) of eq. 4, length at most 1 (of masks, and of
                          refocus_aperture_full_rays(), sqrt 2) */
    uint16_t weight; /**< share of the ray, 1 to 255; sets of N rays are all 255 */
};

/**
 * A well-distributed set of @p count rays of equal share, the same on every machine;
 * those behind the focus where the sides differ.
 *
 * @param aperture  NULL = a disc
 * @param count     1 to REFOCUS_MAX_RAYS
 * @param rays      receives @p count rays
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT. Thread-safe.
 */
REFOCUS_API int refocus_aperture_rays(const struct refocus_aperture *aperture, int count,
                                      struct refocus_ray *rays);

/**
 * Every pixel of the aperture mask at blur radius K: pixel (x, y) is the ray
 * (-x / K, -y / K), weighted by how much of the pixel is open, and where the light is
 * not spread evenly by how much of it there is behind the focus. K = 20 gives the 41x41
 * mask of Yang et al. 2016.
 *
 * @param aperture  NULL = a disc
 * @param max_blur_radius  K in pixels, > 0, at most 127
 * @param capacity  number of rays that @p rays can hold; 0 only counts
 * @param rays      receives at most @p capacity rays, those of weight 255 first; may be NULL
 *                  when @p capacity is 0
 * @return the number of rays in the set, at most 255 * 255, or a negative status
 */
REFOCUS_API int refocus_aperture_full_rays(const struct refocus_aperture *aperture,
                                           double max_blur_radius, int capacity,
                                           struct refocus_ray *rays);

#ifdef __cplusplus
}
#endif
#endif
