/** @file render.h  Refocusing: create once, prepare a photo, render as often as wanted.
 *
 *     refocus_renderer_create    once: threads are started, all memory is taken
 *     refocus_prepare            once a photo or frame
 *     refocus_render             once a lens setting
 *
 * A renderer is reentrant: one thread at a time may call into one renderer,
 * except refocus_cancel(), which any thread may call. The result does not depend
 * on the number of threads, on the processor or on earlier calls.
 */
#ifndef REFOCUS_RENDER_H
#define REFOCUS_RENDER_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <refocus/aperture.h>
#include <refocus/focus.h>
#include <refocus/image.h>
#include <refocus/papers.h>
#include <refocus/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Largest blur radius K in pixels. */
enum { REFOCUS_MAX_BLUR_RADIUS = 127 };

/** A renderer. Opaque. */
struct refocus_renderer;

/** Where a renderer takes its memory. Both functions or none. */
struct refocus_allocator {
    /** @return @p size bytes aligned for any type, or NULL */
    void *(*allocate)(void *user, size_t size);
    void (*release)(void *user, void *memory);
    void *user;
};

/** Receives one line of text without a line end, from the thread that called in. */
struct refocus_log {
    void (*message)(void *user, const char *text);
    void *user;
};

/**
 * The caller's threads in place of the renderer's own, for programs that have a pool.
 *
 * parallel_for(user, work, context, count) calls work(context, i) once for each i = 0 ..
 * count - 1 and returns when all calls have returned. In any order, on any threads, one after
 * the other or all at once. An item is a worker, not a piece of the picture: it takes
 * pieces for as long as there are any, so the first few items may do all the work, and the
 * last ones nothing. count is at most params.threads. It is called from the thread that called
 * refocus_prepare() or refocus_render(), some dozens of times a picture, and never from
 * within itself. An item that is called twice or not at all makes the result undefined.
 */
struct refocus_parallel {
    void (*parallel_for)(void *user, void (*work)(void *context, int32_t item), void *context,
                         int32_t count);
    void *user;
};

/** Instruction sets. AUTO is the best that the processor has. */
enum refocus_cpu {
    REFOCUS_CPU_AUTO = 0,
    REFOCUS_CPU_C = 1,
    REFOCUS_CPU_NEON = 2,
    REFOCUS_CPU_SSE41 = 3,
    REFOCUS_CPU_AVX2 = 4,
    REFOCUS_CPU_AVX512 = 5, /**< 256-bit vectors with the masks of AVX-512 (BW, VL, VNNI) */
};

/** What a renderer can do at most. Start from refocus_renderer_params_default(). */
struct refocus_renderer_params {
    uint32_t struct_size;  /**< sizeof(struct refocus_renderer_params) */
    int32_t max_width;     /**< of photos, pixels, 1 to REFOCUS_MAX_SIDE */
    int32_t max_height;    /**< of photos, pixels, 1 to REFOCUS_MAX_SIDE */
    float max_blur_radius; /**< largest K, 0 to REFOCUS_MAX_BLUR_RADIUS */
    int32_t threads;       /**< 1 to 64; 0 = one for each processor. With `parallel`: the most
                                that work at once */
    uint32_t cpu;          /**< enum refocus_cpu */
    uint64_t max_memory;   /**< bytes; creation fails above; 0 = no limit */
    struct refocus_allocator allocator; /**< all NULL: malloc and free */
    struct refocus_log log;             /**< message NULL: silent */
    uint32_t methods;  /**< those of `papers` that need memory of their own and may be rendered:
                            REFOCUS_METHOD_BIT() of each, or-ed */
    uint32_t reserved; /**< 0 */
    struct refocus_parallel parallel;    /**< parallel_for NULL: threads of its own */
    const struct refocus_papers *papers; /**< NULL: the methods are sweep and search, or
                           refocus_papers() of papers.h: all of them. One of another build than this
                           library is refused with REFOCUS_ERR_ARGUMENT */
    uint32_t in_place; /**< 1: strip mode, for little memory. The photo and its disparities,
                            which are of its size, are not copied: they stay as they are and
                            where they are until the next refocus_prepare() or the
                            renderer's end. Rendering goes through them twice, block by
                            block, and takes longer; the bytes are the same, but that
                            tilts and fields whose K is more than half of max_blur_radius
                            may change single pixels by a code. For sweep, search,
                            raytrace, jittered and blur */
    uint32_t thin;     /**< 1: with memory for `thin` of struct refocus_render_params, which
                            other renderers, and strip mode, take as 0 */
};

