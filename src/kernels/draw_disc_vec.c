/* draw_disc_vec.c: the light of lamps, drawn as discs, a vector of pixels at a time. */
#include "kernels/kernels.h"
#include "simd/vec.h"

enum {
    SIGN = 0x8000
}; /* added to signed lanes makes them comparable as unsigned ones */

/* Where pixels are, 1/64 pixel, SIGN added. */
#define AT(x) (uint16_t)(64 * (x) + SIGN)
static const uint16_t place[RF_TILE] = {AT(0),  AT(1),  AT(2),  AT(3), AT(4),  AT(5),
                                        AT(6),  AT(7),  AT(8),  AT(9), AT(10), AT(11),
                                        AT(12), AT(13), AT(14), AT(15)};

static inline void add(uint16_t *mean, vec_u16 seen, vec_u16 each)
{
    const vec_u16 v = vec_s16_scale(seen, each);
    const vec_u16 room = vec_u16_xor(v, vec_u16_set(65535));

    vec_u16_store(mean, vec_u16_add(vec_u16_min(vec_u16_load(mean), room), v));
}

static void RF_VEC(rf_draw_disc)(uint16_t *const mean[3], const struct rf_disc_job *job)
{
    const vec_u16 times = vec_u16_set((uint16_t)(1 << job->shift)),
                  zero = vec_u16_set(0);
    vec_u16 each[3];

    for (int c = 0; c < job->planes; c++)
        each[c] = vec_u16_set((uint16_t)job->each[c]);
    for (int y = job->first; y < job->end; y++) {
        const int left = job->left[y], right = job->right[y];
        const vec_u16 chord = vec_u16_set((uint16_t)(right - left));
        const vec_u16 low = vec_u16_set((uint16_t)(job->to - right + SIGN));
        const vec_u16 high = vec_u16_set((uint16_t)(job->from - left + SIGN));

        for (int x = 0; x < RF_TILE; x += (int)VEC_U16) {
            const vec_u16 at = vec_u16_load(place + x);
            const vec_u16 a = vec_u16_min(at, low), b = vec_u16_max(at, high);
            const vec_u16 v = vec_u16_add(vec_u16_sub(a, b), chord);
            vec_u16 seen = vec_u16_mul(vec_s16_max(v, zero), times);

            if (job->visible)
                seen = vec_u16_and(seen, vec_u16_load(job->visible + y * RF_TILE + x));
            for (int c = 0; c < job->planes; c++)
                add(mean[c] + y * RF_TILE + x, seen, each[c]);
        }
    }
}

void RF_VEC(rf_draw_disc_use)(struct rf_kernels *kernels)
{
    kernels->draw_disc = RF_VEC(rf_draw_disc);
}
