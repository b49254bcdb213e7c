/* render.h: that of librefocus 0.2, without its comments; made by tests/symbols/abi.py. */
#ifndef REFOCUS_RENDER_H
#define REFOCUS_RENDER_H
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <refocus/focus.h>
#include <refocus/image.h>
#include <refocus/methods.h>
#include <refocus/papers.h>
#include <refocus/params.h>
#include <refocus/sized.h>
#include <refocus/status.h>
#ifdef __cplusplus
extern "C" {
#endif
struct refocus_renderer;
struct refocus_allocator {
    void *(*allocate)(void *user, size_t size);
    void (*release)(void *user, void *memory);
    void *user;
};
struct refocus_log {
    void (*message)(void *user, const char *text);
    void *user;
};
struct refocus_parallel {
    void (*parallel_for)(void *user, void (*work)(void *context, int32_t item), void *context,
                         int32_t count);
    void *user;
};
enum refocus_cpu {
    REFOCUS_CPU_AUTO = 0,
    REFOCUS_CPU_C = 1,
    REFOCUS_CPU_NEON = 2,
    REFOCUS_CPU_SSE41 = 3,
    REFOCUS_CPU_AVX2 = 4,
    REFOCUS_CPU_AVX512 = 5,
};
struct refocus_renderer_params {
    uint32_t struct_size;
    int32_t max_width;
    int32_t max_height;
    float max_blur_radius;
    int32_t threads;
    uint32_t cpu;
    uint64_t max_memory;
    struct refocus_allocator allocator;
    struct refocus_log log;
    uint32_t methods;
    uint32_t reserved;
    struct refocus_parallel parallel;
    const struct refocus_papers *papers;
    uint32_t in_place;
    uint32_t thin;
};
static inline struct refocus_renderer_params
refocus_renderer_params_default(int32_t max_width, int32_t max_height, float max_blur_radius)
{
    struct refocus_renderer_params params;
    memset(&params, 0, sizeof params);
    params.struct_size = sizeof params;
    params.max_width = max_width;
    params.max_height = max_height;
    params.max_blur_radius = max_blur_radius;
    return params;
}
REFOCUS_API uint64_t refocus_renderer_memory(const struct refocus_renderer_params *params);
REFOCUS_API int refocus_renderer_create(struct refocus_renderer **renderer,
                                        const struct refocus_renderer_params *params);
REFOCUS_API void refocus_renderer_destroy(struct refocus_renderer **renderer);
REFOCUS_API int refocus_prepare(struct refocus_renderer *renderer,
                                const struct refocus_image *photo,
                                const struct refocus_disparity *disparity);
REFOCUS_API int refocus_render(struct refocus_renderer *renderer,
                               const struct refocus_render_params *params,
                               const struct refocus_image *out);
REFOCUS_API void refocus_cancel(struct refocus_renderer *renderer);
enum refocus_view {
    REFOCUS_VIEW_DISPARITY = 0,
    REFOCUS_VIEW_BLUR = 1,
};
REFOCUS_API int refocus_get_view(struct refocus_renderer *renderer, uint32_t view, uint16_t *out,
                                 ptrdiff_t stride);
struct refocus_renderer_info {
    uint32_t struct_size;
    int32_t threads;
    uint32_t cpu;
    uint32_t reserved;
    uint64_t memory;
};
static inline struct refocus_renderer_info refocus_renderer_info_default(void)
{
    struct refocus_renderer_info info;
    memset(&info, 0, sizeof info);
    info.struct_size = sizeof info;
    return info;
}
REFOCUS_API void refocus_renderer_get_info(const struct refocus_renderer *renderer,
                                           struct refocus_renderer_info *info);
REFOCUS_API const char *refocus_cpu_name(uint32_t cpu);
#ifdef __cplusplus
}
#endif
#endif
