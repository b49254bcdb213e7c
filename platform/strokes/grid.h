/* grid.h: one level of a selection: which pixels of an area are the object's. */
#ifndef RF_STROKES_GRID_H
#define RF_STROKES_GRID_H

#include <stdbool.h>
#include <stdint.h>
#include "pyramid.h"
#include "selector.h"
#include "stroke.h"

/* The state of each pixel. Strokes set the first two; a pixel that is not open keeps its label. */
enum {
    RF_INSIDE = 1, /* it is the object's */
    RF_SEED = 2,   /* the label is certain */
    RF_OPEN = 4,   /* the label is to be found */
};

struct rf_grid {
    int level;
    struct rf_area area; /* in pixels of the level */
    uint8_t *state;
    /* Scores for the place of a pixel, in an area of a coarser level that holds this one. */
    const int16_t *place;
    struct rf_area place_area;
    int place_shift;
};

/* Find the least cut among the open pixels, or settle for a good one near their labels;
 * they are not open afterwards. */
int rf_grid_cut(struct rf_grid *grid, struct rf_selector *selector,
                const struct rf_pyramid *pyramid, bool settle);

/* The next finer level: labels from the coarser one, open where its edge is. */
void rf_grid_refine(struct rf_grid *fine, struct rf_grid *coarse, const struct rf_pyramid *pyramid);
/* The area that rf_grid_refine() will make. */
struct rf_area rf_grid_finer_area(const struct rf_grid *coarse, const struct rf_pyramid *pyramid);

/* Drop pixels that are not connected to a certain one; stack: a number for each pixel. */
void rf_grid_connect(struct rf_grid *grid, int32_t *stack);

/* Cut the area to the pixels inside, and a margin. */
void rf_grid_shrink(struct rf_grid *grid, int32_t margin);

#endif
