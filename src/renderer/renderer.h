/* renderer.h: what a renderer holds. One block of memory, laid out by layout.c. */
#ifndef RF_RENDERER_H
#define RF_RENDERER_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#include <refocus/render.h>

#include "aperture/cat_eye.h"
#include "aperture/cat_shape.h"
#include "colour/transfer.h"
#include "colour/yuv.h"
#include "finish/finish.h"
#include "focus/focus.h"
#include "highlights/highlights.h"
#include "highlights/rims.h"
#include "kernels/kernels.h"
#include "planes/prefilter.h"
#include "support/pool.h"
#include "thin/thin.h"
#include "thin/veil.h"

enum {
    RF_GROUP = 4,        /* planes that lie together */
    RF_LEVELS = 18,      /* of the pyramid that fills the background, level 0 not counted */
    RF_RAY_CLASSES = 12, /* a preset's own set and smaller ones; denser ones for lamps */
    RF_FULL_RAYS = 255 * 255,
};

#define RF_NO_METHOD UINT32_MAX

/* Rays and runs of equal weight among them. */
struct rf_ray_set {
    struct refocus_ray *ray;
    struct refocus_ray *before; /* those before the focus: the same, or as many others */
    const int16_t *u, *v;       /* of those behind, by themselves; NULL of a full mask */
    int count;
    int shared; /* by chroma; see rf_shared_rays() */
    uint64_t total_weight;
    bool equal; /* all rays weigh the same */
};

/* Chroma of a photo of Y, U and V takes some rays of luma; those among rays first to end - 1, which
 * are of one chunk, are the first so many of them. */
static inline int rf_shared_rays(const struct rf_ray_set *set, int first, int end)
{
    const int64_t shared = set->shared;

    return (int)(shared * end / set->count - shared * first / set->count);
}

/* Pixels x0 <= x < x1, y0 <= y < y1. */
struct rf_rect {
    int x0, y0, x1, y1;
};

/* The photo as it was prepared. */
#define RF_NO_BLEND UINT32_MAX

struct rf_photo {
    int width, height;              /* pixels; 0: none prepared */
    int pad;                        /* pixels beyond each side that may be read */
    ptrdiff_t stride;               /* elements from row to row, of all padded planes */
    ptrdiff_t pitch;                /* elements between the planes of a group; see layout.c */
    uint16_t *group;                /* of four planes: R, G, B, disparity */
    uint16_t *light[3], *disparity; /* pixel (0, 0); not in strip mode */
    uint8_t *alpha;                 /* unpadded, width a row */
    uint8_t *band_blend;            /* enum refocus_blend that the light of a band of rows is in */
    uint32_t capacity;              /* of rims */
    struct rf_rim *rim;
    uint32_t rims;
    struct rf_highlights highlights[RF_LAMP_PARTS];
    uint32_t highlights_blend; /* that they were found in, or RF_NO_BLEND */
    struct rf_thin_list thin;
};

/* What the planes of the last lens setting hold, so that it need not be made again. */
struct rf_made {
    bool blur;   /* front.blur and bins, */
    bool rims;   /* with the rims in them, */
    bool lamps;  /* and highlights marked and widened in them, */
    bool drawn;  /* or marked to be drawn */
    bool ranges; /* its ranges; before, its cells are where the background's blur will be */
    bool smooth; /* the pre-filtered light */
    enum rf_bright bright; /* with light given back to lamps, */
    bool spread;           /* the light of lamps is in it */
    bool behind;           /* the background layer, */
    bool weighed;          /* but with weights of `sigma` in place of its blur, */
    bool premultiplied;    /* and the light of both layers times them */
    float sigma;
    int rays;              /* that lamps were widened for */
    struct rf_rect window; /* of that photo, to which all of it is limited */
    struct rf_rect exact;  /* where it is as if made for the whole photo */
    struct rf_focus_plan plan;
    int shift;     /* of the bins */
    uint32_t thin; /* as what thin things were taken apart, made_thin(), */
    int veil_blur; /* and from where on */
    uint32_t blend;
    float gain;
    int prefilter_above[RF_PREFILTER_STEPS];
};

