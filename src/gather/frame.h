/* method.h: what a renderer calls for each tile. */
#ifndef RF_FRAME_H
#define RF_FRAME_H

#include "aperture/aperture.h"
#include "aperture/cat_eye.h"
#include "aperture/cat_shape.h"
#include "aperture/ray_set.h"
#include "colour/transfer.h"
#include "focus/focus.h"
#include "gather/work_memory.h"
#include "image/chroma.h"
#include "image/planes.h"
#include "image/viewport.h"
#include "passes/prefilter.h"
#include "support/executor.h"
#include "highlights/highlights.h"
#include "look/look.h"
#include "thin/thin.h"
#include "tiles/bins.h"
#include "tiles/tiles.h"

/* Curve and weights of eq. 5 in double precision, of 8-bit codes. */
struct rf_exact {
    double light[256];
    double boundary[256]; /* light in the middle between code c and c + 1 */
    double weight[256];
};

enum { RF_LIVE_RAYS = 64 }; /* more are for stills that are to be as good as can be */

struct rf_method;

/* One refocus_render() call: the settings, and the planes of the window that the rays go through.
 */
struct rf_frame {
    const struct rf_executor *exec;

    /* The window and its planes, set by rf_set_planes(). */
    const struct rf_viewport *view;
    struct rf_light_q12 light;       /* of the photo */
    struct rf_light_q12 smooth;      /* pre-filtered where rays lie far apart */
    struct rf_blur_q8 blur;          /* circle of confusion of each pixel */
    struct rf_background background; /* hidden background */
    struct rf_weight_q15 weight;     /* eq. 5, of `smooth` */
    struct rf_weight_q15 background_weight;
    struct rf_disparity_q16 disparity;
    struct rf_alpha_u8 alpha;
    struct rf_range_plane range;
    const struct rf_bins *bins;         /* of each tile, row by row */
    const struct rf_yuv *yuv;           /* yuv->on: it is a photo of Y, U and V, */
    struct rf_chroma_planes chroma;     /* of which these are */
    const struct rf_transfer *transfer; /* curve of the blend */
    const uint16_t *light_weight;       /* eq. 5 by Q12 light, Q15 */
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
    struct rf_rect region; /* of the window (renderer.h); out covers just this */
    struct rf_reach reach;
    int first_tx, first_ty, count_tx, count_ty; /* tiles of the region */
    int prefilter_above[RF_PREFILTER_STEPS];    /* |s| that each step begins at, Q7.8 */
    bool prefilter_fades;                       /* they come in gradually: rf_prefilter_rows() */
    struct rf_thin_pass thin;     /* thin structures that are composited over what rays see */
    bool weighted;                /* eq. 5 weights differ from 1, */
    bool premultiplied;           /* and little enough for light times weight in 16 bits */
    bool fine;                    /* the opening is: rf_aperture_is_fine() */
    int row_gap;                  /* see methods/tile_rows.h */
    struct rf_look look;          /* spikes of stars, and grain, */
    bool look_ready;              /* once they are found out */
    bool splats;                  /* highlights are splatted, as this says, */
    struct rf_splat splat;        /* of the planes that rf_set_planes() set; or else */
    enum rf_bright bright;        /* rays gather their light, which exceeds RF_LIGHT_MAX */
    const struct rf_exact *exact; /* of methods in double precision, else NULL */
};

/* Beyond that sigma all weights of eq. 5 round to 1. */
static inline bool rf_weighs(const struct rf_settings *params)
{
    return params->sigma < 1e6f;
}

static inline bool rf_is_sweep(const struct rf_frame *f)
{
    return f->params->method == REFOCUS_METHOD_SWEEP;
}

/* Whether rays take the background for what is deepest in sight: kernels->sort_rays. */
static inline bool rf_looks_beneath(const struct rf_frame *f)
{
    return f->params->rays != REFOCUS_RAYS_FULL && f->params->rays <= RF_LIVE_RAYS;
}

/*
 * Sums over the rays of the pixels of a tile. Exact: Q12 light, four times white at the
 * most, times Q15 weight (or 1) times a ray weight, 65,025 rays at the most, stays
 * below 2^14 2^15 2^8 2^16 = 2^53.
 */
struct rf_sums {
    uint64_t light[3][RF_TILE * RF_TILE];
    uint64_t weight[RF_TILE * RF_TILE];
};

/* Weight of the pixel at `at` of light planes: eq. 5, or 1. */
static inline uint32_t rf_weight_of(const struct rf_frame *f, uint16_t *const light[3],
                                    ptrdiff_t at)
{
    uint16_t most = light[0][at];

    if (!f->weighted)
        return 1;
    most = light[1][at] > most ? light[1][at] : most;
    most = light[2][at] > most ? light[2][at] : most;
    most = most > RF_LIGHT_MAX ? RF_LIGHT_MAX : most; /* highlights lie above */
    return f->light_weight[most];
}

/* Offset of a ray in whole pixels: round half up of u s, Q15 times Q7.8. */
static inline int rf_offset(int u, int s)
{
    return (u * s + (1 << 22)) >> 23;
}

/* Signed blur of the nearest and the farthest plane, Q7.8. */
static inline int rf_nearest_blur(const struct rf_frame *f)
{
    return -(int)(((uint32_t)(65535 - f->focus.disparity) * f->focus.radius + (1 << 15)) >> 16);
}

static inline int rf_farthest_blur(const struct rf_frame *f)
{
    return (int)(((uint32_t)f->focus.disparity * f->focus.radius + (1 << 15)) >> 16);
}

/* A tile of the output picture will be written soon. */
void rf_expect_tile(const struct rf_frame *f, struct rf_rect rect);

/* Means of a tile into the output picture. */
void rf_encode_tile(const struct rf_frame *f, struct rf_rect rect, const struct rf_sums *sums);

void rf_encode_means(const struct rf_frame *f, struct rf_rect rect,
                     uint16_t mean[3][RF_TILE * RF_TILE]);

/* n Q14 means of row y from column x0 on, at most RF_MEAN_MAX. */
void rf_encode_row(const struct rf_frame *f, int x0, int y, int n, const uint16_t *const mean[3]);

/* Pixels that come out as they went in. */
void rf_copy_tile(const struct rf_frame *f, struct rf_rect rect);

/* The same for a photo of Y, U and V, from job->luma and job->chroma. */
void rf_encode_yuv_means(const struct rf_frame *f, int tx, int ty, struct rf_rect rect,
                         struct rf_decode_job *job);
void rf_copy_yuv_tile(const struct rf_frame *f, struct rf_rect rect);

/* One pixel given as codes; alpha is the photo's. */
void rf_write_pixel(const struct rf_frame *f, int x, int y, const uint8_t rgb[3]);

/* rect: at most RF_TILE x RF_TILE, inside one tile. */
typedef void rf_tile_fn(const struct rf_frame *f, int tx, int ty, struct rf_rect rect, int worker);
rf_tile_fn rf_sweep_tile, rf_sweep_yuv_tile, rf_search_tile;

#endif
