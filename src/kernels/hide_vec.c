/* hide_vec.c: where nearer things hide the lamp of a disc, a vector of pixels at a time. Places are
 * found for all rows before what is there is looked up, and that before it is judged, so that no
 * vector waits for its elements. */
#include "kernels/disc_vec.h"
#include "kernels/kernels.h"
#include "simd/vec.h"

/* How far to the side pixels of a row look. */
static inline void look(uint16_t *at, const struct rf_disc_job *job, int y, struct rf_disc_way way)
{
    const struct disc_row row = disc_row_of(job, y);
    const vec_u16 both = vec_u16_set((uint16_t)(job->left[y] + job->right[y]));
    const vec_u16 power = vec_u16_set((uint16_t)(1 << way.shift));
    const vec_u16 times = vec_u16_set((uint16_t)way.times), zero = vec_u16_set(0);

    for (int x = 0; x < RF_TILE; x += (int)VEC_U16) {
        const vec_u16 place = disc_place_of(x);
        const vec_u16 first = disc_first(&row, place), last = disc_last(&row, place);
        const vec_u16 some = vec_s16_less(zero, disc_seen(&row, first, last));
        const vec_u16 sum = vec_u16_add(vec_u16_add(first, last), both);
        const vec_u16 away = vec_u16_sub(sum, vec_u16_add(place, place));

        vec_u16_store(at + x,
                      vec_u16_offset(vec_u16_mul(vec_u16_and(away, some), power), times));
    }
}

static void RF_VEC(rf_hide)(uint16_t *visible, const int16_t *blur, ptrdiff_t stride,
                            const struct rf_slab *slab, const struct rf_disc_job *job, int middle,
                            struct rf_disc_way way)
{
    const vec_u16 from = vec_u16_set(rf_range_from(slab));
    const vec_u16 to = vec_u16_set(rf_range_to(slab, slab));
    const int step = 128 * way.times * (1 << way.shift);
    uint16_t at[RF_TILE * RF_TILE];

    for (int y = job->first; y < job->end; y++)
        look(at + y * RF_TILE, job, y, way);
    for (int y = job->first; y < job->end; y++) {
        const int16_t *row = blur + (y + (((middle - y) * step + (1 << 22)) >> 23)) * stride;
        uint16_t *const here = at + y * RF_TILE;

        for (int x = 0; x < RF_TILE; x++)
            here[x] = (uint16_t)row[x + (int16_t)here[x]];
    }
    for (int i = job->first * RF_TILE; i < job->end * RF_TILE; i += (int)VEC_U16) {
        const vec_u16 met = vec_u16_sub(vec_u16_load(at + i), from);

        vec_u16_store(visible + i,
                      vec_u16_without(vec_u16_load(visible + i), vec_s16_less(met, to)));
    }
}

void RF_VEC(rf_hide_use)(struct rf_kernels *kernels)
{
    kernels->hide = RF_VEC(rf_hide);
}
