/* sight.h: what of a lamp the pixels of a tile see past nearer things (draw.h). */
#ifndef RF_SIGHT_H
#define RF_SIGHT_H

#include <stdbool.h>
#include <stdint.h>

#include "methods/method.h"
#include "tiles/slab.h"

enum {
    RF_LAMP_UNIT = 64, /* of lengths, in a pixel */
    RF_SIGHTS = 8,
};

/* A run of a lamp's pixels, as a tile sees it. */
struct rf_seen {
    int x, y, count; /* its first pixel, from the tile's first one on */
    int blur;        /* Q7.8, signed */
    int radius;
    int shining; /* of 256 count */
    const uint16_t *added;
};

/* Runs of about one place are hidden alike: the rows of a lamp behind something in focus
 * all are. So what was found for one serves for those whose looks are no farther than a
 * quarter of a pixel from its own; with half a pixel, lamps behind hair flicker as the
 * focus moves. */
struct rf_lamp_sight {
    struct rf_lamp_look {
        struct rf_seen run;
        int first, end; /* rows of the tile that its discs reach */
        int slabs;      /* so many are nearer, */
        float part;     /* at most so much of the way to it */
    } look;
    bool hidden; /* wholly, */
    bool masked; /* or in part */
    uint16_t visible[2 * RF_TILE * RF_TILE];
};

/* Of a tile, those of the last runs. */
struct rf_lamp_sights {
    const struct rf_frame *f;
    const struct rf_tile_plan *plan;
    int tx, ty, count;
    struct rf_lamp_sight sight[RF_SIGHTS];
};

void rf_start_sights(struct rf_lamp_sights *sights, const struct rf_frame *f,
                     const struct rf_tile_plan *plan, int tx, int ty);

/* Sets job->visible, in `sights`, for a job whose shape is set; false: the run is hidden. */
bool rf_sees_lamp(struct rf_lamp_sights *sights, struct rf_disc_job *job,
                  const struct rf_seen *run);

#endif
