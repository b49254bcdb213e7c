/* ray_set.h: the rays through the aperture that a tile takes, and denser and thinner sets of them.
 */
#ifndef RF_RAY_SET_H
#define RF_RAY_SET_H

#include <stdbool.h>
#include <stdint.h>

#include <refocus/aperture.h>

#include "support/pool.h"

enum {
    RF_RAY_CLASSES = 12, /* a preset's own set and smaller ones; denser ones for lamps */
    RF_FULL_RAYS = 255 * 255,
};

/* Rays and runs of equal weight among them. */
struct rf_ray_set {
    struct refocus_ray *ray;
    struct refocus_ray *before; /* those before the focus: the same, or as many others */
    const int16_t *u, *v;       /* of those behind, by themselves; NULL of a full mask */
    int count;
    int shared; /* by chroma; see rf_shared_rays() */
    uint64_t total_weight;
    bool equal; /* all rays weigh the same */
};

/* Chroma of a photo of Y, U and V takes some rays of luma; those among rays first to end - 1, which
 * are of one chunk, are the first so many of them. */
static inline int rf_shared_rays(const struct rf_ray_set *set, int first, int end)
{
    const int64_t shared = set->shared;

    return (int)(shared * end / set->count - shared * first / set->count);
}

/* The sets of the aperture in use, from few rays to many. */
struct rf_ray_sets {
    struct refocus_ray *memory; /* of all sets */
    struct rf_ray_set set[RF_RAY_CLASSES];
    int sets;   /* how many are filled; 0: none yet */
    int preset; /* the one that has as many rays as were asked for */

    /* What they were made for. */
    uint64_t aperture;
    int rays;
    bool denser;
    bool shared; /* chroma's rays come first */
    float blur;
};

/* Which sets are needed. */
struct rf_ray_request {
    const struct refocus_aperture *aperture;
    int rays;              /* or REFOCUS_RAYS_FULL */
    bool denser;           /* with denser sets, for tiles that a highlight reaches */
    bool chroma;           /* for a photo of Y, U and V: rays that chroma shares come first */
    float max_blur_radius; /* K in pixels; of REFOCUS_RAYS_FULL */
};

/* Fills the sets, unless they are there already. Cancelled, there are none. */
void rf_ray_sets_make(struct rf_ray_sets *sets, const struct rf_ray_request *request,
                      struct rf_run *run);

/* The set for a reach (Q7.8): enough rays for it, at most the preset's, or a denser one where a
 * highlight is in reach. */
const struct rf_ray_set *rf_rays_for(const struct rf_ray_sets *sets, int reach, bool lamp);

/* How many rays from `first` on weigh the same, RF_RAY_CHUNK at the most. */
int rf_rays_alike(const struct rf_ray_set *set, int first);

#endif
