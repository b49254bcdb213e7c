/* aperture.h: that of librefocus 0.2, without its comments; made by tests/symbols/abi.py. */
#ifndef REFOCUS_APERTURE_H
#define REFOCUS_APERTURE_H
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <refocus/sized.h>
#include <refocus/status.h>
#ifdef __cplusplus
extern "C" {
#endif
enum { REFOCUS_MAX_APERTURE_SIDE = 255, REFOCUS_MAX_RAYS = 1024 };
struct refocus_aperture;
REFOCUS_API int refocus_aperture_create_disc(struct refocus_aperture **aperture);
REFOCUS_API int refocus_aperture_create_polygon(struct refocus_aperture **aperture, int blades,
                                                double rotation_deg);
REFOCUS_API int refocus_aperture_create_mask(struct refocus_aperture **aperture,
                                             const uint8_t *mask, int width, int height,
                                             ptrdiff_t stride);
enum refocus_figure {
    REFOCUS_FIGURE_NONE = 0,
    REFOCUS_FIGURE_HEART = 1,
    REFOCUS_FIGURE_STAR = 2,
};
enum { REFOCUS_FIGURE_COUNT = 3 };
struct refocus_aperture_params {
    uint32_t struct_size;
    int32_t blades;
    double rotation_deg;
    double curvature;
    double opening;
    double squeeze;
    double hole;
    double edge_behind;
    double edge_before;
    uint32_t figure;
    int32_t mask_width, mask_height;
    uint32_t reserved;
    const uint8_t *mask;
    ptrdiff_t mask_stride;
};
static inline struct refocus_aperture_params refocus_aperture_params_default(void)
{
    struct refocus_aperture_params params;
    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    params.squeeze = 1;
    return params;
}
REFOCUS_API int refocus_aperture_create(struct refocus_aperture **aperture,
                                        const struct refocus_aperture_params *params);
REFOCUS_API void refocus_aperture_destroy(struct refocus_aperture **aperture);
struct refocus_ray {
    int16_t u, v;
    uint16_t weight;
};
REFOCUS_API int refocus_aperture_rays(const struct refocus_aperture *aperture, int count,
                                      struct refocus_ray *rays);
REFOCUS_API int refocus_aperture_full_rays(const struct refocus_aperture *aperture,
                                           double max_blur_radius, int capacity,
                                           struct refocus_ray *rays);
#ifdef __cplusplus
}
#endif
#endif
