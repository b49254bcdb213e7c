/* part.c: samples brought into the order in which cells look at them.
 *
 * Compiled once as plain C and once for each instruction set, like rows.c.
 */
#include "kernels/kernels.h"
#include "simd/vec.h"

#include <string.h>

enum { TAPS = RF_TAP_COUNT };

/* Batcher's odd-even merges of runs of 1, 2, 4 and 8. */
enum { EXCHANGES = 63 };
static const uint8_t exchange[EXCHANGES][2] = {
    {0, 1},   {2, 3},   {4, 5}, {6, 7},   {8, 9},   {10, 11}, {12, 13}, {14, 15}, {0, 2},
    {1, 3},   {4, 6},   {5, 7}, {8, 10},  {9, 11},  {12, 14}, {13, 15}, {1, 2},   {5, 6},
    {9, 10},  {13, 14}, {0, 4}, {1, 5},   {2, 6},   {3, 7},   {8, 12},  {9, 13},  {10, 14},
    {11, 15}, {2, 4},   {3, 5}, {10, 12}, {11, 13}, {1, 2},   {3, 4},   {5, 6},   {9, 10},
    {11, 12}, {13, 14}, {0, 8}, {1, 9},   {2, 10},  {3, 11},  {4, 12},  {5, 13},  {6, 14},
    {7, 15},  {4, 8},   {5, 9}, {6, 10},  {7, 11},  {2, 4},   {3, 5},   {6, 8},   {7, 9},
    {10, 12}, {11, 13}, {1, 2}, {3, 4},   {5, 6},   {7, 8},   {9, 10},  {11, 12}, {13, 14}};

#if defined(RF_VECTORS)

/* VEC_U16 cells from column i on. */
static inline void part_some(struct rf_parts *parts, const uint16_t *const row[RF_TAPS], int i)
{
    const vec_u16 gap = vec_u16_set(RF_GAP), widest = vec_u16_set(RF_WIDEST);
    vec_u16 v[TAPS], low, starts = vec_u16_set(1);

    for (int t = 0; t < TAPS; t++)
        v[t] = vec_u16_load(row[t / RF_TAPS] + t % RF_TAPS + i);
#pragma GCC unroll 63
    for (int k = 0; k < EXCHANGES; k++) {
        const int a = exchange[k][0], b = exchange[k][1];
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

static void RF_VEC(rf_part)(struct rf_parts *parts, const uint16_t *const row[RF_TAPS], int n)
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

#else

static inline uint16_t least(uint16_t a, uint16_t b)
{
    return a < b ? a : b;
}

static inline uint16_t most(uint16_t a, uint16_t b)
{
    return a > b ? a : b;
}

/* Cells side by side: a tap of them all lies in a row. */
static inline void order(uint16_t *restrict low, uint16_t *restrict high)
{
    for (int i = 0; i < RF_CELLS; i++) {
        const uint16_t a = low[i], b = high[i];

        low[i] = least(a, b);
        high[i] = most(a, b);
    }
}

static void sort(uint16_t sorted[TAPS][RF_CELLS])
{
    for (int i = 0; i < EXCHANGES; i++)
        order(sorted[exchange[i][0]], sorted[exchange[i][1]]);
}

static void RF_VEC(rf_part)(struct rf_parts *parts, const uint16_t *const row[RF_TAPS], int n)
{
    uint16_t low[RF_CELLS], starts[RF_CELLS];

    for (int t = 0; t < TAPS; t++) {
        memset(parts->sorted[t], 0, sizeof parts->sorted[t]);
        memcpy(parts->sorted[t], row[t / RF_TAPS] + t % RF_TAPS, (size_t)n * sizeof(uint16_t));
    }
    sort(parts->sorted);
    for (int i = 0; i < RF_CELLS; i++) {
        low[i] = parts->sorted[0][i];
        starts[i] = 1;
    }
    for (int t = 1; t < TAPS; t++) {
        const uint16_t *restrict last = parts->sorted[t - 1];
        const uint16_t *restrict d = parts->sorted[t];

        for (int i = 0; i < RF_CELLS; i++) {
            const uint16_t far_off =
                (uint16_t)((d[i] - last[i] > RF_GAP) | (d[i] - low[i] > RF_WIDEST));

            starts[i] = (uint16_t)(starts[i] | far_off << t);
            low[i] = far_off ? d[i] : low[i];
        }
    }
    memcpy(parts->starts, starts, sizeof starts);
}

#endif

static void RF_VEC(rf_turn8)(uint8_t out[RF_AROUND * RF_TURNED],
                             const uint8_t *const row[RF_AROUND])
{
    const uint8_t *restrict a = row[0], *restrict b = row[1], *restrict c = row[2];
    const uint8_t *restrict d = row[3], *restrict e = row[4], *restrict f = row[5];
    const uint8_t *restrict g = row[6], *restrict h = row[7];

    for (int x = 0; x < RF_TURNED; x++) {
        uint8_t *restrict to = out + RF_AROUND * x;

        to[0] = a[x], to[1] = b[x], to[2] = c[x], to[3] = d[x];
        to[4] = e[x], to[5] = f[x], to[6] = g[x], to[7] = h[x];
    }
}

static void RF_VEC(rf_turn16)(uint16_t out[RF_AROUND * RF_TURNED],
                              const uint16_t *const row[RF_AROUND])
{
    const uint16_t *restrict a = row[0], *restrict b = row[1], *restrict c = row[2];
    const uint16_t *restrict d = row[3], *restrict e = row[4], *restrict f = row[5];
    const uint16_t *restrict g = row[6], *restrict h = row[7];

    for (int x = 0; x < RF_TURNED; x++) {
        uint16_t *restrict to = out + RF_AROUND * x;

        to[0] = a[x], to[1] = b[x], to[2] = c[x], to[3] = d[x];
        to[4] = e[x], to[5] = f[x], to[6] = g[x], to[7] = h[x];
    }
}

void RF_VEC(rf_part_use)(struct rf_kernels *kernels)
{
    kernels->part = RF_VEC(rf_part);
    kernels->turn8 = RF_VEC(rf_turn8);
    kernels->turn16 = RF_VEC(rf_turn16);
}