static inline struct refocus_renderer_params
refocus_renderer_params_default(int32_t max_width, int32_t max_height, float max_blur_radius)
{
    struct refocus_renderer_params params;

    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    params.max_width = max_width;
    params.max_height = max_height;
    params.max_blur_radius = max_blur_radius;
    return params;
}

/**
 * Bytes that a renderer with these parameters takes, all of them at its creation
 * (stacks of its threads not counted):
 *
 *     27 (W + 2P + 79) (H + 2P + 16) + 3 (W + 16) (H + 16) + 4 T (W + 512) + 24 W + 12 H + 2^20
 *
 * with P = ceil(K) + 2 and T threads is never exceeded. On top of it comes the most that one
 * of params->methods needs:
 *
 *     lightfield    1200 (W + 2P + 64) T + 2^12
 *     scatter       32 W H + 3 (4 P + 80) P^2 + 2^16
 *     foveated      96 (W + 16) (H + 16) + 2^18
 *     interpolated  32 (W + 16) (H + 16) + 24 (W + 64) T + 2^16
 *     diffusion     96 (W + 16) (H + 16) + 2^18
 *
 * params->thin takes up to 6 (W + 16) (H + 16) + 2^12 more, 4.4 bytes a pixel for large pictures.
 *
 * Strip mode, params->in_place, takes no more than
 *
 *     28 (S + 63) (S + 16) + 0.78 (W + 16) (H + 64) + 4 T (W + 512) + 24 P^2 + 2^17
 *
 * with S = 144 + 2N - M + max(M, 2P), M = P + 28 and N = max(M, 2P + 9), M and N rounded up to
 * multiples of 16: 1920x1080 with K = 40 takes less than 6,000,000 bytes.
 *
 * @return 0 if a parameter is out of its range. Thread-safe.
 */
REFOCUS_API uint64_t refocus_renderer_memory(const struct refocus_renderer_params *params);

/**
 * Take the memory and start the threads.
 *
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_MEMORY, REFOCUS_ERR_SIZE
 *         (above max_memory or the address space), REFOCUS_ERR_UNSUPPORTED (the
 *         processor lacks the instruction set), REFOCUS_ERR_THREAD. On an error
 *         *renderer is NULL and nothing stays behind.
 */
REFOCUS_API int refocus_renderer_create(struct refocus_renderer **renderer,
                                        const struct refocus_renderer_params *params);

/** Stop the threads, free all, set the handle to NULL. A NULL handle is fine. */
REFOCUS_API void refocus_renderer_destroy(struct refocus_renderer **renderer);

/**
 * Take a photo and its disparities in. Both are copied in the form the renderer needs; the
 * caller's memory is not used after the return. In strip mode (params.in_place) they are not
 * copied, and stay with the renderer until the next refocus_prepare() or its end.
 *
 * @param photo      all in focus; at most max_width x max_height; any enum refocus_format.
 *                   Each byte is read once, each plane in order: camera memory may be
 *                   uncached
 * @param disparity  of any size; covers the same view as the photo. Another size than
 *                   the photo's is brought to it by following the photo's edges.
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_SIZE, REFOCUS_ERR_UNSUPPORTED (in_place:
 *         a map of another size, or a photo of Y, U and V), REFOCUS_ERR_CANCELLED.
 *         After an error nothing is prepared.
 */
REFOCUS_API int refocus_prepare(struct refocus_renderer *renderer,
                                const struct refocus_image *photo,
                                const struct refocus_disparity *disparity);

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

/** The values that are averaged. */
enum refocus_blend {
    REFOCUS_BLEND_LINEAR = 0, /**< linear light by the sRGB curve */
    REFOCUS_BLEND_STORED = 1, /**< the 8-bit values as they are, as in the paper */
    REFOCUS_BLEND_GAMMA = 2,  /**< gamma 2.2 */
};

/** For rays: every pixel of the aperture mask. */
enum { REFOCUS_RAYS_FULL = -1 };