/* A level of the background pyramid, without padding but with an even stride. */
struct rf_level {
    int width, height;
    ptrdiff_t stride;
    uint16_t *light[3];
    int16_t *blur; /* RF_NO_BLUR: nothing known here */
};

/*
 * Strip mode: the photo stays with the caller, and planes hold a window of it at a time, that
 * of a block with a margin. What is known of the background is marked for the whole photo, a
 * bit a pixel, and the background's pyramid is kept from level RF_KEPT on.
 */
enum { RF_KEPT = 3 };

struct rf_in_place {
    bool on;
    struct refocus_image photo; /* the caller's */
    struct refocus_disparity map;
    int code_step;               /* of the map, rf_code_step() */
    int block, margin;           /* pixels of a block that is rendered, and around it */
    int mark_block, mark_margin; /* of one whose background is marked */
    struct rf_rect beyond;       /* of the margin in use, what lies beyond the photo */
    uint8_t *known;              /* known_stride bytes a row, bit x % 8 of byte x / 8 */
    ptrdiff_t known_stride;
    struct rf_level kept[RF_LEVELS]; /* [i]: level i + 1, from RF_KEPT on */
    int levels;
};

/* A set of planes of one size. Pixel (x, y) is at [y * stride + x]; x and y may be
 * negative by as much as the padding. */
struct rf_layer {
    uint16_t *light[3]; /* Q12; R, G, B */
    int16_t *blur;      /* signed blur s = K (df - d), Q7.8 pixels: near is negative */
};

/* Occupied bins of signed blur, a bit each, nearest first, and the extremes in them. */
struct rf_bins {
    uint64_t word[RF_BINS / 64];
    int16_t least, most; /* Q7.8 */
    int16_t lamp;        /* largest |s| of a highlight, Q7.8; 0: none; */
    int16_t dots;        /* of one that is small beside the gaps of the rays */
    int16_t behind;      /* blur of the background in the middle, once that is filled */
    uint16_t brightest;  /* light of either layer, as it is summed; or more */
    bool taken;          /* lamps are taken out of its light, highlights/taken.c */
};

/*
 * A photo of Y, U and V. Luminance is in light[0] of the layers. Planes of chroma hold two
 * values for each sample, D_b and D_r of colour/yuv.h, side by side: a tile's are as wide as the
 * tile, and what is done to luma by rows is done to them in the same way. They take the place of
 * the layers' light[1], and use their stride; the blur of chroma, given twice, that of
 * smooth[2]. The codes that came in are kept: Y in place of alpha, U V in that of light[2].
 * front.light[1] and [2] are luminance, too, for those who ask for the brightest.
 */
struct rf_yuv {
    bool on;                       /* else it is of R, G and B, and the rest is not valid */
    int down;                      /* rows of the photo to one of chroma: 1 << down */
    uint32_t matrix, range, blend; /* that curve is for */
    bool curve_made;
    struct rf_yuv_curve curve;

    /* Of the window, by rf_yuv_use(). */
    int width, height; /* samples of chroma */
    uint16_t *light;   /* of the photo, */
    uint16_t *smooth;  /* pre-filtered */
    uint16_t *behind;  /* and of the background */
    int16_t *blur;
    uint16_t *weight; /* eq. 5, of luma; in the background's light[2] */
    uint8_t *y;       /* y_stride a row */
    uint8_t *uv;      /* 2 width a row, rows uv_stride apart */
    ptrdiff_t y_stride, uv_stride;
};

struct refocus_renderer {
    struct refocus_allocator allocator;
    struct refocus_log log;
    void *block;
    uint64_t memory;
    uint32_t cpu; /* enum refocus_cpu, never AUTO */
    struct rf_kernels kernels;
    int max_width, max_height;
    float max_blur_radius;

    struct rf_pool pool;
    struct rf_run run;

