/* input.h: takes in the photo and the map whose edges go where the photo has them. */
#ifndef RF_EDGES_INPUT_H
#define RF_EDGES_INPUT_H

#include <refocus/image.h>

#include "edges/edges.h"
#include "image/planes.h"

/* A place between two samples of a row, in Q8 from the first one. */
struct rf_sample_place {
    int32_t first, next, share;
};

/* A photo, a map, and the planes at the size that the work is done at. */
struct rf_edge_job {
    const struct refocus_image *photo; /* packed */
    const struct refocus_disparity *map;
    struct rf_edges edges;
    int reduced;                    /* the photo by so much */
    int columns, rows;              /* samples of the map that are used */
    struct rf_sample_place *column; /* where each pixel of a row lies among samples */
    bool enlarged;                  /* the map is not of the photo's size */
    bool points;                    /* samples were taken at points */
    int impulses;                   /* samples that were far off those around them, 1/65536 */
    int noise;                      /* standard deviation of what was smoothed away, Q16 */
    struct rf_disparity_q16 sample; /* in the memory of near, until ramps are found */
};

/* Writes the colours of the photo. */
void rf_load_edge_photo(struct rf_edge_job *job);

/* Writes the map at the size that work is done at: slopes in place of the steps of few codes, and
 * without noise. */
void rf_load_edge_map(struct rf_edge_job *job);

/* The softness of the samples as they are, in pixels of their own. */
double rf_softness_of_samples(struct rf_edge_job *job);

/* The share of pixels that differ from what straight lines between the samples make. */
float rf_share_changed(struct rf_edge_job *job);

#endif