/** How `scatter` spreads a sample over its circle of confusion. */
enum refocus_spread {
    REFOCUS_SPREAD_UNIFORM = 0, /**< evenly */
    REFOCUS_SPREAD_LOMMEL = 1,  /**< as light is bent at the aperture, eq. 13 */
};

/**
 * Where it is blurred, Kosloff & Barsky 2007. Distances are of (x, y, d) to the field's
 * centre: x and y in parts of the picture's width, d the disparity.
 *
 *     r = K clamp((distance - field_radius) / field_falloff, 0, 1)
 *
 * What is nearer than the centre (for a picture: than df) is blurred as what lies before the
 * focus of a lens is, over what is behind it; the rest as what lies behind. Both sides of a
 * plane are one side each.
 */
enum refocus_field {
    REFOCUS_FIELD_LENS = 0,     /**< r = K |d - df|, and what follows in the parameters */
    REFOCUS_FIELD_CYLINDER = 1, /**< sharp in an upright cylinder: distance in x and d */
    REFOCUS_FIELD_PLUS = 2,     /**< sharp in two upright slabs: the lesser of x and d */
    REFOCUS_FIELD_PLANE = 3,    /**< sharp by an upright plane: x cos a + d sin a */
    REFOCUS_FIELD_SPHERE = 4,   /**< sharp in a sphere: distance in x, y and d */
    REFOCUS_FIELD_PICTURE = 5,  /**< r = K v of a map of values 0..1 */
};

/** Bands in focus at once, the one about focus_disparity among them; largest growth of
 *  the disparity in focus over the picture. */
enum { REFOCUS_MAX_BANDS = 16, REFOCUS_MAX_TILT = 64 };

/**
 * A band in focus: sharp within half_width of its disparity; from half_width + transition on
 * as blurred as by a lens focused at its middle; in between in proportion.
 */
struct refocus_band {
    float disparity;  /**< middle, 0 to 1 */
    float half_width; /**< 0 to 1 */
    float transition; /**< 0 to 1; 0 = none, at once the lens's blur */
};

/** How `diffusion` is computed. */
enum refocus_solver {
    REFOCUS_SOLVER_FAST = 0,     /**< Chebyshev series of the iteration */
    REFOCUS_SOLVER_ITERATED = 1, /**< step by step as in the paper */
};

/** How to refocus. Start from refocus_render_params_default(). */
struct refocus_render_params {
    uint32_t struct_size;  /**< sizeof(struct refocus_render_params) */
    uint32_t method;       /**< enum refocus_method */
    float focus_disparity; /**< df: the disparity in focus, 0 to 1 */
    float max_blur_radius; /**< K in pixels, 0 to the renderer's max_blur_radius */
    int32_t rays;          /**< ray samples at the largest blur, 1 to REFOCUS_MAX_RAYS, or
                                REFOCUS_RAYS_FULL */
    uint32_t blend;        /**< enum refocus_blend */
    float sigma;           /**< of the highlight weight exp(-(max(R,G,B) - 255)^2 / 2 sigma^2),
                                eq. 5: >= 1; INFINITY = plain average */
    float highlight_gain;  /**< sweep: light given back to small clipped lamps, 1 (none) to 16
                                times white, 2^stops, where they are blurred by s; none where
                                one channel of R, G, B alone is clipped. Of a disc or an
                                iris, and with sigma from 1e6 on, drawn over the area of the
                                opening times s^2; else rays meet it */
    int32_t iterations;    /**< T of the randomized search, 1 to 64; the paper's is 1 */
    uint8_t mirror;        /**< search: 1 = where the ray is hidden take the mirrored pixel */
    uint8_t background;    /**< search: 1 = where the ray is hidden take the background layer */
    uint8_t prefilter;     /**< sweep: 1 = smooth the input between rays that lie far apart,
                                and the result where all that is seen is blurred */
    uint8_t reserved;      /**< 0 */
    const struct refocus_aperture *aperture; /**< NULL = a disc, the only one that scatter,
                                 foveated, interpolated and diffusion know */
    int32_t region_x, region_y;              /**< the part of the picture to render: its */
    int32_t region_width, region_height;     /**< corner and size; all 0 = the whole */

    /* What follows is of single methods; the others ignore it, but not its range. */

