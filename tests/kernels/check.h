/* check.h: subjects and random numbers that the files of check-kernels share. */
#ifndef KERNELS_CHECK_H
#define KERNELS_CHECK_H

#include <stdbool.h>
#include <stdint.h>

#include <refocus/render.h>

#include "kernels/kernels.h"

/* Kernels of an instruction set, beside those in plain C. */
struct subject {
    const char *cpu;
    struct rf_kernels kernels, plain;
};

/* Whole numbers that look random: the same for the same seed. */
static inline uint32_t noise(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

static inline int noise_between(uint32_t *seed, int least, int most)
{
    return least + (int)(noise(seed) % (uint32_t)(most - least + 1));
}

/* Each prints a line that begins with "ok" or "FAIL" for each kernel; the number of failures. */
int check_rows(const struct subject *subject);
int check_sweep(const struct subject *subject);
int check_aim(const struct subject *subject);
int check_windows(const struct subject *subject);
int check_search(const struct subject *subject);
int check_series(const struct subject *subject);
int check_texture(const struct subject *subject);
int check_discs(const struct subject *subject);
int check_light(const struct subject *subject);
int check_yuv(const struct subject *subject);
int check_surface(const struct subject *subject);
int check_thin(const struct subject *subject);
int check_edges(const struct subject *subject);
int check_edge_planes(const struct subject *subject);
int check_focus(void);

/* Operations of simd/vec.h, by check_vec.c of each instruction set. */
#define SET(name, NAME, test) int check_vec_##name(void);
#define NO_SET(name, NAME)
#include "kernels/sets.def"

#endif
