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

static void RF_VEC(rf_blend4)(uint16_t *restrict out, const uint16_t *const row[4],
                              const uint16_t weight[4], int n)
{
    const uint16_t *restrict a = row[0], *restrict b = row[1];
    const uint16_t *restrict c = row[2], *restrict d = row[3];
    const uint32_t wa = weight[0], wb = weight[1], wc = weight[2], wd = weight[3];

    for (int x = 0; x < n; x++)
        out[x] = (uint16_t)((a[x] * wa + b[x] * wb + c[x] * wc + d[x] * wd + (1 << 15)) >> 16);
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

static bool RF_VEC(rf_rough)(uint8_t rough[RF_CELLS], const uint16_t *const row[RF_TAPS],
                             const uint8_t *const trust[RF_TAPS], int step, int n)
{
    const uint16_t *restrict a = row[0], *restrict b = row[1];
    const uint16_t *restrict c = row[2], *restrict d = row[3];
    uint16_t across[RF_CELLS + RF_TAPS], down[RF_CELLS + RF_TAPS];
    uint8_t any = 0;

    for (int x = 0; x < n + RF_TAPS - 1; x++)
        down[x] = most(most(apart(a[x], b[x]), apart(b[x], c[x])), apart(c[x], d[x]));
    for (int x = 0; x < n + RF_TAPS - 2; x++)
        across[x] = most(most(apart(a[x], a[x + 1]), apart(b[x], b[x + 1])),
                         most(apart(c[x], c[x + 1]), apart(d[x], d[x + 1])));
    if (trust[0])
        for (int x = 0; x < n + RF_TAPS - 1; x++)
            if ((trust[0][x] & trust[1][x] & trust[2][x] & trust[3][x]) != 255)
                down[x] = 65535;
    for (int x = 0; x < n; x++) {
        const uint16_t right = most(most(across[x], across[x + 1]), across[x + 2]);
        const uint16_t below = most(most(down[x], down[x + 1]), most(down[x + 2], down[x + 3]));

        rough[x] = most(right, below) > step;
        any |= rough[x];
    }
    return any;
}

static void RF_VEC(rf_quarter)(uint8_t *const out[3], const uint8_t *restrict pixels, int bytes,
                               int n)
{
    uint8_t *restrict first = out[0], *restrict second = out[1], *restrict third = out[2];

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

static inline void order(uint16_t *restrict a, uint16_t *restrict b)
{
    const uint16_t low = least(*a, *b), high = most(*a, *b);

    *a = low;
    *b = high;
}

/* What of a network that sorts nine the sixth depends on. */
static void RF_VEC(rf_lean3)(uint16_t *restrict out, const uint16_t *restrict before,
                             const uint16_t *restrict row, const uint16_t *restrict after,
                             const uint8_t *restrict sure, int n)
{
    for (int x = 0; x < n; x++) {
        uint16_t v[9];

        for (int i = 0; i < 3; i++) {
            v[i] = before[x + i - 1];
            v[i + 3] = row[x + i - 1];
            v[i + 6] = after[x + i - 1];
        }
        order(&v[0], &v[3]), order(&v[1], &v[7]), order(&v[2], &v[5]), order(&v[4], &v[8]);
        order(&v[0], &v[7]), order(&v[2], &v[4]), order(&v[3], &v[8]), order(&v[5], &v[6]);
        order(&v[0], &v[2]), order(&v[1], &v[3]), order(&v[4], &v[5]), order(&v[7], &v[8]);
        order(&v[1], &v[4]), order(&v[3], &v[6]), order(&v[5], &v[7]);
        order(&v[2], &v[4]), order(&v[3], &v[5]), order(&v[6], &v[8]);
        order(&v[4], &v[5]), order(&v[6], &v[7]);
        order(&v[5], &v[6]);
        out[x] = sure[x] ? row[x] : v[5];
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
