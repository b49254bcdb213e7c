/* greatest_vec.c: the greatest of some rows at each place. */
#include "kernels/kernels.h"
#include "simd/vec.h"

static RF_ALWAYS_INLINE vec_u16 most_at(const uint16_t *const *row, int rows, int x)
{
    vec_u16 most = vec_u16_load(row[0] + x);

    for (int k = 1; k < rows; k++)
        most = vec_u16_max(most, vec_u16_load(row[k] + x));
    return most;
}

/* The last vector of a row overlaps the one before. */
void RF_VEC(rf_greatest)(uint16_t *out, const uint16_t *const *row, int rows, int n)
{
    if (n < VEC_U16) {
        rf_greatest_c(out, row, rows, n);
        return;
    }
    for (int x = 0; x + VEC_U16 <= n; x += VEC_U16)
        vec_u16_store(out + x, most_at(row, rows, x));
    vec_u16_store(out + n - VEC_U16, most_at(row, rows, n - VEC_U16));
}
