/* sets.h: the tables of kernels, one for each instruction set that this build has. */
#ifndef RF_KERNELS_SETS_H
#define RF_KERNELS_SETS_H

#include "kernels/kernels.h"

#define SET(name, NAME, test) extern const struct rf_kernels rf_kernels_##name;
#define NO_SET(name, NAME)
#include "kernels/sets.def"

#endif
