/* diffusion.h: the parts of generalized depth of field by simulated heat diffusion. */
#ifndef RF_DIFFUSION_H
#define RF_DIFFUSION_H

#include "papers/papers.h"

/* The part of the planes that a layer can reach. Planes have one pixel more on each side: pixel
 * (x, y) is at [y * stride + x], x and y from -1. */
struct rf_box {
    int x0, y0, x1, y1;
    ptrdiff_t stride;
};

/*
 * `steps` steps of Kosloff & Barsky 2007, section 7.3,
 *
 *     C'(p) = W_c C(p) + 1/4 sum over the four neighbours q of W(q) C(q),
 *     W_c = 1 - 1/4 sum of W(q)
 *
 * W is 0 outside of the box. A cancelled run ends early.
 */
void rf_diffuse_steps(const struct rf_frame *f, const struct rf_box *box, const float *weight,
                      float *plane, float *scratch, int steps);

/* The coefficients of a series that gives the result of n steps at once: A^n for the matrix A of a
 * step. Its eigenvalues are in [1 - 2 W, 1], W the largest weight, and there
 *
 *     x^n = sum of coefficient[k] T_k(1 + (x - 1) / W),   T_k Chebyshev's polynomials,
 *
 * of which the first sqrt(n W) or so matter. */
enum { RF_SERIES_MOST = 1024 };
struct rf_series {
    int terms;
    float coefficient[RF_SERIES_MOST];
};
void rf_series_make(struct rf_series *series, int steps, double largest_weight);

/* A part of a row: columns x0 to x1 - 1. */
struct rf_span {
    int x0, x1;
};

/* The part of the planes where heat flows; diffusion_solver.c defines across and own. */
struct rf_heat {
    const struct rf_frame *f;
    struct rf_box box;
    const struct rf_span *span; /* one for each row of the picture */
    const float *across, *own;
    rf_series_row_fn *series_row;
};
#define RF_ACROSS_LEAST 5e-10f

/* Applies the series to a plane; even and odd are scratch, 0 at first. */
void rf_diffuse_series(const struct rf_heat *heat, const struct rf_series *series, float *plane,
                       float *even, float *odd);

/* The pixels of a layer's edge within a tile, for extrapolating. */
struct rf_edge_tile {
    int first, count;
    float x, y, radius; /* means over the edge pixels of the tile */
    int next;           /* the next tile with edge pixels, or -1 */
};
enum { RF_EDGE_TILE = 16 };

/* A layer: the pixels of one range of disparities, and the region around them. */
struct rf_diffusion_layer {
    const struct rf_frame *f;
    const uint8_t *member; /* layer number of each pixel, width a row */
    int number;
    const float *radius;  /* blur radius of each pixel */
    float *outside;       /* radius extrapolated to where the layer has no pixel */
    uint16_t *rings;      /* distance to the nearest member, 0 = one itself; width a row */
    int reach;            /* rings that belong to the region */
    float most;           /* largest radius of a member */
    struct rf_span *span; /* one a row: the region and a pixel about it */
    struct rf_box box;
    ptrdiff_t stride; /* elements between rows of radius */
    float *edge_x, *edge_y, *edge_radius;
    struct rf_edge_tile *tile; /* tiles_x a row */
    int tiles_x, tiles_y;
    int first_tile; /* the first with edge pixels, or -1 */
};

/* Grows the region, 7.1: sets rings, reach, box and spans. Returns false if no pixel is a member.
 */
bool rf_layer_grow(struct rf_diffusion_layer *layer);

/* Extrapolate blur radii outside the object, 7.2: first the edge is listed, then each tile of the
 * region is done. */
void rf_layer_list_edge(struct rf_diffusion_layer *layer);
void rf_layer_extrapolate_tile(const struct rf_diffusion_layer *layer, int tile);

#endif
