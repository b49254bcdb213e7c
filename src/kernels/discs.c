/* discs.c: the rows of a disc, and what hides it, plain C for the vectoriser. */
#include "kernels/kernels.h"
#include "simd/vec.h"

#include <math.h>
#include <stdlib.h>

static void RF_VEC(rf_half_chords)(int16_t *restrict half, int radius, int first)
{
    const float r = (float)radius * (1 / 256.0f), square = r * r;

#pragma GCC unroll 1
    for (int y = 0; y < RF_TILE; y++) {
        const float d = (float)(first + y), above = d - 0.25f, below = d + 0.25f;
        const float a = square - above * above, b = square - below * below;

        half[y] =
            (int16_t)(sqrtf(a > 0 ? a : 0) * 32 + sqrtf(b > 0 ? b : 0) * 32 + 0.5f);
    }
}

/* No farther than `most`. */
static inline int within(int v, int most)
{
    return v < -most ? -most : v > most ? most : v;
}

/* Where pixels of a row look, in the row where they do. The compiler is not to take
 * them apart before it could take several at once. */
static inline void look(int32_t *restrict at, const struct rf_disc_job *job, int y,
                        int part, int most)
{
    const int from = job->from, to = job->to, left = job->left[y],
              right = job->right[y];

#pragma GCC unroll 1
    for (int x = 0; x < RF_TILE; x++) {
        const int first = 64 * x + left > from ? 64 * x + left : from;
        const int last = 64 * x + right < to ? 64 * x + right : to;
        const int away = first < last ? first + last - 128 * x : 0;

        at[x] = x + within((away * part + (1 << 18)) >> 19, most);
    }
}

static void RF_VEC(rf_hide)(uint16_t *visible, const int16_t *blur, ptrdiff_t stride,
                            const struct rf_slab *slab, const struct rf_disc_job *job,
                            int middle, int part)
{
    const uint16_t from = rf_range_from(slab), to = rf_range_to(slab, slab);
    const int most = (abs(slab->centre) + 255) >> 8;

    for (int y = job->first; y < job->end; y++) {
        const int down = within(((middle - y) * part + (1 << 11)) >> 12, most);
        const int16_t *restrict row = blur + (y + down) * stride;
        uint16_t *restrict shown = visible + y * RF_TILE;
        int32_t at[RF_TILE];
        int16_t met[RF_TILE];

        look(at, job, y, part, most);
        for (int x = 0; x < RF_TILE; x++)
            met[x] = row[at[x]];
        for (int x = 0; x < RF_TILE; x++)
            shown[x] &= (uint16_t)(rf_in_range(from, to, met[x]) ? 0 : 0xffff);
    }
}

void RF_VEC(rf_discs_use)(struct rf_kernels *kernels)
{
    kernels->hide = RF_VEC(rf_hide);
    kernels->half_chords = RF_VEC(rf_half_chords);
}
