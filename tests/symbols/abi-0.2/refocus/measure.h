/* measure.h: that of librefocus 0.2, without its comments; made by tests/symbols/abi.py. */
#ifndef REFOCUS_MEASURE_H
#define REFOCUS_MEASURE_H
#include <stdint.h>
#include <string.h>
#include <refocus/render.h>
#include <refocus/status.h>
#ifdef __cplusplus
extern "C" {
#endif
struct refocus_kernel_time {
    uint32_t struct_size;
    uint32_t reserved;
    const char *name;
    const char *unit;
    double ns;
    double ns_c;
};
static inline struct refocus_kernel_time refocus_kernel_time_default(void)
{
    struct refocus_kernel_time time;
    memset(&time, 0, sizeof time);
    time.struct_size = sizeof time;
    return time;
}
REFOCUS_API int refocus_measure_kernel(uint32_t index, uint32_t cpu,
                                       struct refocus_kernel_time *time);
#ifdef __cplusplus
}
#endif
#endif