    int32_t cell;  /**< jittered: a, the side of a cell in mask pixels, 1 to 16 */
    uint32_t seed; /**< jittered: which pixel of each cell; grain: which grain; any
                        number */

    uint32_t spread;     /**< scatter: enum refocus_spread */
    float airy_radius;   /**< scatter, Lommel: first dark ring of a point in focus, 0.25 to
                              16 pixels; in eq. 13 v = 3.8317 rho / airy_radius at rho pixels
                              from the middle and u = 3.8317 r / airy_radius */
    float depth_ratio;   /**< scatter: z1 / z0, 1 to 1000, for the 1 / z^2 of eq. 20; 1 = all
                              samples count the same */
    int32_t star_spikes; /**< scatter, sweep: of a star filter, 0 = none, else 2 to 16; sweep
                              gives them to small clipped lamps */
    float star_length;   /**< pixels of a spike, 0 to REFOCUS_MAX_BLUR_RADIUS */
    float star_angle;    /**< degrees of the first spike, counter-clockwise from the right */
    float star_strength; /**< share of the light that goes to the spikes, 0 to 1; sweep adds
                              it */

    float sharp_radius; /**< interpolated: c0, blur radius up to which blurriness is 0;
                             0.5 to 16 pixels */
    float middle_ratio; /**< interpolated: r1, blurriness is 1/2 at r1 c0; 0 = (1 + r2) / 2,
                             else above 1 and below r2 */
    float last_ratio;   /**< interpolated: r2, blurriness is 1 from r2 c0 on; 0 = at the
                             largest blur of any disparity, else above 1, to 1000 */

    float attention_x, attention_y; /**< foveated: centre of attention, 0 to 1 of width, height */
    float attention_angle; /**< foveated: across the volume of attention, 0 to 170 degrees */
    float picture_angle;   /**< foveated: that the picture's width is seen at, 1 to 170 degrees */
    float attention_depth; /**< foveated: how far the volume reaches before and behind the
                                focus, in disparity, 0 to 1 */

    uint32_t field;         /**< sweep, search, blur, diffusion: enum refocus_field */
    float field_x, field_y; /**< centre, 0 to 1 of width and height */
    float field_disparity;  /**< centre, 0 to 1 */
    float field_radius;     /**< distance up to which nothing is blurred, 0 to 4 */
    float field_falloff;    /**< further distance at which r = K, 0.001 to 4 */
    float field_angle;      /**< a of the plane's normal, degrees: 0 = sharp at one x, 90 = at
                                 one d */
    int32_t layers;         /**< diffusion: that the picture is split into by depth, 1 to 8 */
    uint32_t solver;        /**< diffusion: enum refocus_solver */
    float conductivity;     /**< diffusion: weight W where blur is strongest, 0.01 to 1 */
    const struct refocus_disparity *field_map; /**< of REFOCUS_FIELD_PICTURE; any size, read
                                 between its samples. This map and the next two are the caller's;
                                 they are needed until the next render, or the last
                                 refocus_get_view() of REFOCUS_VIEW_BLUR */

    /*
     * Focus beyond that of a plain lens: of sweep, search, blur and diffusion, the others
     * refuse it. A pixel (x, y) of disparity d, clamped to least_disparity..most_disparity,
     * is blurred by
     *
     *     s = K e,  e = depth_share (df - d) + across (x - tilt_x) + down (y - tilt_y)
     *
     * with x and y in parts of the width and the height, df from focus_disparity or
     * focus_map; then e is shortened by the bands, |e| and |s| are limited to 1 and blur_limit,
     * and |s| is multiplied by 1 - sharp_map. With a field other than that of the lens only the
     * last two and the clamps of d apply. The defaults change nothing.
     */
    float tilt_x, tilt_y;         /**< place at which df is in focus, 0 to 1; default 0.5 */
    float tilt_across, tilt_down; /**< growth of the disparity in focus from the left to the
                                 right and from the top to the bottom, up to REFOCUS_MAX_TILT
                                 either way: a tilted plane of focus, see focus.h */
    float depth_share;            /**< 0 to 1: how much depth counts. Below 1 with a tilt: depth is
                                   compressed along a line, Yang et al. 2016, fig. 13(a); 0 = only
                                   the place counts, as in pictures of miniatures */
    float focus_half_width;       /**< of the band about df: 0 to 1 */
    float focus_transition;       /**< 0 to 1; see struct refocus_band */
    int32_t bands;                /**< in focus beside it, 0 to REFOCUS_MAX_BANDS - 1 */
    struct refocus_band band[REFOCUS_MAX_BANDS - 1];
    const struct refocus_disparity *focus_map; /**< NULL, or df of each place in place of
                                 focus_disparity: any size, read between its samples */
    const struct refocus_disparity *sharp_map; /**< NULL, or what stays sharp whatever its depth:
                                 1 wholly, 0 not at all; any size */
    float least_disparity; /**< what is farther counts as this far, 0 to 1; default 0 */
    float most_disparity;  /**< what is nearer counts as this near, from least_disparity to 1;
                            default 1 */
    float blur_limit;      /**< no blur is larger: 0 to REFOCUS_MAX_BLUR_RADIUS pixels, the
                            default */

