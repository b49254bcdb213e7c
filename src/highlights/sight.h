/* sight.h: what of a lamp the pixels of a tile see past nearer things (draw.h). */
#ifndef RF_SIGHT_H
#define RF_SIGHT_H

#include <stdbool.h>
#include <stdint.h>

#include "gather/frame.h"
#include "kernels/slab.h"

enum {
    RF_LAMP_UNIT = 64, /* of lengths, in a pixel */
    RF_SHADES = 16,
};

/* A run of a lamp's pixels, or some rows of them as one, as a tile sees it: places from
 * the middle of the tile's first pixel on. */
struct rf_seen {
    int from, to;     /* RF_LAMP_UNIT */
    int middle, rows; /* half pixels; so many */
    int turn;         /* which of such runs, in the photo */
    int set;          /* which of the chords of a row of the opening */
    int blur;         /* Q7.8, signed */
    int radius;
    double light[3]; /* of all its pixels, Q12 times 256 */
};

/* What one slab hides of a run. Runs of about one place are hidden alike: all rows of a
 * lamp are behind something in focus, the slab just before them hides each otherwise.
 * So what was found for one serves for those whose looks at the slab are no farther
 * than a quarter of a pixel from its own; with half a pixel, lamps behind hair flicker
 * as the focus moves. */
struct rf_lamp_shade {
    struct rf_lamp_look {
        struct rf_seen run;
        int first, end; /* rows of the tile that its discs reach */
        int slab;
    } look;
    enum rf_hidden { RF_HIDDEN_NOWHERE, RF_HIDDEN_PARTLY, RF_HIDDEN_WHOLLY } hidden;
    uint16_t visible[2 * RF_TILE * RF_TILE]; /* where hidden partly */
};

/* Of a tile, the last ones that may serve again. */
struct rf_lamp_sights {
    const struct rf_frame *f;
    int tx, ty, slabs;
    struct rf_slab slab[RF_MAX_SLABS]; /* those of the tile, near ones as one */
    int count;                         /* shades that were kept so far */
    struct rf_lamp_shade shade[RF_SHADES], other;
    uint16_t visible[2 * RF_TILE * RF_TILE]; /* past more than one slab */
};

void rf_start_sights(struct rf_lamp_sights *sights, const struct rf_frame *f,
                     const struct rf_tile_plan *plan, int tx, int ty);

/* How much of a run is hidden, at a glance: in part it may not be at all. Of a job
 * whose shape is set. `clear`: slabs that hide nothing of it, a bit each of the first. */
enum rf_hidden rf_lamp_hidden(const struct rf_lamp_sights *sights, const struct rf_disc_job *job,
                              const struct rf_seen *run, uint64_t *clear);

/* Sets job->visible, in `sights`, for a run of one row or two; false: it is
 * hidden. `clear`: those of a run that it is part of. */
bool rf_sees_lamp(struct rf_lamp_sights *sights, struct rf_disc_job *job, const struct rf_seen *run,
                  uint64_t clear);

#endif
