/* edges.h: puts the edges of a disparity map where the photo has them.
 *
 * Real maps are soft, coarse or displaced. Between two surfaces they hold a ramp of disparities
 * that nothing in the scene has, and the edge lies some pixels beside the photo's. Either shows at
 * once in a refocused picture: as crumbs and dotted lines where the ramp crosses the focus, as a
 * melting silhouette, or as a halo. These passes run in order:
 *
 *     ramps        follows each ramp to its ends, the disparities of the two surfaces, and
 *                  measures how soft the map is
 *     photo_edges  finds the map's edges, and how much of an edge the photo has at a place
 *     align        where the map as a whole does not lie on the photo, undoes what is common to all
 *                  edges (grown, shrunk, shifted), then what is common to those of a block
 *     vote         of a soft map, gives each pixel of a ramp to the surface that looks like it
 *     settle       of a soft map, gives what lies beside a ramp the disparity that its surface has
 *                  farther in
 *     thin         of a soft map, gives thin surfaces back the disparity that the softness took
 *     steady       of a video, leaves the result as it was where the map is that of the last frame
 *                  and nothing moves in the photo
 *
 * Most of a map is smooth: blocks without an edge are passed by as early as can be. Of a sharp map
 * that lies on the photo no more is made than samples of its ramps, its edges and what the photo
 * has around them.
 *
 * A map that is sharp and lies on the photo comes out as it went in, to the code. All is integer
 * arithmetic but for slopes, in single precision, and sums over blocks, in double, of which every
 * operation is rounded alike everywhere: the result is the same bits on all processors, with any
 * number of threads.
 */
#ifndef RF_EDGES_H
#define RF_EDGES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "kernels/kernels.h"
#include "support/arena.h"
#include "support/pool.h"

enum {
    RF_EDGE_STEP = 1966, /* 0.03: surfaces that are farther apart have an edge between them */
    RF_EDGE_SHIFT = 5,   /* pixels that the edges of a map may be off */
};

/* A direction that an edge of the map faces, and where: the normal points to the nearer side. */
struct rf_map_edge {
    uint16_t x, y;
    int16_t normal_x, normal_y; /* Q7 */
};

/* How strongly the colours of the photo change at a pixel: of the channel that changes most, in
 * 1/16 code a pixel. */
struct rf_photo_gradient {
    int16_t *x, *y;
    ptrdiff_t stride;
};

/* Memory of align.c for blocks of a map. */
struct rf_edge_blocks {
    int32_t *support, *count;
    double *right, *below, *weight;
};

/* The frame of a video before this one: decisions that are close calls stay as they were. Planes
 * are of the size that work is done at, without padding. */
struct rf_last_edges {
    int width, height; /* 0: there is none */
    uint16_t *result;  /* at least 1; 0: it is decided anew */
    uint8_t *map;      /* as it came in when the result was decided, upper eight bits */
    uint8_t *photo;    /* as it was then, green */
    double softness;   /* pixels of this size */
    bool parted;       /* the last map was soft */
    bool aligned;      /* the last map was moved */
};

/* Everything that the passes work on: planes of width x height, all of the same stride. The map has
 * a border of one pixel, which repeats its sides. Results that are never needed at once share
 * memory, in this order of their lives:
 *
 *     near, far  samples as they came | ends of ramps | shares and mixtures of thin surfaces
 *     largest    steps of ramps | slope of the map | voters | cores
 *     spare      where ways up ramps have come to | smoothed photo or map | what replaces map or
 *                label | the greatest values along rows
 *     label      where ways have come to, too | labels
 *     kept       the map before a change | contrast beside ramps | what is near thin surfaces
 *     steepest   where the map rises and falls most | is_wide
 *     length     pixels to the ends of ramps | the list of edges, and blocks of align.c
 */
struct rf_edges {
    const struct rf_kernels *kernels;
    struct rf_pool *pool;
    int width, height;
    ptrdiff_t stride; /* elements, of every plane here */

    uint8_t *colour[3];   /* the photo */
    uint16_t *map;        /* Q16; replaced by the result */
    uint8_t *steepest;    /* where the map rises and falls most: kernels/edges.h */
    uint8_t *is_wide;     /* 0: beside a ramp, of a surface that does not go on beyond it */
    uint16_t *near, *far; /* the ends of a ramp; both are the pixel's own where there is none */
    uint16_t *label;      /* the end that a pixel of a ramp is closer to; else its own disparity */
    uint16_t *largest;    /* the largest step on a ramp */
    uint16_t *length;     /* pixels to the farther end of a ramp */
    uint16_t *spare;      /* output of a pass before it replaces its input */
    uint16_t *kept;       /* the map before a change that may be taken back */
    struct rf_photo_gradient gradient;
    struct rf_edge_range *range; /* one for each block that is looked at or left alone together */
    uint8_t *rough;              /* one for each block: whether there may be an edge */
    uint8_t *rough_cell;         /* one for each cell of ramps.c: whether a block of it is */
    uint8_t *moved[2];           /* 1: ways in this cell still go on; in steady.c, which is the
                                    first: in this block something has moved */
    struct rf_map_edge *edge;
    int edges, most_edges;
    struct rf_edge_blocks blocks;
    const struct rf_last_edges *last; /* NULL: there is none */
};

static inline int rf_edge_blocks_across(const struct rf_edges *e)
{
    return (e->width + RF_EDGE_BLOCK - 1) / RF_EDGE_BLOCK;
}

