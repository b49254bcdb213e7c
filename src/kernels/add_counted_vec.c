/* add_counted_vec.c: adds up values as often as they were counted, a vector of pixels and two
 * offsets at a time. */
#include "kernels/kernels.h"
#include "simd/vec.h"

/* Planes j to j + planes - 1, whose sums are in registers. */
static RF_ALWAYS_INLINE void add_planes(uint32_t (*sum)[RF_TILE], const struct rf_counted_job *job,
                                        int lane, int j, const int planes)
{
    const uint16_t *const plane = job->plane + j * job->pitch + lane;
    const vec_u16 zero = vec_u16_set(0);
    uint64_t out[RF_TILE];
    vec_u32 in[4];

    for (int c = 0; c < planes; c++)
        in[c] = vec_u32_zero();
    for (int k = 0; k < job->n; k += 2) {
        const bool is_pair = k + 1 < job->n;
        const int at = job->number[k], next_at = job->number[k + is_pair];
        const vec_u16 times = vec_u16_load(job->count[at] + lane);
        const vec_u16 next = is_pair ? vec_u16_load(job->count[next_at] + lane) : zero;

        for (int c = 0; c < planes; c++) {
            const uint16_t *const value = plane + c * job->pitch;

            in[c] = vec_u32_add_products(in[c], times, vec_u16_load(value + at), next,
                                         vec_u16_load(value + next_at));
        }
    }
    for (int c = 0; c < planes; c++) {
        for (int i = 0; i < (int)VEC_U16; i++)
            out[i] = 0;
        vec_u32_add_to(out, in[c]);
        for (int i = 0; i < (int)VEC_U16; i++)
            sum[j + c][lane + i] += (uint32_t)out[i];
    }
}

void RF_VEC(rf_add_counted)(uint32_t (*sum)[RF_TILE], const struct rf_counted_job *job)
{
    for (int lane = 0; lane < RF_TILE; lane += (int)VEC_U16) {
        int j = 0;

        for (; j + 4 <= job->planes; j += 4)
            add_planes(sum, job, lane, j, 4);
        for (; j + 3 <= job->planes; j += 3)
            add_planes(sum, job, lane, j, 3);
        for (; j < job->planes; j++)
            add_planes(sum, job, lane, j, 1);
    }
}