    /* The look of the blur beyond the aperture's: of sweep, the others refuse it; also an
     * aperture that differs before and behind the focus, which needs a number of rays. */
    float cat_eye; /**< 0 to 0.9: how much of its width the opening has lost in the
                    corners, where it is the part common to two circles, one pushed
                    out and one pushed in; it grows with the square of the distance
                    from the middle of the picture. Of blades and figures that part
                    is taken, and a ring or an edge follows its rim; what is drawn
                    on a mask is squeezed into it. 0 = nothing, the default */
    float fringe;  /**< -0.5 to 0.5: longitudinal colour: by how much the blur of red
                    and blue behind the focus, and of green before it, is smaller
                    than the other; below 0 the other way round. Takes twice the
                    time. 0 = none, the default */
    float grain;   /**< 0 to 4, any method: how much of the noise that a blur
                    averages away is put back. It is measured where this lens
                    leaves the photo sharp (anywhere, when it does so nowhere), by
                    brightness, and laid over the blurred parts as luma noise by
                    `seed`. 0 = none, the default; 1 = as much as there was */

    uint32_t thin; /**< sweep, by renderers with `thin`: 1 = things up to 7 pixels
                        wide are drawn as the veil that they become, and so are their
                        shares of the pixels at their edges, where they are blurred so
                        much before the focus that rays lie 1.8 pixels apart (8.1
                        pixels at 64 rays; the same of a full mask), 8 pixels at the
                        least, first some of them and all from 5/4 of that on, with
                        nothing thick as near around them. Rays, which meet them here
                        and miss them there, would show streaks. Not with
                        openings of fine structure (masks, figures, rings), cat's
                        eyes, fringes. And where they are in focus, before what is
                        blurred by some two pixels, their shares of the pixels at
                        their edges stay sharp, else those would be blurred with what
                        is behind and the edges be in steps. They are looked for in
                        the first render of a photo, which takes some frames' time;
                        not in photos of Y, U and V. 0 = no, the default */
};

/** Sweep, 64 rays, plain averages in linear light of what is in the photo, a disc, the whole
 *  picture. */
static inline struct refocus_render_params refocus_render_params_default(float focus_disparity,
                                                                         float max_blur_radius)
{
    struct refocus_render_params params;

    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    params.focus_disparity = focus_disparity;
    params.max_blur_radius = max_blur_radius;
    params.rays = 64;
    params.sigma = (float)1e30;
    params.highlight_gain = 1;
    params.iterations = 2;
    params.prefilter = 1;
    params.cell = 2;
    params.airy_radius = 1;
    params.depth_ratio = 1;
    params.star_length = 24;
    params.star_strength = (float)0.25;
    params.sharp_radius = (float)0.5;
    params.attention_x = params.attention_y = (float)0.5;
    params.attention_angle = 10;
    params.picture_angle = 50;
    params.attention_depth = 1;
    params.field_x = params.field_y = (float)0.5;
    params.field_disparity = focus_disparity;
    params.field_radius = (float)0.1;
    params.field_falloff = (float)0.3;
    params.layers = 4;
    params.conductivity = (float)0.125;
    params.tilt_x = params.tilt_y = (float)0.5;
    params.depth_share = 1;
    params.most_disparity = 1;
    params.blur_limit = REFOCUS_MAX_BLUR_RADIUS;
    return params;
}

