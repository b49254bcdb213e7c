/* temporal.h: frames and motion that the files of the temporal filter share. */
#ifndef RF_TEMPORAL_H
#define RF_TEMPORAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <refocus/temporal.h>

#include "support/pool.h"

enum { RF_BLOCK = 8, RF_MOST_MOTION = 16 /* samples a frame */ };

struct rf_motion {
    int8_t x, y; /* from here to where it was */
};

/* A frame: disparities, 8 bits of what the photo shows there, and where each sample was in the
 * frame before, x RF_NOWHERE for what was not to be seen in it. */
struct rf_frame {
    uint16_t *disparity;
    uint8_t *guide;
    struct rf_motion *from;
};

/*
 * Where each block of `now` was in `last`: the best of the vectors of its neighbours, of its own
 * in the last frame and of none, and what is better step by step from there.
 * motion: a vector a block, those of the last frame before
 * run: asked before each row of blocks whether to go on
 */
void rf_find_motion(struct rf_motion *motion, const struct rf_frame *now,
                    const struct rf_frame *last, int width, int height, struct rf_run *run);

/* Fills in the disparities and the guide of a frame, that of the photo, or of the map where that is
 * NULL; asks the run before each row whether to go on. */
void rf_load_frame(const struct rf_frame *frame, int width, int height,
                   const struct refocus_image *photo, const struct refocus_disparity *map,
                   struct rf_run *run);

/*
 * Whether two guides show different scenes. Of means over 16 x 16 cells the steps from each to its
 * neighbours are compared: where the frames share less than a quarter of the larger contrast, in
 * sums of products and of squares, it is a cut. A brighter exposure changes all steps alike: up to
 * four times the contrast is none. Frames of no contrast tell nothing.
 */
bool rf_is_cut(const uint8_t *now, const uint8_t *last, int width, int height);

/* refocus_temporal_run() asks this whether to go on; for tests. */
struct rf_run *rf_run_of_temporal(struct refocus_temporal *f);

enum {
    RF_HISTORY = 7, /* frames that vote */
    RF_ALIKE = 12,  /* codes of the guide, from which on two frames show different things */
    RF_NOWHERE = INT8_MIN,
};

/* A sample as the last frames saw it, the newest first, and how alike the photo was: 1 to
 * RF_ALIKE. */
struct rf_history {
    int count;
    uint16_t disparity[RF_HISTORY];
    uint8_t weight[RF_HISTORY];
};

/* Take sample i of frame[0] and what it was in up to `frames` of them; those that are not alike are
 * left out. */
void rf_history_take(struct rf_history *history, const struct rf_frame frame[], int frames,
                     int width, size_t i);

/*
 * Disparities that differ by less than noise are one surface, for which frames vote by their
 * weights. Where one leads the surface of `last` by half of all votes, *disparity receives its
 * mean; returns the number of frames that voted for it, or 0 while `last` stays: of seven
 * alike frames two hold it, and one does not.
 */
int rf_history_vote(const struct rf_history *history, int last, int noise, uint16_t *disparity);

#endif
