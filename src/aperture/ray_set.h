/* ray_set.h: sets of few and of many rays through the aperture; each tile uses the one it needs. */
#ifndef RF_RAY_SET_H
#define RF_RAY_SET_H

#include <stdbool.h>
#include <stdint.h>

#include <refocus/aperture.h>

#include "support/pool.h"

enum {
    RF_RAY_CLASSES = 10, /* a preset's own set, smaller ones, and denser ones for highlights */
    RF_FULL_RAYS = 255 * 255,
};

/* Rays, in runs of equal weight. */
struct rf_ray_set {
    struct refocus_ray *ray;
    struct refocus_ray *before; /* for blurs before the focus: `ray`, or as many others */
    const int16_t *u, *v;       /* coordinates of `ray`, apart; NULL for a full mask */
    int count;
    int shared; /* rays that chroma shares: rf_shared_rays() */
    uint64_t total_weight;
    bool equal; /* all rays weigh the same */
};

/* The number of rays that chroma of a photo of Y, U and V shares with luma, of rays first to end -
 * 1, which are of one chunk. The first ones of these are shared. */
static inline int rf_shared_rays(const struct rf_ray_set *set, int first, int end)
{
    const int64_t shared = set->shared;

    return (int)(shared * end / set->count - shared * first / set->count);
}

/* The sets of the aperture in use, from few rays to many. */
struct rf_ray_sets {
    struct refocus_ray *memory; /* holds all sets */
    struct rf_ray_set set[RF_RAY_CLASSES];
    int sets;   /* how many are filled; 0: none yet */
    int preset; /* the one that has as many rays as were asked for */

    /* The request that the sets are for: */
    uint64_t aperture;
    int rays;
    bool denser;
    bool shared; /* chroma's rays come first */
    float blur;
};

/* The sets that a frame needs. */
struct rf_ray_request {
    const struct refocus_aperture *aperture;
    int rays;              /* N, or REFOCUS_RAYS_FULL */
    bool denser;           /* with denser sets, for tiles that a highlight reaches */
    bool chroma;           /* for a photo of Y, U and V: rays that chroma shares come first */
    float max_blur_radius; /* K in pixels; counts for REFOCUS_RAYS_FULL */
};

/* Fills the sets, unless they are there already. After a cancelled run there are none. */
void rf_ray_sets_make(struct rf_ray_sets *sets, const struct rf_ray_request *request,
                      struct rf_run *run);

/* How far apart that many rays, or those of every pixel, lie at a blur of 1. */
double rf_ray_gap(int rays);

/* The set for a tile that blurs of up to `reach` (Q7.8) reach: it has enough rays for these, at
 * most as many as the preset, or more where a highlight in reach is undersampled. */
const struct rf_ray_set *rf_choose_ray_set(const struct rf_ray_sets *sets, int reach,
                                           bool undersampled);

/* The number of rays from `first` on that weigh the same, RF_RAY_CHUNK at the most. */
int rf_rays_of_equal_weight(const struct rf_ray_set *set, int first);

#endif
