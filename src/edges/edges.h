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
 *     settle       of a soft map, gives what lies beside a ramp the disparity of its surface
 * farther in thin         of a soft map, gives thin surfaces back the disparity that the softness
 * took
 *
 * A map that is sharp and lies on the photo comes out as it went in, to the code. All is integer
 * arithmetic but for sums over blocks, in double precision, of which every operation is rounded
 * alike everywhere: the result is the same bits on all processors, with any number of threads.
 */
#ifndef RF_EDGES_H
#define RF_EDGES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "kernels/kernels.h"
#include "support/arena.h"
#include "support/pool.h"

enum {
    RF_EDGE_BAND = 16,   /* rows of a work item */
    RF_EDGE_BLOCK = 8,   /* pixels of a side of a block that is looked at or left alone together */
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

/* Disparities in a block. */
struct rf_edge_range {
    uint16_t least, most;
};

/* Everything that the passes work on: planes of width x height, all of the same stride. The map has
 * a border of one pixel, which repeats its sides. Results that are never needed at once share
 * memory, in this order of their lives:
 *
 *     near, far  samples as they came | ends of ramps | shares and mixtures of thin surfaces
 *     largest    steps of ramps | slope of the map | voters | contrast along rows | cores
 *     spare      smoothed photo or map | what replaces map or label
 *     kept       the map before a change | contrast beside ramps
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
    uint16_t *spare;      /* output of a pass before it replaces its input */
    uint16_t *kept;       /* the map before a change that may be taken back */
    struct rf_photo_gradient gradient;
    struct rf_edge_range *range; /* one for each block */
    uint8_t *rough;              /* one for each block: whether there may be an edge */
    struct rf_map_edge *edge;
    int edges, most_edges;
    struct rf_edge_blocks blocks;
};

static inline int rf_edge_bands(const struct rf_edges *e)
{
    return (e->height + RF_EDGE_BAND - 1) / RF_EDGE_BAND;
}

static inline int rf_edge_blocks_across(const struct rf_edges *e)
{
    return (e->width + RF_EDGE_BLOCK - 1) / RF_EDGE_BLOCK;
}

static inline bool rf_edge_is_rough(const struct rf_edges *e, int x, int y)
{
    return e->rough[y / RF_EDGE_BLOCK * rf_edge_blocks_across(e) + x / RF_EDGE_BLOCK];
}

/* Marks the blocks around which a plane differs by more than RF_EDGE_STEP. */
void rf_find_rough_blocks(struct rf_edges *e, const uint16_t *plane);

/* How far a ramp is followed, and the least contrast that makes one of it. */
struct rf_ramp_limits {
    int steps;    /* a longer one is a slope: it is left as it is */
    int contrast; /* Q16 */
    bool part;    /* label is one of the ends; false: label is the map */
};

/* Writes near, far and label. */
void rf_find_ramps(struct rf_edges *e, struct rf_ramp_limits limits);

/* The softness of the map's edges: the standard deviation in pixels of the Gaussian that would make
 * such ramps of sharp edges. 0: there are too few to tell. To be called after rf_find_ramps(). */
double rf_measure_softness(const struct rf_edges *e);

/* Whether a pixel is on a ramp and not close to either end. */
static inline bool rf_is_between(const struct rf_edges *e, ptrdiff_t i, int disparity)
{
    const int contrast = e->near[i] - e->far[i], above = 20 * (disparity - e->far[i]);

    return above > 3 * contrast && above < 17 * contrast;
}

/* Writes the gradient of the photo. */
void rf_find_photo_gradient(struct rf_edges *e);

/* Writes the list of edges of a plane of disparities; none if they are too many. */
void rf_find_map_edges(struct rf_edges *e, const uint16_t *plane);

/* How much of an edge of this direction the photo has at (x, y): at most RF_MOST_PHOTO_EDGE. */
enum { RF_MOST_PHOTO_EDGE = 40 * 16 };
int rf_photo_edge_at(const struct rf_edges *e, const struct rf_map_edge *edge, int x, int y);

/* The findings of rf_align(). */
struct rf_alignment {
    double on_photo;      /* share of the edges that lie on the photo's, 0 to 1 */
    int grown;            /* pixels that near surfaces were too large by; < 0: too small */
    int shift_x, shift_y; /* pixels that the map was moved by */
    bool bent;            /* edges were moved block by block */
};

/*
 * Moves the edges of the map onto the photo's, where they are not and where that is certain.
 * near, far and label are those of the map, and are written again when it changes.
 */
struct rf_alignment rf_align(struct rf_edges *e, double softness, struct rf_ramp_limits limits);

/* Lays out e->blocks for width x height pixels. */
void rf_align_lay_out(struct rf_edges *e, struct rf_arena *arena);

/* Decides for each pixel between the ends of a ramp: writes label. */
void rf_vote(struct rf_edges *e, double softness);

/* Takes overshoot beside ramps out of label; writes is_wide. */
void rf_settle(struct rf_edges *e, double softness);

/* Restores the disparity of thin surfaces in label, of which the map holds a softened copy. */
void rf_restore_thin(struct rf_edges *e, double softness);

#endif
