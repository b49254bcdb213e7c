/* raytrace.c: full image-space ray tracing, Yang et al. 2016, in double precision.
 *
 * The oracle of the other methods: nothing is guessed, rounded or shared. Every ray of the
 * aperture is followed from the nearest plane to the farthest (trace.c); what the rays see is
 * averaged by eq. 5 over the exact curve of the blend.
 */
#include "papers/papers.h"
#include "papers/trace.h"
#include "image/viewport.h"

#include <math.h>
#include <string.h>

static void raytrace_tile(const struct rf_frame *f, int tx, int ty, struct rf_rect rect, int worker)
{
    const struct rf_ray_set *set = &f->ray_sets->set[f->ray_sets->preset];
    const struct rf_blur_range reach = rf_blur_range_of(f, tx, ty);
    const double K = f->params->max_blur_radius;
    struct rf_exact_sums sums;
    struct rf_path path;

    (void)worker;
    memset(&sums, 0, sizeof sums);
    for (int n = 0; n < set->count; n++) {
        double u = set->ray[n].u / 32768.0, v = set->ray[n].v / 32768.0;

        if (rf_cancelled(f->exec))
            return;
        if (f->params->rays == REFOCUS_RAYS_FULL && K > 0) { /* Q15 back to mask pixels */
            u = fmax(-1, fmin(1, floor(u * K + 0.5) / K));
            v = fmax(-1, fmin(1, floor(v * K + 0.5) / K));
        }
        rf_path_of(f, reach, u, v, &path);
        for (int y = rect.y0; y < rect.y1; y++)
            for (int x = rect.x0; x < rect.x1; x++)
                rf_path_add(f, &path, x, y, set->ray[n].weight, &sums);
    }
    rf_exact_write(f, rect, &sums);
}

const struct rf_method rf_raytrace_method = {.tile = raytrace_tile, .exact = rf_exact_init};
