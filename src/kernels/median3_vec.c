/* median3_vec.c: the depth upsampler: a weighted median of 3 x 3 disparities that leans to the
 * near, a vector at a time. */
#include "kernels/kernels.h"
#include "simd/vec.h"
#include "kernels/sort_network.h"

/* The medians of VEC_U16 pixels. With c of nine left off from the top, t of them sure, the
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
    for (int k = 0; k < RF_EXCHANGES9; k++) {
        const int a = rf_exchange9[k][0], b = rf_exchange9[k][1];
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

void RF_VEC(rf_median3)(uint16_t *out, const uint16_t *const row[3], const uint8_t *const sure[3],
                        int n)
{
    int x = 0;

    for (; x + (int)VEC_U16 <= n; x += VEC_U16)
        vec_u16_store(out + x, lean(row, sure, x));
    rf_median3_c(out + x, (const uint16_t *const[3]){row[0] + x, row[1] + x, row[2] + x},
                 (const uint8_t *const[3]){sure[0] + x, sure[1] + x, sure[2] + x}, n - x);
}