/* Copies all rows, without their border. */
static inline void rf_copy_plane(const struct rf_edges *e, uint16_t *to, const uint16_t *from)
{
    for (int y = 0; y < e->height; y++)
        memcpy(to + y * e->stride, from + y * e->stride, (size_t)e->width * sizeof *to);
}

static inline bool rf_edge_is_rough(const struct rf_edges *e, int x, int y)
{
    return e->rough[y / RF_EDGE_BLOCK * rf_edge_blocks_across(e) + x / RF_EDGE_BLOCK];
}

/* The pixels from x on of a row up to where rough blocks end or begin. */
static inline int rf_edge_run(const struct rf_edges *e, int x, int y, bool *is_rough)
{
    const uint8_t *rough = e->rough + (ptrdiff_t)(y / RF_EDGE_BLOCK) * rf_edge_blocks_across(e);
    int end = x;

    *is_rough = rough[x / RF_EDGE_BLOCK];
    while (end < e->width && rough[end / RF_EDGE_BLOCK] == *is_rough)
        end += RF_EDGE_BLOCK;
    return (end < e->width ? end : e->width) - x;
}

/* Marks the blocks around which a plane differs by more than RF_EDGE_STEP. */
void rf_find_rough_blocks(struct rf_edges *e, const uint16_t *plane);

/* Writes steepest, of the map as it is now, and marks rough blocks. */
void rf_find_steepest(struct rf_edges *e);

/* The softness of the map's edges: the standard deviation in pixels of the Gaussian that would make
 * such ramps of sharp edges, which so many percent of them do not exceed. 0: there are too few to
 * tell. After rf_find_steepest(). */
double rf_measure_softness(const struct rf_edges *e, int percentile);

/* The share of pixels on ramps that are alone between two surfaces, as means over areas are. After
 * rf_find_steepest(). */
double rf_share_mixed(const struct rf_edges *e);

/* The percentile that is the softness of a map. Wires and hair look less soft than the map is:
 * their two ramps overlap. */
enum { RF_SOFTNESS_PERCENTILE = 85 };

/* Limits of what is taken for a ramp. */
struct rf_ramp_limits {
    int steps;    /* a longer one is a slope: it is left as it is */
    int contrast; /* Q16: so is one of less */
};

/* Follows each ramp to its ends: writes near, far and label. After rf_find_steepest(). */
void rf_find_ramps(struct rf_edges *e, struct rf_ramp_limits limits);

/* Whether a disparity is between two others and not close to either. */
static inline bool rf_is_mixed(int near, int far, int disparity)
{
    const int contrast = near - far, above = 20 * (disparity - far);

    return above > 3 * contrast && above < 17 * contrast;
}

/* Whether a pixel is on a ramp and not close to either end. */
static inline bool rf_is_between(const struct rf_edges *e, ptrdiff_t i, int disparity)
{
    return rf_is_mixed(e->near[i], e->far[i], disparity);
}

/* Writes the gradient of the photo. */
void rf_find_photo_gradient(struct rf_edges *e);

/* Writes the list of edges in rough blocks of a plane of disparities; none if they are too many. */
void rf_find_map_edges(struct rf_edges *e, const uint16_t *plane);

/* How much of an edge of this direction the photo has at (x, y), at most RF_EDGE_SHIFT + 1 pixels
 * from it: up to RF_MOST_PHOTO_EDGE. */
int rf_photo_edge_at(const struct rf_edges *e, const struct rf_map_edge *edge, int x, int y);

/* Makes near surfaces smaller by so many pixels, < 0: larger. It uses the memory of label. */
enum { RF_MOST_GROWN = RF_EDGE_SHIFT + 1 };
void rf_regrow(struct rf_edges *e, int grown);

/* The findings of rf_align(). */
struct rf_alignment {
    double on_photo;      /* share of the edges that lie on the photo's, 0 to 1 */
    int grown;            /* pixels that near surfaces were too large by; < 0: too small */
    int shift_x, shift_y; /* pixels that the map was moved by */
    bool bent;            /* edges were moved block by block */
};

/*
 * Moves the edges of the map onto the photo's, where they are not and where that is certain.
 * near, far and label are those of the map within these limits, and are written again when it
 * changes. NULL: they are not known, and the map is sharp.
 */
struct rf_alignment rf_align(struct rf_edges *e, double softness,
                             const struct rf_ramp_limits *limits);

/* Lays out e->blocks for width x height pixels. */
void rf_align_lay_out(struct rf_edges *e, struct rf_arena *arena);

/* Gives each pixel the greatest value of a plane within a square of 2 width + 1 pixels, up to 31.
 */
void rf_widen(struct rf_edges *e, uint16_t *plane, uint16_t *spare, int width);

/* Decides for each pixel between the ends of a ramp: writes label. */
void rf_vote(struct rf_edges *e, double softness);

/* Takes overshoot beside ramps out of label; writes is_wide. */
void rf_settle(struct rf_edges *e, double softness);

/* Forgets the last result where the map is another one, or something moves near by. */
void rf_forget_moved(struct rf_edges *e, struct rf_last_edges *last);

/* Elsewhere the result stays that of the last frame, or follows it slowly; it replaces that. */
void rf_hold_still(struct rf_edges *e, struct rf_last_edges *last);

/* Restores the disparity of thin surfaces in label, of which the map holds a softened copy. */
void rf_restore_thin(struct rf_edges *e, double softness);

#endif
