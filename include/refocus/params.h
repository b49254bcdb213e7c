/** @file params.h  How to refocus: what every render needs, and one small struct a feature.
 *
 *     struct refocus_render_params params = refocus_render_params_default(0.8f, 20);
 *     struct refocus_look_params look = refocus_look_params_default();
 *
 *     look.cat_eye = 0.5f;
 *     params.look = &look;
 *
 * A NULL feature has its defaults, which its refocus_*_params_default() fills in. Structs that
 * are pointed at are read during the call and not kept. Each begins as sized.h says.
 */
#ifndef REFOCUS_PARAMS_H
#define REFOCUS_PARAMS_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <refocus/aperture.h>
#include <refocus/image.h>
#include <refocus/methods.h>
#include <refocus/sized.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Largest blur radius K in pixels, and that of methods that are not REFOCUS_METHOD_ANY_RADIUS; no
 * spike of a star is longer than the latter. */
enum { REFOCUS_MAX_BLUR_RADIUS = 944, REFOCUS_PLAIN_BLUR_RADIUS = 127 };

/** The values that are averaged. */
enum refocus_blend {
    REFOCUS_BLEND_LINEAR = 0, /**< linear light by the sRGB curve */
    REFOCUS_BLEND_STORED = 1, /**< the 8-bit values as they are, as in the paper */
    REFOCUS_BLEND_GAMMA = 2,  /**< gamma 2.2 */
};

/** How that part of the background is made up which a blurred foreground uncovers, and the photo
 * does not show. */
enum refocus_inpaint {
    REFOCUS_INPAINT_SMOOTH = 0,   /**< smoothly, from the colours around */
    REFOCUS_INPAINT_TEXTURED = 1, /**< where it is nearly in focus (up to 4 pixels of blur), with
                                    the texture and the edges around continued. For stills: takes
                                    up to two seconds a megapixel by one thread, whatever the
                                    region. Photos of Y, U and V take it as smooth */
};
enum { REFOCUS_INPAINT_COUNT = 2 };

/** For rays: every pixel of the aperture mask. Not with an aperture whose edge_before and
 * edge_behind differ. */
enum { REFOCUS_RAYS_FULL = -1 };

/** Highlights: the light that clipping took. Of `sweep` and `search`. Start from
 *  refocus_highlight_params_default(). Photos of Y, U and V: see refocus_render(). */
struct refocus_highlight_params {
    uint32_t struct_size; /**< sizeof(struct refocus_highlight_params) */
    float gain;           /**< light that clipped highlights get where they are blurred, 1 (none,
                               the default) to 16 times white; 2^n is n stops. What may be no
                               highlight gets a part of it, by how likely it is one, and hardly any
                               where one channel of R, G, B alone is clipped. By the search, and
                               with sigma from 1e6 on, each highlight is drawn as a disc of the
                               aperture; else rays meet it. Strip mode needs
                               refocus_renderer_params.highlights */
    float estimate; /**< 0, the default: by gain. Above 0, up to 4: how much light each clipped
                               pixel has lost, up to 15 times white, is estimated from what the
                               lens spread around it, from its colour and from how bright the photo
                               is, and this many times that is given back. gain is not looked at */
    float steady;   /**< for the frames of a video, prepared and rendered one after the other: 0,
                               the default, for stills, to 0.95. The light that estimate or gain
                               give back follows that of the last frame, and changes by a third and
                               less are reduced by this share: most of what discs flicker by under
                               noise and slow motion. The last frame is forgotten where size, blend
                               or estimate change */
};

static inline struct refocus_highlight_params refocus_highlight_params_default(void)
{
    struct refocus_highlight_params params;

    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    params.gain = 1;
    return params;
}

/** Thin structures: wires, hair, stems; and silhouettes. Of `sweep`, by renderers with `thin`.
 * Start from refocus_thin_params_default(). */
