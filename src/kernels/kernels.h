/* kernels.h: the table of the compute loops, and how they are written.
 *
 * A kernel is a loop over a row, a tile or a chunk of rays. What it computes, and for which values,
 * stands in the header of its family:
 *
 *     ranges.h      least and greatest blur of cells and windows
 *     rays.h        where rays look, and what they need not test
 *     gather.h      the sweeps: sums of what rays see
 *     ray_search.h  the randomized intersection search
 *     blur.h        blur radii, and the pre-filter
 *     background.h  marking and inpainting the hidden background
 *     light.h       means, weights, softening, and what is drawn over them
 *     yuv.h         codes of Y, U and V to luma and chroma and back
 *     discs.h       highlights drawn as discs
 *     thin.h        thin structures
 *     upsample.h    the depth upsampler
 *     codes.h       disparity maps of few codes
 *     edges.h       edges of disparity maps
 *     series.h      diffusion
 *
 * Every kernel has a line in kernels.def and lives in the file of its name. There are three kinds:
 *
 *   * With a vector twin. NAME.c is the reference, as plain as the contract. NAME_vec.c computes
 *     the same bits with the operations of simd/vec.h and is compiled once for each instruction
 *     set. It may call rf_NAME_c() for what is left of a row.
 *   * Left to the compiler. autovec/NAME.c is plain C that the compiler's vectoriser understands:
 *     restrict pointers, 16-bit lanes, conditions as masks, look-ups in loops of their own. It is
 *     compiled once as plain C, which is the reference, and once more for each instruction set.
 *   * Templates. What one plane and three planes have in common is written once, in
 *     NAME_planes.h, and NAME_planes_vec.h for vectors, as inline functions of which the number
 *     of planes is a constant parameter. NAME.c and NAME1.c, and their twins, are an
 *     instance each.
 *
 * Adding a kernel takes its file, its line in kernels.def, its contract, and a check in
 * tests/kernels. Adding an instruction set takes a value of enum refocus_cpu, its line in sets.def,
 * its compiler options in meson.build, and its operations in simd/vec_NAME.h.
 */
#ifndef RF_KERNELS_H
#define RF_KERNELS_H

#include <stdbool.h>
#include <stdint.h>

#include "kernels/background.h"
#include "kernels/blur.h"
#include "kernels/codes.h"
#include "kernels/discs.h"
#include "kernels/edges.h"
#include "kernels/gather.h"
#include "kernels/light.h"
#include "kernels/ranges.h"
#include "kernels/rays.h"
#include "kernels/ray_search.h"
#include "kernels/series.h"
#include "kernels/thin.h"
#include "kernels/upsample.h"
#include "kernels/yuv.h"

/* RF_VEC_SET is the name of an instruction set in what is compiled for it, so RF_VEC(rf_sweep) is
 * rf_sweep_avx2 in one object, rf_sweep_neon in another, and rf_sweep_c in that of plain C. */
#define RF_VEC_PASTE(name, set)  name##_##set
#define RF_VEC_EXPAND(name, set) RF_VEC_PASTE(name, set)
#define RF_VEC(name)             RF_VEC_EXPAND(name, RF_VEC_SET)

/* Templates are inlined so that the compiler sees their constant parameters as constants. */
#define RF_ALWAYS_INLINE inline __attribute__((always_inline))

/* The table has a member for each kernel: rf_sweep_fn *sweep, and so on. */
struct rf_kernels {
#define KERNEL(name) rf_##name##_fn *name;
#include "kernels/kernels.def"
};

/* The references. */
#define KERNEL(name) rf_##name##_fn rf_##name##_c;
#include "kernels/kernels.def"

/* In files that are compiled for an instruction set, its kernels. */
#if defined(RF_VEC_SET)
#define KERNEL(name) rf_##name##_fn RF_VEC(rf_##name);
#include "kernels/kernels.def"
#endif

/* The best kernels of an instruction set, enum refocus_cpu; false: this processor or build does
 * not have it. AUTO chooses; *cpu is what it chose. */
bool rf_kernels_select(struct rf_kernels *kernels, uint32_t *cpu);

#endif
