/** @file measure.h  How long the compute loops take on this processor. */
#ifndef REFOCUS_MEASURE_H
#define REFOCUS_MEASURE_H

#include <stdint.h>
#include <string.h>
#include <refocus/render.h>
#include <refocus/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Times of a kernel, one of the loops that a frame's time goes into. Start from
 *  refocus_kernel_time_default(). */
struct refocus_kernel_time {
    uint32_t struct_size; /**< sizeof(struct refocus_kernel_time), set by the caller */
    uint32_t reserved;    /**< 0 */
    const char *name;     /**< static; the words of src/kernels/kernels.h */
    const char *unit;     /**< static; "pixel", or "ray sample": one ray of one pixel */
    double ns;            /**< nanoseconds for one, by the instruction set that was asked
                               for */
    double ns_c;          /**< by plain C */
};

static inline struct refocus_kernel_time refocus_kernel_time_default(void)
{
    struct refocus_kernel_time time;

    memset(&time, 0, sizeof time);
    time.struct_size = sizeof time;
    return time;
}

/**
 * Time one kernel on the calling thread: the best of runs that last about a twentieth
 * of a second, on made-up rows that fit in the first cache.
 *
 * @param index  0 and on; the first that gives REFOCUS_ERR_ARGUMENT ends the list
 * @param cpu    enum refocus_cpu
 * @return REFOCUS_OK, REFOCUS_ERR_ARGUMENT (index, cpu, a NULL or its struct_size),
 *         REFOCUS_ERR_UNSUPPORTED (the processor lacks the instruction set),
 *         REFOCUS_ERR_MEMORY. On an error *time is untouched. Thread-safe.
 */
REFOCUS_API int refocus_measure_kernel(uint32_t index, uint32_t cpu,
                                       struct refocus_kernel_time *time);

#ifdef __cplusplus
}
#endif
#endif
