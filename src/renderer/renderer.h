/* renderer.h: what a renderer holds. One block of memory, laid out by layout.c. */
#ifndef RF_RENDERER_H
#define RF_RENDERER_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#include <refocus/render.h>

#include "colour/transfer.h"
#include "highlights/highlights.h"
#include "highlights/rims.h"
#include "kernels/kernels.h"
#include "support/pool.h"

enum {
    RF_GROUP = 4,     /* planes that lie together */
    RF_LEVELS = 18,   /* of the pyramid that fills the background, level 0 not counted */
    RF_RAY_CLASSES = 12, /* a preset's own set and smaller ones; denser ones for lamps */
    RF_FULL_RAYS = 255 * 255,
};

#define RF_NO_METHOD UINT32_MAX

/* Rays and runs of equal weight among them. */
struct rf_ray_set {
    struct refocus_ray *ray;
    int count;
    uint64_t total_weight;
    bool equal; /* all rays weigh the same */
};

/* A set of planes of one size. Pixel (x, y) is at [y * stride + x]; x and y may be
 * negative by as much as the padding. */
struct rf_layer {
    uint16_t *light[3]; /* Q12; R, G, B */
    int16_t *blur;      /* signed blur s = K (df - d), Q7.8 pixels: near is negative */
};

/* A level of the background pyramid, without padding but with an even stride. */
struct rf_level {
    int width, height;
    ptrdiff_t stride;
    uint16_t *light[3];
    int16_t *blur; /* RF_NO_BLUR: nothing known here */
};

/* Occupied bins of signed blur, a bit each, nearest first, and the extremes in them. */
struct rf_bins {
    uint64_t word[RF_BINS / 64];
    int16_t least, most; /* Q7.8 */
    int16_t lamp;        /* largest |s| of a highlight, Q7.8; 0: none */
    int16_t behind;      /* blur of the background in the middle, once there are weights */
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
    atomic_int run; /* enum rf_run */

    /* The prepared photo. */
    bool prepared;
    int width, height;
    int pad;            /* pixels beyond each side that may be read */
    ptrdiff_t stride;   /* elements from row to row, of all padded planes */
    ptrdiff_t pitch;    /* elements between the planes of a group; see layout.c */
    uint32_t blend;     /* that the light planes are in */
    uint16_t *disparity; /* padded, its border is not set */
    uint8_t *alpha;     /* unpadded, width a row */
    struct rf_layer front;
    uint32_t *range;     /* blurs around the cell of pixel (0, 0); see tiles/ranges.h */
    ptrdiff_t range_stride;
    uint16_t *smooth[3]; /* front.light, pre-filtered where rays lie far apart */
    struct rf_highlights highlights[RF_LAMP_PARTS]; /* of the photo in this blend, once */
    bool highlights_found;                          /* they are found */
    struct rf_rim *rim; /* of the photo */
    uint64_t rims;

    /* Of the last lens setting. */
    struct rf_layer behind; /* the background layer */
    struct rf_level level[RF_LEVELS];
    int levels;
    uint16_t *weight;        /* of smooth, eq. 5, once the background is filled: its memory */
    ptrdiff_t weight_stride; /* is the pyramid's. Those of behind are where its blur was. */
    int tiles_x, tiles_y;
    struct rf_bins *bins; /* of each tile */
    struct rf_taps *taps; /* of the depth upsampler: of columns, then of rows */
    uint16_t *near_by;    /* how near its samples are, four rows */
    int32_t *column;      /* and its offsets of samples in a row of the photo, from -2 on */
    uint16_t *scratch;    /* rows of each worker; see rf_scratch() */
    bool blurred;         /* front.blur is valid */

    struct rf_transfer transfer[RF_BLEND_COUNT];
    uint16_t *light_weight; /* eq. 5: weight of Q12 light max(R, G, B), Q15 */
    float weight_sigma;     /* that it was made for, in weight_blend */
    uint32_t weight_blend;

    uint8_t *work;       /* memory of the methods that work on whole frames, one at a time */
    uint32_t work_owner; /* whose tables are still in it, or RF_NO_METHOD */
    uint32_t methods;    /* REFOCUS_METHOD_BIT of those that it suffices for */

    struct refocus_ray *rays;    /* memory of all sets */
    struct rf_ray_set set[RF_RAY_CLASSES];
    int sets;               /* how many are filled, 0: none yet */
    int preset;             /* the one that has as many rays as were asked for */
    uint64_t set_aperture;  /* what they were made for */
    int set_rays;
    bool set_denser;
    float set_blur;
};

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
