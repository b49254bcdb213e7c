/* upsample.c: the loops of the depth upsampler, written for the compiler's vectoriser.
 *
 * Compiled once as plain C and once for each instruction set, like rows.c.
 */
#include "kernels/kernels.h"
#include "simd/vec.h"

static inline uint16_t least(uint16_t a, uint16_t b)
{
    return a < b ? a : b;
}

static inline uint16_t most(uint16_t a, uint16_t b)
{
    return a > b ? a : b;
}

static inline uint16_t apart(uint16_t a, uint16_t b)
{
    return (uint16_t)(most(a, b) - least(a, b));
}

static void RF_VEC(rf_blend4)(uint16_t *restrict out, const uint16_t *const row[RF_TAPS],
                              const int16_t share[RF_TAPS], int n)
{
    const uint16_t *restrict a = row[0], *restrict b = row[1];
    const uint16_t *restrict c = row[2], *restrict d = row[3];
    const uint32_t sa = (uint16_t)share[0], sb = (uint16_t)share[1];
    const uint32_t sc = (uint16_t)share[2], sd = (uint16_t)share[3];
    int x = 0;

#if defined(RF_VECTORS)
    for (; x + (int)VEC_U16 <= n; x += VEC_U16)
        vec_u16_store(out + x, vec_u16_mix4(vec_u16_load(a + x), vec_u16_load(b + x),
                                            vec_u16_load(c + x), vec_u16_load(d + x), share));
#endif
    for (; x < n; x++) {
        const uint32_t sum = a[x] * sa + b[x] * sb + c[x] * sc + d[x] * sd;

        out[x] = (uint16_t)((sum + (1 << 14)) >> 15);
    }
}

static inline uint16_t widen(const uint16_t *d, const int16_t *share)
{
    int32_t sum = 1 << 14;

    for (int k = 0; k < RF_TAPS; k++)
        sum += (d[k] - 32768) * share[k];
    return (uint16_t)((sum >> 15) + 32768);
}

static void RF_VEC(rf_widen4)(uint16_t *restrict out, const uint16_t *restrict in,
                              const struct rf_taps *restrict taps, int n)
{
    int x = 0;

#if defined(RF_VECTORS)
    for (; x + 4 <= n; x += 4) {
        const struct rf_taps *at = taps + x;
        const uint16_t *const d[4] = {in + at[0].first, in + at[1].first, in + at[2].first,
                                      in + at[3].first};
        const int16_t *const share[4] = {at[0].share, at[1].share, at[2].share, at[3].share};

        vec_dots4(out + x, d, share);
    }
#endif
    for (; x < n; x++)
        out[x] = widen(in + taps[x].first, taps[x].share);
}

static unsigned RF_VEC(rf_rough)(uint8_t rough[RF_CELLS], const uint16_t *const row[RF_TAPS],
                                 const uint8_t *const trust[RF_TAPS], int step, int n)
{
    const uint16_t *restrict a = row[0], *restrict b = row[1];
    const uint16_t *restrict c = row[2], *restrict d = row[3];
    uint16_t across[RF_CELLS + RF_TAPS], down[RF_CELLS + RF_TAPS];
    uint16_t across_inner[RF_CELLS + RF_TAPS], down_inner[RF_CELLS + RF_TAPS];
    uint8_t any = 0;

    for (int x = 0; x < n + RF_TAPS - 1; x++) {
        down_inner[x] = apart(b[x], c[x]);
        down[x] = most(most(apart(a[x], b[x]), down_inner[x]), apart(c[x], d[x]));
    }
    for (int x = 0; x < n + RF_TAPS - 2; x++) {
        across_inner[x] = most(apart(b[x], b[x + 1]), apart(c[x], c[x + 1]));
        across[x] = most(most(apart(a[x], a[x + 1]), across_inner[x]), apart(d[x], d[x + 1]));
    }
    if (trust[0])
        for (int x = 0; x < n + RF_TAPS - 1; x++) {
            const uint8_t inner = trust[1][x] & trust[2][x];

            down_inner[x] = inner != 255 ? 65535 : down_inner[x];
            down[x] = (inner & trust[0][x] & trust[3][x]) != 255 ? 65535 : down[x];
        }
    for (int x = 0; x < n; x++) {
        const uint16_t right = most(most(across_inner[x], across[x + 1]), across_inner[x + 2]);
        const uint16_t below =
            most(most(down_inner[x], down[x + 1]), most(down[x + 2], down_inner[x + 3]));

        const uint16_t right_all = most(most(across[x], across[x + 1]), across[x + 2]);
        const uint16_t below_all = most(most(down[x], down[x + 1]), most(down[x + 2], down[x + 3]));
        const uint8_t is_rough = most(right, below) > step;

        rough[x] = is_rough ? RF_ROUGH : most(right_all, below_all) > step ? RF_ROUGH_CORNER : 0;
        any |= rough[x];
    }
    return any;
}