struct refocus_thin_params {
    uint32_t struct_size; /**< sizeof(struct refocus_thin_params) */
    uint32_t enabled;     /**< 1 = structures up to 7 pixels wide that are far before the focus are
                               blurred as mattes: rays, which meet them here and miss them there,
                               would show streaks. It begins where their blur is so large that rays
                               lie 1.8 pixels apart (8.1 pixels at 64 rays), but 8 pixels at the
                               least, and is phased in up to 5/4 of that. Not where something thick
                               is as near, nor with masks, figures, rings, cat's eyes and fringes.
                               In focus, before what is blurred by two pixels and more, the pixels
                               that they, and thick things, cover in part stay sharp, so that their
                               edges are not in steps and a bright subject has no halo; out of focus
                               those of thick things are blurred as these are. They are looked for
                               in the first render of a photo, which takes some frames' time. Of
                               photos of Y, U and V, which may be frames of a video, that is done
                               with thick things alone: it takes a twentieth of a frame's time
                               with a figure before a wall, half of it with leaves. 0 = no, the
                               default */
};

static inline struct refocus_thin_params refocus_thin_params_default(void)
{
    struct refocus_thin_params params;

    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    return params;
}

/** The look of the blur beyond the aperture's. Start from refocus_look_params_default(). */
struct refocus_look_params {
    uint32_t struct_size; /**< sizeof(struct refocus_look_params) */
    float cat_eye;        /**< sweep, the others refuse it; 0 to 0.9: how much of its width the
                               aperture has lost in the corners, where it is the part common to
                               two circles, one pushed out and one pushed in; it grows with the
                               square of the distance from the middle of the picture. Of blades
                               and figures that part is taken, and a ring or an edge follows its
                               edge; what is drawn on a mask is squeezed into it. 0 = nothing, the
                               default */
    float fringe;         /**< sweep, the others refuse it; -0.5 to 0.5: longitudinal colour: by
                               how much the blur of red and blue behind the focus, and of green
                               before it, is smaller than the other; below 0 the other way round.
                               Takes twice the time. 0 = none, the default */
    float grain;          /**< any method; 0 to 4: how much of the noise that a blur averages away
                               is put back, as luma noise of its strength, by brightness, and of
                               its size. It is measured in the smoothest parts of the photo; what
                               is below one code, or differs between brightnesses or blocks, or
                               over distance, as texture does, is no noise, and nothing changes.
                               Near black and white, where noise is cut off, there is less.
                               0 = none, the default; 1 = as much as there was */
    uint32_t grain_seed;  /**< seed of the grain; any number; default 0 */
    int32_t star_spikes;  /**< scatter, sweep: of a star filter, 0 = none, the default, else 2 to
                               16; sweep gives them to small clipped highlights. Other methods
                               check what the star fields say, and draw no star */
    float star_length;    /**< pixels of a spike, 0 to REFOCUS_PLAIN_BLUR_RADIUS; default 24 */
    float star_angle;     /**< degrees of the first spike, counter-clockwise from the right, -3600
                               to 3600; default 0 */
    float star_strength;  /**< share of the light that goes to the spikes, 0 to 1; sweep adds it;
                               default 0.25 */
};

static inline struct refocus_look_params refocus_look_params_default(void)
{
    struct refocus_look_params params;

    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    params.star_length = 24;
    params.star_strength = (float)0.25;
    return params;
}

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

/**
 * Focus beyond that of a plain lens: of sweep, search, blur and diffusion, the others
 * refuse it. A pixel (x, y) of disparity d, clamped to least_disparity..most_disparity,
 * is blurred by
 *
 *     s = K e,  e = depth_share (df - d) + across (x - tilt_x) + down (y - tilt_y)
 *
 * with x and y in parts of the width and the height, df from the render's focus_disparity or
 * from map; then e is shortened by the bands, |e| and |s| are limited to 1 and blur_limit,
 * and |s| is multiplied by 1 - sharp_map. With a field other than that of the lens only the
 * last two and the clamps of d apply. The defaults change nothing. Start from
 * refocus_focus_params_default().
 */
