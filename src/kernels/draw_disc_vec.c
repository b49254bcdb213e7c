/* draw_disc_vec.c: adds the light of a run of highlight pixels, drawn as discs, to a tile, a vector
 * at a time. */
#include "kernels/disc_vec.h"
#include "kernels/kernels.h"
#include "simd/vec.h"

static inline void add(uint16_t *mean, vec_u16 seen, vec_u16 each)
{
    const vec_u16 v = vec_s16_scale(seen, each);
    const vec_u16 room = vec_u16_xor(v, vec_u16_set(65535));

    vec_u16_store(mean, vec_u16_add(vec_u16_min(vec_u16_load(mean), room), v));
}

/* How much of a seen length is visible: half of it by each of the two masks. */
static inline vec_u16 unoccluded(vec_u16 seen, const uint16_t *visible)
{
    const vec_u16 half = vec_u16_half(seen);

    return vec_u16_add(vec_u16_and(half, vec_u16_load(visible)),
                       vec_u16_and(half, vec_u16_load(visible + RF_TILE * RF_TILE)));
}

void RF_VEC(rf_draw_disc)(uint16_t *const mean[3], const struct rf_disc_job *job)
{
    const vec_u16 times = vec_u16_set((uint16_t)(1 << job->shift)), zero = vec_u16_set(0);
    vec_u16 each[3];

    for (int c = 0; c < job->planes; c++)
        each[c] = vec_u16_set((uint16_t)job->each[c]);
    for (int y = job->first; y < job->end; y++) {
        const struct rf_disc_row row = rf_disc_row_of(job, y);

        for (int x = 0; x < RF_TILE; x += (int)VEC_U16) {
            const vec_u16 place = rf_disc_place_of(x, job->unit);
            const vec_u16 v =
                rf_disc_seen(&row, rf_disc_first(&row, place), rf_disc_last(&row, place));
            vec_u16 seen = vec_s16_max(v, zero);

            if (job->visible)
                seen = unoccluded(seen, job->visible + y * RF_TILE + x);
            seen = vec_u16_mul(seen, times);
            for (int c = 0; c < job->planes; c++)
                add(mean[c] + y * RF_TILE + x, seen, each[c]);
        }
    }
}
