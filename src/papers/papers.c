/* papers.c: the table of this library's methods, for the core that renders with them. */
#include "papers/papers.h"

#include <refocus/papers.h>

static const struct refocus_papers papers = {
    .version = REFOCUS_VERSION_STRING,
    .frame_size = sizeof(struct rf_frame),
    .method = {
        [REFOCUS_METHOD_RAYTRACE] = {.tile = rf_raytrace_tile, .exact = rf_exact_init},
        [REFOCUS_METHOD_JITTERED] = {.tile = rf_jittered_tile, .exact = rf_exact_init},
        [REFOCUS_METHOD_LIGHTFIELD] = {.frame = rf_lightfield_frame,
                                       .work_bytes = rf_lightfield_work},
        [REFOCUS_METHOD_BLUR] = {.tile = rf_blur_tile},
        [REFOCUS_METHOD_SCATTER] = {.frame = rf_scatter_frame, .work_bytes = rf_scatter_work},
        [REFOCUS_METHOD_FOVEATED] = {.frame = rf_foveated_frame, .work_bytes = rf_foveated_work},
        [REFOCUS_METHOD_INTERPOLATED] = {.frame = rf_interpolated_frame,
                                         .work_bytes = rf_interpolated_work},
        [REFOCUS_METHOD_DIFFUSION] = {.frame = rf_diffusion_frame, .work_bytes = rf_diffusion_work},
    }};

const struct refocus_papers *refocus_papers(void)
{
    return &papers;
}