struct refocus_focus_params {
    uint32_t struct_size;         /**< sizeof(struct refocus_focus_params) */
    float tilt_x, tilt_y;         /**< place at which df is in focus, 0 to 1; default 0.5 */
    float tilt_across, tilt_down; /**< growth of the disparity in focus from the left to the
                                 right and from the top to the bottom, up to REFOCUS_MAX_TILT
                                 either way: a tilted plane of focus, see focus.h; default 0 */
    float depth_share;            /**< 0 to 1, the default: how much depth counts. Below 1 with a
                                 tilt: depth is compressed along a line, Yang et al. 2016, fig.
                                 13(a); 0 = only the place counts, as in pictures of miniatures */
    float half_width;             /**< half the width of the band about df: 0, the default, to 1 */
    float transition;             /**< 0, the default, to 1; see struct refocus_band */
    float least_disparity;        /**< anything farther counts as this far, 0 to 1; default 0 */
    float most_disparity;         /**< anything nearer counts as this near, from least_disparity to
                                 1; default 1 */
    float blur_limit;             /**< no blur is larger: 0 to REFOCUS_MAX_BLUR_RADIUS pixels, the
                                 default */
    int32_t bands;                /**< in focus beside it, 0, the default, to
                                 REFOCUS_MAX_BANDS - 1 */
    const struct refocus_disparity *map;       /**< NULL, or df of each place in place of
                                 focus_disparity: any size, read between its samples. The
                                 samples of this map, of sharp_map and of that of a field are the
                                 caller's; they are needed until the next render, or the last
                                 refocus_get_view() of REFOCUS_VIEW_BLUR */
    const struct refocus_disparity *sharp_map; /**< NULL, or what stays sharp whatever its depth:
                                 1 wholly, 0 not at all; any size */
    struct refocus_band band[REFOCUS_MAX_BANDS - 1];
    uint32_t reserved; /**< 0 */
};

static inline struct refocus_focus_params refocus_focus_params_default(void)
{
    struct refocus_focus_params params;

    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    params.tilt_x = params.tilt_y = (float)0.5;
    params.depth_share = params.most_disparity = 1;
    params.blur_limit = REFOCUS_MAX_BLUR_RADIUS;
    return params;
}

/**
 * Where it is blurred, Kosloff & Barsky 2007. Distances are of (x, y, d) to the field's
 * centre: x and y in parts of the picture's width, d the disparity.
 *
 *     r = K clamp((distance - radius) / falloff, 0, 1)
 *
 * What is nearer than the centre (for a picture: than df) is blurred as what lies before the
 * focus of a lens is, over what is behind it; the rest as what lies behind. Both sides of a
 * plane are one side each.
 */
enum refocus_field {
    REFOCUS_FIELD_LENS = 0,     /**< r = K |d - df|, and struct refocus_focus_params */
    REFOCUS_FIELD_CYLINDER = 1, /**< sharp in an upright cylinder: distance in x and d */
    REFOCUS_FIELD_PLUS = 2,     /**< sharp in two upright slabs: the lesser of x and d */
    REFOCUS_FIELD_PLANE = 3,    /**< sharp by an upright plane: x cos a + d sin a */
    REFOCUS_FIELD_SPHERE = 4,   /**< sharp in a sphere: distance in x, y and d */
    REFOCUS_FIELD_PICTURE = 5,  /**< r = K v of a map of values 0..1 */
};

/** A field of blur in place of the lens's: of sweep, search, blur and diffusion, the others refuse
 *  it. Start from refocus_field_params_default(). */
struct refocus_field_params {
    uint32_t struct_size; /**< sizeof(struct refocus_field_params) */
    uint32_t shape;       /**< enum refocus_field; default that of the lens */
    float x, y;           /**< centre, 0 to 1 of width and height; default 0.5 */
    float disparity;      /**< centre, 0 to 1 */
    float radius;         /**< distance up to which nothing is blurred, 0 to 4; default 0.1 */
    float falloff;        /**< further distance at which r = K, 0.001 to 4; default 0.3 */
    float angle;          /**< a of the plane's normal, degrees, -3600 to 3600: 0 = sharp at one x,
                               the default, 90 = at one d */
    const struct refocus_disparity
        *map; /**< the map of REFOCUS_FIELD_PICTURE; any size, read between its
    samples, which stay as those of struct refocus_focus_params do */
};

