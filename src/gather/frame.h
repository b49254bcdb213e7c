/* frame.h: all that one frame is rendered from, and the functions that render a tile of it. */
#ifndef RF_FRAME_H
#define RF_FRAME_H

#include "aperture/aperture.h"

#include <assert.h>
#include "aperture/cat_eye.h"
#include "aperture/cat_shape.h"
#include "aperture/ray_set.h"
#include "colour/transfer.h"
#include "focus/focus.h"
#include "gather/work_memory.h"
#include "image/chroma.h"
#include "image/deep.h"
#include "image/planes.h"
#include "image/viewport.h"
#include "passes/prefilter.h"
#include "support/executor.h"
#include "highlights/highlights.h"
#include "look/look.h"
#include "thin/thin.h"
#include "tiles/bins.h"
#include "tiles/tiles.h"

/* The curve and the weights of eq. 5 in double precision, for each 8-bit code. */
struct rf_exact {
    double light[256];
    double boundary[256]; /* light in the middle between code c and c + 1 */
    double weight[256];
};

/* Up to so many rays speed counts most; more are for stills that are to be as good as can be. */
enum { RF_LIVE_RAYS = 64 };

struct rf_method;

/* One refocus_render() call: the settings, and the planes of the window that the rays go through.
 */
struct rf_frame {
    const struct rf_executor *exec;

    /* The window and its planes, set by rf_set_planes(). */
    const struct rf_viewport *view;
    struct rf_light_q12 light;       /* the photo's own */
    struct rf_light_q12 smooth;      /* `light`, pre-filtered where rays lie far apart */
    struct rf_blur_q8 blur;          /* circle of confusion of each pixel */
    struct rf_background background; /* the inpainted hidden background */
    struct rf_weight_q15 weight;     /* eq. 5 for each pixel of `smooth` */
    struct rf_weight_q15 background_weight;
    struct rf_disparity_q16 disparity;
    struct rf_alpha_u8 alpha;
    struct rf_range_plane range;
    const struct rf_bins *bins;         /* one for each tile, row by row */
    const struct rf_yuv *yuv;           /* yuv->on: the photo is one of Y, U and V */
    struct rf_chroma_planes chroma;     /* valid if yuv->on */
    const struct rf_deep *deep;         /* deep->on: the photo is deep */
    const struct rf_deep *deep_out;     /* deep_out->on: `out` is */
    bool dither;                        /* `out` is of 8 bits and to be dithered: by *deep_out */
    const struct rf_transfer *transfer; /* the curve of the blend */
    const uint16_t *light_weight;       /* eq. 5 for each Q12 light, Q15 */
    const struct rf_ray_sets *ray_sets;
    const struct rf_cat_eye *cat_eye;
    const struct rf_cat_shape *cat_shape;
    struct rf_limits limits;
    struct rf_work_memory *work;
    void *owner; /* private to whoever made the frame */

    const struct rf_method *method;
    const struct rf_settings *params;
    const struct refocus_image *out;
    const struct refocus_aperture *aperture;
    struct rf_focus focus;
    struct rf_focus_plan plan;
    struct rf_bin_scale scale;
    struct rf_rect region; /* pixels of the window to render; `out` covers just these */
    struct rf_reach reach;
    int first_tx, first_ty, count_tx, count_ty; /* tiles of the region */
    int prefilter_above[RF_PREFILTER_STEPS];    /* |s| that each step begins at, as it is stored */
    bool prefilter_fades;                       /* steps set in gradually: rf_prefilter_over() */
    struct rf_thin_pass thin;     /* thin structures, composited over the means of rays */
    bool weighted;                /* eq. 5 weights differ from 1 */
    bool fine;                    /* the aperture is: rf_aperture_is_fine() */
    int row_gap;                  /* rf_row_gap() of gather/tile_rows.h */
    struct rf_look look;          /* spikes of stars, and grain */
    bool look_ready;              /* `look` is computed */
    bool textured;                /* texture is continued in the hidden background */
    bool splats;                  /* highlights are splatted, not gathered by rays */
    struct rf_splat splat;        /* valid if `splats`; its planes are rf_set_planes()'s */
    enum rf_bright bright;        /* how far light that rays gather exceeds RF_LIGHT_MAX */
    const struct rf_exact *exact; /* for methods in double precision, else NULL */
};

/* Whether eq. 5 weighs pixels: from sigma 10^6 on all of its weights round to 1. */
static inline bool rf_weighs(const struct rf_settings *params)
{
    return params->sigma < 1e6f;
}

static inline bool rf_is_sweep(const struct rf_frame *f)
{
    return f->params->method == REFOCUS_METHOD_SWEEP;
}

static inline bool rf_is_search(const struct rf_frame *f)
{
    return f->params->method == REFOCUS_METHOD_SEARCH;
}

/* Whether the search looks at light that highlights were subtracted from. It never gathers them:
 * rays of one test see pixels whose circle of confusion does not reach theirs, and what is
 * many times as bright as white would show there. */
static inline bool rf_searches_subtracted(const struct rf_frame *f)
{
    return rf_is_search(f) && f->splats;
}

/* The light that the search looks at: of a photo of Y, U and V luminance, D_b and D_r. */
static inline struct rf_light_q12 rf_searched_light(const struct rf_frame *f)
{
    return f->yuv->on || rf_searches_subtracted(f) ? f->smooth : f->light;
}

