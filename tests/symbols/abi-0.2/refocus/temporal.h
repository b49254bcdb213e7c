/* temporal.h: that of librefocus 0.2, without its comments; made by tests/symbols/abi.py. */
#ifndef REFOCUS_TEMPORAL_H
#define REFOCUS_TEMPORAL_H
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <refocus/image.h>
#include <refocus/status.h>
#ifdef __cplusplus
extern "C" {
#endif
struct refocus_temporal;
struct refocus_temporal_params {
    uint32_t struct_size;
    int32_t width;
    int32_t height;
    uint32_t reserved;
    float strength;
    float noise;
};
static inline struct refocus_temporal_params refocus_temporal_params_default(int32_t width,
                                                                             int32_t height)
{
    struct refocus_temporal_params params;
    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    params.width = width;
    params.height = height;
    params.strength = (float)0.85;
    params.noise = (float)0.03;
    return params;
}
REFOCUS_API int refocus_temporal_create(struct refocus_temporal **filter,
                                        const struct refocus_temporal_params *params);
REFOCUS_API void refocus_temporal_destroy(struct refocus_temporal **filter);
REFOCUS_API void refocus_temporal_reset(struct refocus_temporal *filter);
REFOCUS_API int refocus_temporal_rescale(struct refocus_temporal *filter, double scale,
                                         double offset);
REFOCUS_API int refocus_temporal_run(struct refocus_temporal *filter,
                                     const struct refocus_image *photo,
                                     const struct refocus_disparity *map, uint16_t *out,
                                     ptrdiff_t stride);
#ifdef __cplusplus
}
#endif
#endif
