/* depth.h: that of librefocus 0.2, without its comments; made by tests/symbols/abi.py. */
#ifndef REFOCUS_DEPTH_H
#define REFOCUS_DEPTH_H
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <refocus/image.h>
#include <refocus/sized.h>
#include <refocus/status.h>
#ifdef __cplusplus
extern "C" {
#endif
enum refocus_sample {
    REFOCUS_SAMPLE_U8 = 1,
    REFOCUS_SAMPLE_U16 = 2,
    REFOCUS_SAMPLE_F32 = 3,
};
enum refocus_depth_meaning {
    REFOCUS_DEPTH_DISPARITY = 1,
    REFOCUS_DEPTH_DISTANCE = 2,
};
enum refocus_depth_flags {
    REFOCUS_DEPTH_ZERO_IS_UNKNOWN = 1,
    REFOCUS_DEPTH_MAX_IS_UNKNOWN = 2,
    REFOCUS_DEPTH_2047_IS_UNKNOWN = 4,
};
struct refocus_depth_map {
    uint32_t struct_size;
    uint32_t sample;
    const void *samples;
    ptrdiff_t stride;
    int32_t width;
    int32_t height;
    uint32_t meaning;
    uint32_t flags;
    double value_near, value_far;
    double metres_per_unit, metres_at_zero;
    double near_m, far_m;
};
static inline struct refocus_depth_map refocus_depth_map_default(void)
{
    struct refocus_depth_map map;
    memset(&map, 0, sizeof map);
    map.struct_size = sizeof map;
    map.sample = REFOCUS_SAMPLE_U8;
    map.meaning = REFOCUS_DEPTH_DISPARITY;
    return map;
}
struct refocus_depth_report {
    uint32_t struct_size;
    uint32_t reserved;
    double near_m;
    double far_m;
    double value_near;
    double value_far;
    uint64_t unknown;
    uint64_t clamped;
    uint64_t specks;
};
static inline struct refocus_depth_report refocus_depth_report_default(void)
{
    struct refocus_depth_report report;
    memset(&report, 0, sizeof report);
    report.struct_size = sizeof report;
    return report;
}
REFOCUS_API int refocus_depth_to_disparity(const struct refocus_depth_map *map, uint16_t *disparity,
                                           ptrdiff_t stride, struct refocus_depth_report *report);
enum { REFOCUS_MAX_SPECKLE = 255 };
struct refocus_repair_params {
    uint32_t struct_size;
    int32_t speckle;
    uint8_t *confidence;
    ptrdiff_t confidence_stride;
};
static inline struct refocus_repair_params refocus_repair_params_default(void)
{
    struct refocus_repair_params params;
    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    return params;
}
REFOCUS_API int refocus_depth_repair(const struct refocus_depth_map *map,
                                     const struct refocus_repair_params *params,
                                     uint16_t *disparity, ptrdiff_t stride,
                                     struct refocus_depth_report *report);
struct refocus_upsample_params {
    uint32_t struct_size;
    int32_t threads;
    uint32_t cpu;
    uint32_t reserved;
    const uint8_t *confidence;
    ptrdiff_t confidence_stride;
};
static inline struct refocus_upsample_params refocus_upsample_params_default(void)
{
    struct refocus_upsample_params params;
    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    return params;
}
REFOCUS_API int refocus_upsample(const struct refocus_image *photo,
                                 const struct refocus_disparity *map,
                                 const struct refocus_upsample_params *params, uint16_t *out,
                                 ptrdiff_t stride);
#ifdef __cplusplus
}
#endif
#endif
