/* methods.h: that of librefocus 0.2, without its comments; made by tests/symbols/abi.py. */
#ifndef REFOCUS_METHODS_H
#define REFOCUS_METHODS_H
#include <stdint.h>
#include <string.h>
#include <refocus/sized.h>
#include <refocus/status.h>
#ifdef __cplusplus
extern "C" {
#endif
enum refocus_method {
    REFOCUS_METHOD_SWEEP = 0,
    REFOCUS_METHOD_SEARCH = 1,
    REFOCUS_METHOD_RAYTRACE = 2,
    REFOCUS_METHOD_JITTERED = 3,
    REFOCUS_METHOD_LIGHTFIELD = 4,
    REFOCUS_METHOD_BLUR = 5,
    REFOCUS_METHOD_SCATTER = 6,
    REFOCUS_METHOD_FOVEATED = 7,
    REFOCUS_METHOD_INTERPOLATED = 8,
    REFOCUS_METHOD_DIFFUSION = 9,
};
enum { REFOCUS_METHOD_COUNT = 10 };
#define REFOCUS_METHOD_BIT(method) (UINT32_C(1) << (method))
#define REFOCUS_METHODS_ALL        (REFOCUS_METHOD_BIT(REFOCUS_METHOD_COUNT) - 1)
REFOCUS_API const char *refocus_method_name(uint32_t method);
REFOCUS_API const char *refocus_method_summary(uint32_t method);
struct refocus_search_params {
    uint32_t struct_size;
    int32_t iterations;
    uint32_t mirror;
    uint32_t background;
};
static inline struct refocus_search_params refocus_search_params_default(void)
{
    struct refocus_search_params params;
    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    params.iterations = 2;
    return params;
}
struct refocus_jittered_params {
    uint32_t struct_size;
    int32_t cell;
    uint32_t seed;
};
static inline struct refocus_jittered_params refocus_jittered_params_default(void)
{
    struct refocus_jittered_params params;
    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    params.cell = 2;
    return params;
}
enum refocus_spread {
    REFOCUS_SPREAD_UNIFORM = 0,
    REFOCUS_SPREAD_LOMMEL = 1,
};
struct refocus_scatter_params {
    uint32_t struct_size;
    uint32_t spread;
    float airy_radius;
    float depth_ratio;
};
static inline struct refocus_scatter_params refocus_scatter_params_default(void)
{
    struct refocus_scatter_params params;
    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    params.airy_radius = params.depth_ratio = 1;
    return params;
}
struct refocus_interpolated_params {
    uint32_t struct_size;
    float sharp_radius;
    float middle_ratio;
    float last_ratio;
};
static inline struct refocus_interpolated_params refocus_interpolated_params_default(void)
{
    struct refocus_interpolated_params params;
    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    params.sharp_radius = (float)0.5;
    return params;
}
struct refocus_foveated_params {
    uint32_t struct_size;
    float x, y;
    float angle;
    float picture_angle;
    float depth;
};
static inline struct refocus_foveated_params refocus_foveated_params_default(void)
{
    struct refocus_foveated_params params;
    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    params.x = params.y = (float)0.5;
    params.angle = 10;
    params.picture_angle = 50;
    params.depth = 1;
    return params;
}
enum refocus_solver {
    REFOCUS_SOLVER_FAST = 0,
    REFOCUS_SOLVER_ITERATED = 1,
};
struct refocus_diffusion_params {
    uint32_t struct_size;
    int32_t layers;
    uint32_t solver;
    float conductivity;
};
static inline struct refocus_diffusion_params refocus_diffusion_params_default(void)
{
    struct refocus_diffusion_params params;
    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    params.layers = 4;
    params.conductivity = (float)0.125;
    return params;
}
#ifdef __cplusplus
}
#endif
#endif
