/** @file methods.h  The methods of rendering, and what each lets one set.
 *
 * Each struct begins as sized.h says. Parameters of methods other than the one that renders are
 * ignored, but not their ranges.
 */
#ifndef REFOCUS_METHODS_H
#define REFOCUS_METHODS_H

#include <stdint.h>
#include <string.h>
#include <refocus/sized.h>
#include <refocus/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The methods; refocus_method_name() has their names on the command line. */
enum refocus_method {
    REFOCUS_METHOD_SWEEP = 0,        /**< two layers, front-most hit, by a sweep over disparities */
    REFOCUS_METHOD_SEARCH = 1,       /**< Yang et al. 2016: randomized intersection search */
    REFOCUS_METHOD_RAYTRACE = 2,     /**< Yang et al. 2016: every pixel along every ray; slow */
    REFOCUS_METHOD_JITTERED = 3,     /**< Yang et al. 2016: the same for one ray of a cell */
    REFOCUS_METHOD_LIGHTFIELD = 4,   /**< Yang et al. 2016, compared: views warped, summed */
    REFOCUS_METHOD_BLUR = 5,         /**< Yang et al. 2016, compared: image-space filter */
    REFOCUS_METHOD_SCATTER = 6,      /**< Potmesil & Chakravarty 1981: samples spread */
    REFOCUS_METHOD_FOVEATED = 7,     /**< Mulder & van Liere 2000: exact where one looks */
    REFOCUS_METHOD_INTERPOLATED = 8, /**< NVIDIA 2004: between blurred pictures */
    REFOCUS_METHOD_DIFFUSION = 9,    /**< Kosloff & Barsky 2007: heat through a blur field */
};
enum { REFOCUS_METHOD_COUNT = 10 };

/** A method in struct refocus_renderer_params, and all of them. */
#define REFOCUS_METHOD_BIT(method) (UINT32_C(1) << (method))
#define REFOCUS_METHODS_ALL        (REFOCUS_METHOD_BIT(REFOCUS_METHOD_COUNT) - 1)

/** Name of a method, NULL for an unknown one. Thread-safe. */
REFOCUS_API const char *refocus_method_name(uint32_t method);

/** One line on what a method does, NULL for an unknown one. Thread-safe. */
REFOCUS_API const char *refocus_method_summary(uint32_t method);

/** Bits of refocus_method_traits(): what a method can and needs. Later versions may have more. */
enum refocus_method_trait {
    REFOCUS_METHOD_ANY_FOCUS = 1 << 0,   /**< tilts, bands, maps, clamps and fields of focus; the
                                              others render that of a plain lens alone */
    REFOCUS_METHOD_DISC_ONLY = 1 << 1,   /**< it knows no aperture other than a disc */
    REFOCUS_METHOD_TAKES_RAYS = 1 << 2,  /**< params->rays counts */
    REFOCUS_METHOD_WHOLE_PHOTO = 1 << 3, /**< it needs memory of its own, see `methods` of struct
                                              refocus_renderer_params, and renders no `in_place` */
    REFOCUS_METHOD_ANY_RADIUS = 1 << 4,  /**< max_blur_radius up to REFOCUS_MAX_BLUR_RADIUS; the
                                            others render up to REFOCUS_PLAIN_BLUR_RADIUS */
    REFOCUS_METHOD_TAKES_YUV = 1 << 5,   /**< it renders photos of Y, U and V as they are */
    REFOCUS_METHOD_HIGHLIGHTS = 1 << 6,  /**< struct refocus_highlight_params counts */
    REFOCUS_METHOD_TAKES_DEEP = 1 << 7,  /**< it renders photos and pictures of deep formats */
};

/** Bits of enum refocus_method_trait, or-ed; 0 for an unknown method. Thread-safe. */
REFOCUS_API uint32_t refocus_method_traits(uint32_t method);

/** `search`: the randomized intersection search of Yang et al. 2016, section 4.
 *  Start from refocus_search_params_default(). */
struct refocus_search_params {
    uint32_t struct_size; /**< sizeof(struct refocus_search_params) */
    int32_t iterations;   /**< T: tests a ray, 1 to 64; default 2, the paper's is 1 */
    uint32_t mirror;      /**< 1 = where the ray is hidden take the mirrored pixel; default 0 */
    uint32_t background;  /**< 1 = where the ray is hidden take the background layer; default 0 */
};

static inline struct refocus_search_params refocus_search_params_default(void)
{
    struct refocus_search_params params;

    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    params.iterations = 2;
    return params;
}

/** `jittered`: full ray tracing (Yang et al. 2016, eq. 3) by one ray of each cell of the aperture
 *  mask. Start from refocus_jittered_params_default(). */