/** @param disparity  of the centre: the disparity in focus, mostly */
static inline struct refocus_field_params refocus_field_params_default(float disparity)
{
    struct refocus_field_params params;

    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    params.x = params.y = (float)0.5;
    params.disparity = disparity;
    params.radius = (float)0.1;
    params.falloff = (float)0.3;
    return params;
}

/** How light of a deep photo becomes 8 bits. Nothing else is dithered. */
enum refocus_dither {
    REFOCUS_DITHER_ORDERED = 0, /**< a code is rounded up in as many of 8 x 8 pixels of the photo as
                                     light lies above it, by half a code at the most: no steps in
                                     gradients. Light of a code is that code */
    REFOCUS_DITHER_OFF = 1,     /**< to the nearest code */
};

/** How to refocus. Start from refocus_render_params_default(). */
struct refocus_render_params {
    uint32_t struct_size;  /**< sizeof(struct refocus_render_params) */
    uint32_t method;       /**< enum refocus_method; default sweep */
    float focus_disparity; /**< df: the disparity in focus, 0 to 1 */
    float max_blur_radius; /**< K in pixels, 0 to the renderer's max_blur_radius */
    int32_t rays;          /**< ray samples at the largest blur, 1 to REFOCUS_MAX_RAYS, or
                                REFOCUS_RAYS_FULL; default 64 */
    uint32_t blend;        /**< enum refocus_blend; default linear */
    float sigma;        /**< sigma of the highlight weight exp(-(max(R,G,B) - 255)^2 / 2 sigma^2),
                             Yang et al. 2016, eq. 5: >= 1; INFINITY = plain average; default
                             1e30 */
    uint32_t prefilter; /**< sweep: 1 = smooth the input between rays that lie far apart,
                             and the result where all that is seen is blurred; default 1 */
    int32_t region_x, region_y;              /**< the part of the picture to render: its */
    int32_t region_width, region_height;     /**< corner and size; all 0 = the whole */
    const struct refocus_aperture *aperture; /**< NULL = a disc, the only one that scatter,
                                 foveated, interpolated and diffusion know */

    /* Features: NULL = the defaults. */
    const struct refocus_highlight_params *highlights;
    const struct refocus_thin_params *thin;
    const struct refocus_look_params *look;
    const struct refocus_focus_params *focus;
    const struct refocus_field_params *field;

    /* Methods: NULL = the defaults. */
    const struct refocus_search_params *search;
    const struct refocus_jittered_params *jittered;
    const struct refocus_scatter_params *scatter;
    const struct refocus_interpolated_params *interpolated;
    const struct refocus_foveated_params *foveated;
    const struct refocus_diffusion_params *diffusion;

    uint32_t inpaint; /**< enum refocus_inpaint; default smooth. The renderer has to be made for
                        texture: refocus_renderer_params.textured */
    uint32_t dither;  /**< enum refocus_dither; default ordered */
};

/**
 * Rays of the sweep for a still, which has the time. Rays lie apart in proportion to the blur, and
 * the blurred edge of a bright thing has as many steps as there are rays: the first of 64, in
 * linear light and before black, is 34 of 255 codes. Thread-safe.
 *
 * @param max_blur_radius  pixels; anything
 *
 * @return 64 up to a blur of 20 pixels, as many as lie as close up to 40, and 256 beyond
 */
static inline int32_t refocus_still_rays(float max_blur_radius)
{
    const float rays = max_blur_radius * max_blur_radius * 64 / 400;

    if (!(rays > 64))
        return 64;
    return rays < 256 ? (int32_t)rays + ((float)(int32_t)rays < rays) : 256;
}

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
    params.prefilter = 1;
    return params;
}

#ifdef __cplusplus
}
#endif
#endif
