/* bench_rays.h: statistics of the surfaces that rays hit, as in Yang et al. 2016, figures 2 and
 * 3. */
#ifndef RF_CLI_BENCH_RAYS_H
#define RF_CLI_BENCH_RAYS_H

#include <refocus/refocus.h>
#include "line/report.h"

enum { RAYS_TESTS = 8 };

struct ray_statistics {
    double K, focus;
    long pixels, rays;       /* looked at: every ray of the mask, of a grid of pixels */
    long hidden;             /* rays that hit nothing in the picture */
    long found[RAYS_TESTS];  /* first found after i + 1 tests */
    long never;              /* not within RAYS_TESTS */
    long first[RAYS_TESTS];  /* with i + 1 tests the result is the front-most hit, or beside it */
    long in_set[RAYS_TESTS]; /* or it is that of another ray of p, or beside it, once farther
                                invalid ones are replaced */
};

/* disparity: packed. Returns 0, or -1 without memory. */
int ray_statistics(struct ray_statistics *statistics, const uint16_t *disparity, int width,
                   int height, double focus, double blur, const struct refocus_aperture *aperture);

json_t *ray_statistics_json(const struct ray_statistics *statistics);
void ray_statistics_print(const struct ray_statistics *statistics);

#endif