static void RF_VEC(rf_quarter)(uint8_t *const out[3], const uint8_t *restrict pixels, int bytes,
                               int n)
{
    uint8_t *restrict first = out[0], *restrict second = out[1];
    uint8_t *restrict third = out[2];

    if (bytes == 3)
        for (int x = 0; x < n; x++) {
            first[x] = pixels[3 * x] >> 2;
            second[x] = pixels[3 * x + 1] >> 2;
            third[x] = pixels[3 * x + 2] >> 2;
        }
    else
        for (int x = 0; x < n; x++) {
            first[x] = pixels[4 * x] >> 2;
            second[x] = pixels[4 * x + 1] >> 2;
            third[x] = pixels[4 * x + 2] >> 2;
        }
}

/* Keys are disparities whose lowest bit says whether they are sure. */
static inline uint16_t key(uint16_t d, uint8_t sure)
{
    return (uint16_t)((d & ~1) | (sure & 1));
}

static const uint8_t exchange[25][2] = {{0, 3}, {1, 7}, {2, 5}, {4, 8}, {0, 7}, {2, 4}, {3, 8},
                                        {5, 6}, {0, 2}, {1, 3}, {4, 5}, {7, 8}, {1, 4}, {3, 6},
                                        {5, 7}, {0, 1}, {2, 4}, {3, 5}, {6, 8}, {2, 3}, {4, 5},
                                        {6, 7}, {1, 2}, {3, 4}, {5, 6}};

static uint16_t leaning(uint16_t v[9])
{
    int sures = 0, below, i = 8;

    for (int k = 0; k < 25; k++) {
        uint16_t *a = &v[exchange[k][0]], *b = &v[exchange[k][1]];
        const uint16_t low = least(*a, *b), high = most(*a, *b);

        *a = low;
        *b = high;
    }
    for (int k = 0; k < 9; k++)
        sures += v[k] & 1;
    below = 45 + 15 * sures; /* the weights up to v[i], times 5 */
    for (; i > 0; i--) {
        below -= 5 + 15 * (v[i] & 1);
        if (below <= 27 + 9 * sures)
            break;
    }
    return (uint16_t)(v[i] & ~1);
}

#if defined(RF_VECTORS)
/* The same of VEC_U16 pixels. With c of nine left off from the top, t of them sure, the
 * weights at or below are more than 3/5 as long as
 *
 *     5 (9 - c + 3 (sures - t)) > 3 (9 + 3 sures)
 *
 * and three never are. */
static inline vec_u16 lean(const uint16_t *const row[3], const uint8_t *const sure[3], int x)
{
    const vec_u16 one = vec_u16_set(1), even = vec_u16_set(65534);
    const vec_u16 fifteen = vec_u16_set(15);
    vec_u16 v[9], left = vec_u16_set(0), result, is_sure;

    for (int i = 0; i < 9; i++) {
        const int at = x + i % 3 - 1;
        const vec_u16 bit = vec_u16_and(vec_u16_from_bytes(sure[i / 3] + at), one);

        v[i] = vec_u16_or(vec_u16_and(vec_u16_load(row[i / 3] + at), even), bit);
        left = vec_u16_add(left, bit);
    }
    is_sure = vec_u16_equal(vec_u16_and(v[4], one), one);
    left = vec_u16_add(vec_u16_mul(left, vec_u16_set(6)), vec_u16_set(18));
#pragma GCC unroll 25
    for (int k = 0; k < 25; k++) {
        const int a = exchange[k][0], b = exchange[k][1];
        const vec_u16 low = vec_u16_min(v[a], v[b]);

        v[b] = vec_u16_max(v[a], v[b]);
        v[a] = low;
    }
    result = v[8];
#pragma GCC unroll 6
    for (int c = 1; c < 7; c++) {
        const vec_u16 end = vec_u16_set((uint16_t)(5 * c + 1));

        left = vec_u16_sub(left, vec_u16_mul(vec_u16_and(v[9 - c], one), fifteen));
        result = vec_u16_min(result, vec_u16_or(v[8 - c], vec_s16_less(left, end)));
    }
    return vec_u16_select(is_sure, vec_u16_load(row[1] + x), vec_u16_and(result, even));
}
#endif

static void RF_VEC(rf_lean3)(uint16_t *restrict out, const uint16_t *const row[3],
                             const uint8_t *const sure[3], int n)
{
    int x = 0;

#if defined(RF_VECTORS)
    for (; x + (int)VEC_U16 <= n; x += VEC_U16)
        vec_u16_store(out + x, lean(row, sure, x));
#endif
    for (; x < n; x++) {
        uint16_t v[9];

        out[x] = row[1][x];
        if (sure[1][x])
            continue;
        for (int i = 0; i < 9; i++)
            v[i] = key(row[i / 3][x + i % 3 - 1], sure[i / 3][x + i % 3 - 1]);
        out[x] = leaning(v);
    }
}

void RF_VEC(rf_upsample_use)(struct rf_kernels *kernels)
{
    kernels->blend4 = RF_VEC(rf_blend4);
    kernels->widen4 = RF_VEC(rf_widen4);
    kernels->rough = RF_VEC(rf_rough);
    kernels->quarter = RF_VEC(rf_quarter);
    kernels->lean3 = RF_VEC(rf_lean3);
}
