/* memory_plan.h: which planes share memory, and which of them is alive.
 *
 * Planes that are never needed at once lie in the same memory, a slot. The table in memory_plan.c
 * says which; window.c makes the views. A plane lives from rf_plane_begin(), which whoever writes
 * it first calls, until another plane of its slot begins. In debug builds rf_plane_read() stops the
 * program where a plane is read that does not live, and views of planes that do not live are empty.
 *
 *     slot             planes, in the order of their lives
 *     blur             circle of confusion
 *     smooth           dequantising (spare) | pre-filtered light
 *     background blur  cells | blur of the hidden background | its weights
 *     background light spare of the pre-filter | cone | light of the hidden background
 *     pyramid          coverage sources | pyramid | foreground cells | weights, of what the sweep
 *                      sees or of the photo's own light
 *
 * All of it is also what a scene is prepared in: upsampling, edges and the matte work there before
 * any plane lives (struct refocus_renderer, prepare_memory).
 *
 * Of a photo of Y, U and V the weights lie in the third plane of the hidden background's light,
 * which no other plane of such a photo uses: there they share nothing.
 */
#ifndef RF_MEMORY_PLAN_H
#define RF_MEMORY_PLAN_H

#include <assert.h>
#include <stdbool.h>
#include <stdint.h>

enum rf_plane {
    RF_PLANE_NONE,
    RF_PLANE_BLUR,
    RF_PLANE_PREPARE_SPARE, /* scratch of dequantising */
    RF_PLANE_SMOOTH,
    RF_PLANE_CELLS,
    RF_PLANE_BACKGROUND_BLUR,
    RF_PLANE_BACKGROUND_WEIGHT,
    RF_PLANE_PREFILTER_SPARE,
    RF_PLANE_CONE,
    RF_PLANE_BACKGROUND_LIGHT,
    RF_PLANE_COVERAGE_SOURCES,
    RF_PLANE_PYRAMID,
    RF_PLANE_FOREGROUND,
    RF_PLANE_WEIGHT,
    RF_PLANE_OWN_WEIGHT,
    RF_PLANES
};

enum rf_slot {
    RF_SLOT_NONE,
    RF_SLOT_BLUR,
    RF_SLOT_SMOOTH,
    RF_SLOT_BACKGROUND_BLUR,
    RF_SLOT_BACKGROUND_LIGHT,
    RF_SLOT_PYRAMID,
    RF_SLOTS
};

/* The plane that lives in each slot. All 0: none does. */
struct rf_lifetimes {
    uint8_t lives[RF_SLOTS]; /* enum rf_plane */
};

/* Declares that a plane is about to be written: the plane that lay in its slot is gone. */
void rf_plane_begin(struct rf_lifetimes *lifetimes, enum rf_plane plane);

/* Declares that the memory of all slots is about to be written: no plane lives. */
void rf_planes_end(struct rf_lifetimes *lifetimes);

/* Whether a plane was begun and no other one of its slot since. */
bool rf_plane_lives(const struct rf_lifetimes *lifetimes, enum rf_plane plane);

/* Declares that a plane is about to be read. */
static inline void rf_plane_read(const struct rf_lifetimes *lifetimes, enum rf_plane plane)
{
    assert(rf_plane_lives(lifetimes, plane));
    (void)lifetimes;
    (void)plane;
}

#endif
