/* part_taps_vec.c: the depth upsampler: sorts the samples around each cell, and splits them into
 * surfaces, a vector of cells at a time. */
#include "kernels/kernels.h"
#include "simd/vec.h"
#include "kernels/sort_network.h"

#include <string.h>

enum { TAPS = RF_TAP_COUNT };

/* VEC_U16 cells from column i on. */
static inline void part_some(struct rf_parts *parts, const uint16_t *const row[RF_TAPS], int i)
{
    const vec_u16 gap = vec_u16_set(RF_GAP), widest = vec_u16_set(RF_WIDEST);
    vec_u16 v[TAPS], low, starts = vec_u16_set(1);

    for (int t = 0; t < TAPS; t++)
        v[t] = vec_u16_load(row[t / RF_TAPS] + t % RF_TAPS + i);
#pragma GCC unroll 63
    for (int k = 0; k < RF_EXCHANGES16; k++) {
        const int a = rf_exchange16[k][0], b = rf_exchange16[k][1];
        const vec_u16 least = vec_u16_min(v[a], v[b]);

        v[b] = vec_u16_max(v[a], v[b]);
        v[a] = least;
    }
    vec_u16_store(parts->sorted[0] + i, v[0]);
    low = v[0];
    for (int t = 1; t < TAPS; t++) {
        const vec_u16 bit = vec_u16_set((uint16_t)(1 << t));
        const vec_u16 goes_on = vec_u16_and(vec_u16_at_most(vec_u16_sub(v[t], v[t - 1]), gap),
                                            vec_u16_at_most(vec_u16_sub(v[t], low), widest));

        vec_u16_store(parts->sorted[t] + i, v[t]);
        starts = vec_u16_or(starts, vec_u16_without(bit, goes_on));
        low = vec_u16_select(goes_on, low, v[t]);
    }
    vec_u16_store(parts->starts + i, starts);
}

void RF_VEC(rf_part_taps)(struct rf_parts *parts, const uint16_t *const row[RF_TAPS], int n)
{
    uint16_t spare[RF_TAPS][RF_CELLS + RF_TAPS];
    const uint16_t *whole[RF_TAPS];

    for (int j = 0; j < RF_TAPS; j++) {
        whole[j] = n < RF_CELLS ? spare[j] : row[j];
        if (n < RF_CELLS) {
            memset(spare[j], 0, sizeof spare[j]);
            memcpy(spare[j], row[j], (size_t)(n + RF_TAPS - 1) * sizeof **spare);
        }
    }
    for (int i = 0; i < RF_CELLS; i += VEC_U16)
        part_some(parts, whole, i);
}