/**
 * Refocus the prepared photo.
 *
 * Ray (u, v) of pixel p meets disparity d at p + (u, v) K (df - d)
 * (Yang et al. 2016, eq. 4). Pixels of less than half a pixel of blur, with nothing
 * blurred reaching over them, come out as they went in; alpha always does (255 where
 * the photo has none).
 *
 * What the last call made is kept as long as it holds: another aperture shape or region
 * costs only the rays; other rays, highlights or sigma, what depends on them; another focus or K,
 * all but the light of the photo. A region costs what lies in it and around it. None of this
 * changes a byte.
 *
 * A photo of Y, U and V is rendered in Y, U and V, chroma at its own resolution, by the sweep
 * alone. Averaged are the luminance L of each pixel and, for each sample of chroma, the light
 * that blue and red have more than that. With g the curve of the blend, Y' the luma of the mean
 * light of the pixels that share the sample, and B', R', G' the colour by the photo's matrix:
 *
 *     E = Kr g(R') + Kg g(G') + Kb g(B') - g(Y')     L   = g(Y) + E
 *     D_b = g(B') - g(Y') - E                        D_r = g(R') - g(Y') - E
 *
 * and back in the same way from their means. A sample of chroma has the blur of that pixel of
 * its own which is the sharpest; sigma weighs by L; highlights are told and given back by L, with
 * sigma up to 4 times white.
 * Samples that nothing changed keep their codes, so that one colour stays that colour, even
 * where its codes are none.
 *
 * @param params  see struct refocus_render_params; of a photo of Y, U and V the region begins and
 *                ends at even columns and, in 4:2:0, rows, or at the picture's end
 * @param out     of the size of the region, any stride; may not overlap itself. Any format of
 *                R, G, B of a photo of R, G, B; any of 4:2:0 of one of 4:2:0; YUYV of YUYV. Its
 *                matrix and range are the photo's, whatever they say.
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_STATE (nothing prepared),
 *         REFOCUS_ERR_UNSUPPORTED (another format than these; of a photo of Y, U and V another
 *         method than the sweep, cat's eye, fringe, star filter,
 *         grain or an aperture that differs before and behind the focus),
 *         REFOCUS_ERR_CANCELLED. On REFOCUS_ERR_CANCELLED parts of @p out are written,
 *         on the others none. Allocates nothing.
 */
REFOCUS_API int refocus_render(struct refocus_renderer *renderer,
                               const struct refocus_render_params *params,
                               const struct refocus_image *out);

/**
 * End the refocus_prepare() or refocus_render() that is running, if any, early: it
 * returns REFOCUS_ERR_CANCELLED as soon as each thread has done the few pixels that it is at, a few
 * milliseconds at most whatever the picture. Has no effect on later calls. With NULL it
 * does nothing. Thread-safe.
 */
REFOCUS_API void refocus_cancel(struct refocus_renderer *renderer);

/** Layers that can be looked at. */
enum refocus_view {
    REFOCUS_VIEW_DISPARITY = 0, /**< the prepared disparity, 65535 nearest */
    REFOCUS_VIEW_BLUR = 1,      /**< |s| of the last render in 1/256 pixel */
};

/**
 * Copy a layer out: width x height 16-bit values of the prepared photo's size.
 *
 * @param stride  bytes from a row of @p out to the next; even
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT, REFOCUS_ERR_STATE
 */
REFOCUS_API int refocus_get_view(struct refocus_renderer *renderer, uint32_t view, uint16_t *out,
                                 ptrdiff_t stride);

/** Threads and instruction set that a renderer works with, all 0 for a NULL renderer. With a
 *  NULL @p info refocus_renderer_get_info() does nothing. */
struct refocus_renderer_info {
    int32_t threads;
    uint32_t cpu;    /**< enum refocus_cpu, never AUTO */
    uint64_t memory; /**< bytes taken */
};
REFOCUS_API void refocus_renderer_get_info(const struct refocus_renderer *renderer,
                                           struct refocus_renderer_info *info);

/** "c", "neon", "sse41", "avx2", "avx512" or "auto"; NULL for an unknown one. Thread-safe. */
REFOCUS_API const char *refocus_cpu_name(uint32_t cpu);

#ifdef __cplusplus
}
#endif
#endif
