/* executor.h: threads, scratch rows for each of them, kernels, and a way to stop: all that a pass
 * needs to run. */
#ifndef RF_EXECUTOR_H
#define RF_EXECUTOR_H

#include <stdint.h>

#include "support/pool.h"

struct rf_kernels;

/* Memory for each worker, for what is too large for a stack: threads of callers may have 64 KiB. */
struct rf_shares {
    uint8_t *at;
    uint64_t size; /* bytes each */
};

static inline void *rf_share(const struct rf_shares *shares, int worker)
{
    return shares->at + (uint64_t)worker * shares->size;
}

struct rf_executor {
    struct rf_pool *pool;
    struct rf_run *run;
    const struct rf_kernels *kernels; /* for the instruction set in use: kernels/kernels.h */
    uint16_t *scratch;                /* scratch_size elements for each thread */
    uint64_t scratch_size;
    struct rf_shares shares; /* for one pass at a time */
};

/* The scratch of a worker: two rows of the largest picture with the margins of spread_row. */
static inline uint16_t *rf_scratch(const struct rf_executor *exec, int worker)
{
    return exec->scratch + (size_t)worker * exec->scratch_size;
}

/* Whether the call that is running was cancelled. Every loop that takes long asks at least once a
 * millisecond or two. */
static inline bool rf_cancelled(const struct rf_executor *exec)
{
    return rf_run_cancelled(exec->run);
}

/* Asks so before the i-th of many small items: every 64th item looks. */
static inline bool rf_cancelled_at(const struct rf_executor *exec, uint32_t i)
{
    return i % 64 == 0 && rf_cancelled(exec);
}

#endif