/* The light that rays see where they hit: no other method than the sweep takes pre-filtered one. */
static inline struct rf_light_q12 rf_hit_light(const struct rf_frame *f)
{
    return rf_is_sweep(f) ? f->smooth : rf_searched_light(f);
}

/* Whether rays skip the test of the deepest surface in reach and see the background layer there:
 * kernels->sort_rays. */
static inline bool rf_skips_deepest_test(const struct rf_frame *f)
{
    return f->params->rays != REFOCUS_RAYS_FULL && f->params->rays <= RF_LIVE_RAYS;
}

/*
 * Sums over the rays for each pixel of a tile. They are exact: Q12 light, 16 times white at the
 * most, times a Q15 weight (or 1) times a ray weight, over 65,025 rays at the most, stays below
 * 2^16 2^15 2^8 2^16 = 2^55.
 */
static_assert(UINT64_C(16) * RF_LIGHT_MAX * RF_WEIGHT_MAX * 255 * RF_FULL_RAYS < UINT64_C(1) << 55,
              "4 times the sum and half of its weight fit 64 bits");
struct rf_sums {
    uint64_t light[3][RF_TILE * RF_TILE];
    uint64_t weight[RF_TILE * RF_TILE];
};

/* The weight of the pixel at `at` of the photo's own light: eq. 5 of its brightest channel, or 1.
 */
static inline uint32_t rf_weight_of(const struct rf_frame *f, ptrdiff_t at)
{
    return f->weighted ? f->light_weight[rf_brightest_at(&f->light, at)] : 1;
}

/* The offset of a ray in whole pixels, of blurs without a unit: u s, Q15 times Q7.8, rounded half
 * up. For u = 16384 (0.5) and s = 768 (3 pixels) it is 1.5 pixels, which rounds to 2. */
static_assert(INT16_MAX * (127 * 256) + (1 << 22) <= INT32_MAX, "the product and its rounding");
static inline int rf_offset(int u, int s)
{
    return (u * s + (1 << 22)) >> 23;
}

/* The signed blur of the nearest plane, d = 1, and of the farthest, d = 0, as it is stored. */
static inline int rf_nearest_blur(const struct rf_frame *f)
{
    return -(int)(((uint32_t)(65535 - f->focus.disparity) * f->focus.radius + (1 << 15)) >> 16);
}

static inline int rf_farthest_blur(const struct rf_frame *f)
{
    return (int)(((uint32_t)f->focus.disparity * f->focus.radius + (1 << 15)) >> 16);
}

/* Prefetches the output pixels of a tile that will be written soon. */
void rf_expect_tile(const struct rf_frame *f, struct rf_rect rect);

/* Write the means of a tile to the output picture: from sums, or from Q14 means. */
void rf_encode_tile(const struct rf_frame *f, struct rf_rect rect, const struct rf_sums *sums);

void rf_encode_means(const struct rf_frame *f, struct rf_rect rect,
                     uint16_t mean[3][RF_TILE * RF_TILE]);

/* Writes those of a deep picture with what they leave over; forgets that of pixels that changed. */
struct rf_fine_means;
void rf_encode_fine(const struct rf_frame *f, struct rf_rect rect,
                    uint16_t mean[3][RF_TILE * RF_TILE], struct rf_fine_means *fine);

/* Writes Q14 means, `pitch` from row to row, to a picture of any kind: those of 8 bits at most
 * RF_MEAN_MAX. In one of 4:2:0 both rows that share samples of chroma are written at once. */
void rf_encode_rows(const struct rf_frame *f, struct rf_rect rect, const uint16_t *const mean[3],
                    int pitch);

/* Copies the pixels of a tile that is sharp: they come out as they went in. */
void rf_copy_tile(const struct rf_frame *f, struct rf_rect rect);

/* Does all of this for a deep output picture: values, `pitch` from row to row a Q14 mean when they
 * are `scale` times as large, from the first of `rect` on. Means that are a pixel's own light are
 * its own in full. `more` is NULL, or what each is more than its mean, in 1/256 of Q14. */
void rf_encode_deep(const struct rf_frame *f, struct rf_rect rect, const uint16_t *const mean[3],
                    const int16_t *const *more, ptrdiff_t pitch, int scale);

/* Does so for a picture of 8 bits, dithered. */
void rf_encode_dithered(const struct rf_frame *f, struct rf_rect rect,
                        const uint16_t *const mean[3], ptrdiff_t pitch, int scale);

/* Do so for a photo of Y, U and V, whose means are in job->luma and job->chroma. */
void rf_encode_yuv_means(const struct rf_frame *f, int tx, int ty, struct rf_rect rect,
                         struct rf_decode_job *job);
void rf_copy_yuv_tile(const struct rf_frame *f, struct rf_rect rect);

/* Writes one pixel given as codes; its alpha is the photo's. */
void rf_write_pixel(const struct rf_frame *f, int x, int y, const uint8_t rgb[3]);

/* Renders the pixels `rect` of tile (tx, ty), which lie inside that tile. */
typedef void rf_tile_fn(const struct rf_frame *f, int tx, int ty, struct rf_rect rect, int worker);
rf_tile_fn rf_sweep_tile, rf_sweep_yuv_tile, rf_search_tile, rf_search_yuv_tile;

/* Bytes of the share of a worker in f->exec that each of them needs. */
uint64_t rf_sweep_share(void);
uint64_t rf_sweep_yuv_share(void);
uint64_t rf_search_share(void);

#endif
