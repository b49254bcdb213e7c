/* bench_kernels.h: times of the kernels. */
#ifndef RF_CLI_BENCH_KERNELS_H
#define RF_CLI_BENCH_KERNELS_H

#include "shot/engine.h"

/* --kernels: a table of refocus_measure_kernel(). Returns an exit code. */
int bench_kernels(const struct engine_settings *settings);

#endif
