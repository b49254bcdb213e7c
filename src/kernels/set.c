/* set.c: the kernels of an instruction set; compiled once for each, and once for plain C. */
#include "kernels/sets.h"

const struct rf_kernels RF_VEC(rf_kernels) = {
#define KERNEL(name) .name = RF_VEC(rf_##name),
#include "kernels/kernels.def"
};