struct refocus_jittered_params {
    uint32_t struct_size; /**< sizeof(struct refocus_jittered_params) */
    int32_t cell;         /**< a, the side of a cell in mask pixels, 1 to 16; default 2 */
    uint32_t seed;        /**< seed of the choice of a pixel in each cell; any number; default 0 */
};

static inline struct refocus_jittered_params refocus_jittered_params_default(void)
{
    struct refocus_jittered_params params;

    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    params.cell = 2;
    return params;
}

/** How `scatter` spreads a sample over its circle of confusion. */
enum refocus_spread {
    REFOCUS_SPREAD_UNIFORM = 0, /**< evenly */
    REFOCUS_SPREAD_LOMMEL = 1,  /**< as light is bent at the aperture, eq. 13 */
};

/** `scatter`: Potmesil & Chakravarty 1981. The star filter of struct refocus_look_params is part of
 *  it. Start from refocus_scatter_params_default(). */
struct refocus_scatter_params {
    uint32_t struct_size; /**< sizeof(struct refocus_scatter_params) */
    uint32_t spread;      /**< enum refocus_spread; default evenly */
    float airy_radius;    /**< Lommel: first dark ring of a point in focus, 0.25 to 16 pixels,
                               default 1; in eq. 13 v = 3.8317 rho / airy_radius at rho pixels
                               from the middle and u = 3.8317 r / airy_radius. These are v and u of
                               eq. 17 and 18 where it is 1.22 lambda N: 1.9 micrometres at f/2.8,
                               15 at f/22, by the size of a pixel on the sensor */
    float depth_ratio;    /**< z1 / z0, 1 to 1000, for the 1 / z^2 of eq. 20; 1 = all samples
                               count the same, the default: 1 / z^2 lets what is near and blurred
                               outweigh what is sharp behind it */
};

static inline struct refocus_scatter_params refocus_scatter_params_default(void)
{
    struct refocus_scatter_params params;

    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    params.airy_radius = params.depth_ratio = 1;
    return params;
}

/** `interpolated`: NVIDIA 2004, between three pictures by blurriness, which is 0 up to the blur
 *  radius c0, 1/2 at r1 c0 and 1 from r2 c0 on. Start from refocus_interpolated_params_default().
 */
struct refocus_interpolated_params {
    uint32_t struct_size; /**< sizeof(struct refocus_interpolated_params) */
    float sharp_radius;   /**< c0, 0.5 to 16 pixels; default 0.5 */
    float middle_ratio;   /**< r1; 0 = (1 + r2) / 2, the default; else above 1 and below r2 */
    float last_ratio;     /**< r2; 0 = at the largest blur of any disparity, the default; else
                               above 1, to 1000 */
};

static inline struct refocus_interpolated_params refocus_interpolated_params_default(void)
{
    struct refocus_interpolated_params params;

    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    params.sharp_radius = (float)0.5;
    return params;
}

/** `foveated`: Mulder & van Liere 2000, exact in a volume of attention. Start from
 *  refocus_foveated_params_default(). */
struct refocus_foveated_params {
    uint32_t struct_size; /**< sizeof(struct refocus_foveated_params) */
    float x, y;           /**< centre of attention, 0 to 1 of width and height; default 0.5. The
                             paper's is where the focus is found, which the caller knows */
    float angle;          /**< across the volume of attention, 0 to 170 degrees; default 10 */
    float picture_angle;  /**< the angle that the picture's width is seen at, 1 to 170 degrees;
                             default 50 */
    float depth;          /**< how far the volume reaches before and behind the focus, in
                               disparity, 0 to 1; default 1 */
};

static inline struct refocus_foveated_params refocus_foveated_params_default(void)
{
    struct refocus_foveated_params params;

    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    params.x = params.y = (float)0.5;
    params.angle = 10;
    params.picture_angle = 50;
    params.depth = 1;
    return params;
}

/** How `diffusion` is computed. */
enum refocus_solver {
    REFOCUS_SOLVER_FAST = 0,     /**< Chebyshev series of the iteration */
    REFOCUS_SOLVER_ITERATED = 1, /**< step by step as in the paper */
};

/** `diffusion`: Kosloff & Barsky 2007, heat that spreads as far as the blur says. Start from
 *  refocus_diffusion_params_default(). */
struct refocus_diffusion_params {
    uint32_t struct_size; /**< sizeof(struct refocus_diffusion_params) */
    int32_t layers;       /**< layers that the picture is split into by depth, 1 to 8; default 4 */
    uint32_t solver;      /**< enum refocus_solver; default fast */
    float conductivity;   /**< weight W where blur is strongest, 0.01 to 1; default 0.125 */
};

static inline struct refocus_diffusion_params refocus_diffusion_params_default(void)
{
    struct refocus_diffusion_params params;

    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    params.layers = 4;
    params.conductivity = (float)0.125;
    return params;
}

#ifdef __cplusplus
}
#endif
#endif
