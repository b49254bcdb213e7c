/* kernels.h: the compute loops and their contracts.
 *
 * NAME.c is the reference, as plain as the contract, always built. NAME_vec.c computes
 * the same bits with the operations of simd/vec.h. Files named rows_*.c are plain C written
 * for the compiler's vectoriser; they are compiled once more for each instruction set.
 */
#ifndef RF_KERNELS_H
#define RF_KERNELS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "tiles/slab.h"

/*
 * sweep: rays of one tile of RF_TILE x RF_TILE pixels.
 *
 *     for each ray n and pixel p of the tile:
 *         for k = 0 .. slabs - 1:
 *             q = p + offset[k][n]
 *             if 0 <= blur[q] - slab[k].low <= slab[k].width:
 *                 sum += light[q]; next ray
 *         if see_behind: sum += behind[p + offset[slabs][n]]
 *
 * Light is Q12, at most 4095; sums are exact. Pointers are to the tile's first pixel.
 */
enum { RF_RAY_CHUNK = 64 };

struct rf_sweep_job {
    const int16_t *blur;
    const uint16_t *light[3], *behind[3];
    ptrdiff_t stride;
    int rays;                                /* at most RF_RAY_CHUNK */
    int slabs;
    const struct rf_slab *slab;
    const int32_t (*offset)[RF_RAY_CHUNK];   /* [slabs + 1], of elements */
    bool see_behind;
    bool uniform; /* slabs == 1, and whatever is looked at is in it */
};
typedef void rf_sweep_fn(uint32_t sum[3][RF_TILE * RF_TILE], const struct rf_sweep_job *job);

struct rf_kernels {
    rf_sweep_fn *sweep;
};

/* The best kernels of an instruction set, enum refocus_cpu; false: this processor or build does
 * not have it. AUTO chooses; *cpu is what it chose. */
bool rf_kernels_select(struct rf_kernels *kernels, uint32_t *cpu);

rf_sweep_fn rf_sweep_c;

/* Each set overwrites what it does better. */
typedef void rf_kernels_use_fn(struct rf_kernels *kernels);
rf_kernels_use_fn rf_kernels_use_neon, rf_kernels_use_sse41, rf_kernels_use_avx2;

#endif