    /* The prepared photo, and memory for what a lens setting makes of it. */
    bool prepared;
    struct rf_photo photo;
    uint16_t *seen_group, *behind_group;
    struct rf_made made;
    struct rf_in_place in_place;
    struct rf_focus_plan last_plan; /* of the last render, */
    bool last_rims;                 /* with the rims, */
    bool blurred;                   /* if there was one */

    /*
     * The window: the part of the photo that passes work on, set by rf_use(). What
     * follows is as if that part were all there is: its size, and its pixel (0, 0) in all
     * planes. It begins at (origin_x, origin_y) of the photo, a multiple of RF_TILE.
     */
    int origin_x, origin_y;
    int width, height;
    int pad;               /* pixels beyond each side that may be read */
    struct rf_rect border; /* pixels beyond each side that rf_extend_rows() sets */
    ptrdiff_t stride;      /* elements from row to row, of all padded planes */
    ptrdiff_t pitch;       /* elements between the planes of a group; see layout.c */
    uint32_t blend;        /* that the light planes are in */
    uint16_t *disparity;   /* padded, its border is not set */
    uint8_t *alpha;        /* alpha_stride a row */
    ptrdiff_t alpha_stride;
    struct rf_layer front;
    struct rf_yuv yuv;
    uint16_t *smooth[3];    /* front.light, pre-filtered where rays lie far apart */
    struct rf_layer behind; /* the background layer */
    struct rf_level level[RF_LEVELS];
    int levels;
    uint16_t *weight;        /* of smooth, eq. 5, once the background is filled: its memory */
    ptrdiff_t weight_stride; /* is the pyramid's. Those of behind are where its blur was. */
    uint32_t *range;         /* blurs around the cell of pixel (0, 0); see tiles/ranges.h */
    ptrdiff_t range_stride;
    int tiles_x, tiles_y;
    struct rf_bins *bins; /* of each tile */

    struct rf_taps *taps;  /* of the depth upsampler: of columns, then of rows */
    struct rf_span *spans; /* and its spans */
    uint16_t *scratch;     /* rows of each worker; see rf_scratch() */

    struct rf_transfer transfer[RF_BLEND_COUNT];
    uint16_t *light_weight; /* eq. 5: weight of Q12 light max(R, G, B), Q15 */
    bool keep_codes;        /* which may be used */
    float weight_sigma;     /* that it was made for, in weight_blend */
    uint32_t weight_blend;

    bool has_thin; /* there is memory for what is thin: */
    struct rf_veil veil;
    struct rf_star *star; /* of this lens setting */
    int stars;
    struct rf_grain *grain; /* of this lens setting */
    uint32_t renders;       /* so far, that had maps of their own */

    uint8_t *work;       /* memory of the methods that work on whole frames, one at a time */
    uint32_t work_owner; /* whose tables are still in it, or RF_NO_METHOD */
    uint32_t methods;    /* REFOCUS_METHOD_BIT of those that it suffices for */

    struct refocus_ray *rays; /* memory of all sets */
    struct rf_ray_set set[RF_RAY_CLASSES];
    int sets;              /* how many are filled, 0: none yet */
    int preset;            /* the one that has as many rays as were asked for */
    uint64_t set_aperture; /* what they were made for */
    int set_rays;
    bool set_denser;
    bool set_shared; /* chroma's rays come first */
    float set_blur;
    struct rf_cat_eye cat_eye;     /* made when it is first asked for; */
    struct rf_cat_shape cat_shape; /* that of the last aperture with one */
};

/* Make a part of the photo the window. */
void rf_use(struct refocus_renderer *r, struct rf_rect window);
static inline struct rf_rect rf_whole(const struct refocus_renderer *r)
{
    return (struct rf_rect){0, 0, r->photo.width, r->photo.height};
}

/* A worker's scratch: two rows of the largest picture with the margins of spread_row. */
static inline uint64_t rf_scratch_size(int max_width)
{
    return 2 * ((uint64_t)max_width + 2 * RF_SPREAD_MARGIN);
}

static inline uint16_t *rf_scratch(const struct refocus_renderer *r, int worker)
{
    return r->scratch + (size_t)worker * rf_scratch_size(r->max_width);
}

#endif
