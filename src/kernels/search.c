/* search.c: the randomized intersection search over a tile, written for the compiler's
 * vectoriser; compiled like rows.c.
 *
 * A row of a tile is taken at a time. Mostly all of its pixels guess the same offset and
 * are right: then everything is contiguous. Where they are not, each goes its own way.
 */
#include "kernels/kernels.h"
#include "simd/vec.h"

#include <stdbool.h>

struct row {
    const int16_t *blur; /* of the row's pixels */
    int32_t offset[RF_TILE];
    int16_t guess[RF_TILE], seen[RF_TILE];
};

static inline int32_t offset_of(const struct rf_search_ray *ray, int blur, int32_t stride)
{
    return ((ray->v * blur + (1 << 22)) >> 23) * stride + ((ray->u * blur + (1 << 22)) >> 23);
}

/* Offsets of the first guesses; whether they are all the same. `lanes` is RF_TILE, but a
 * count that the compiler knows makes it unroll instead of vectorise. */
static bool first_guess(struct row *row, const struct rf_search_ray *ray, int32_t stride,
                        int lanes)
{
    const int16_t *restrict from = row->blur + ray->start;
    int32_t *restrict offset = row->offset;
    int16_t *restrict guess = row->guess;
    const int u = ray->u, v = ray->v;
    int32_t differ = 0;

    for (int i = 0; i < lanes; i++) {
        const int blur = from[i];

        guess[i] = from[i];
        offset[i] = ((v * blur + (1 << 22)) >> 23) * stride + ((u * blur + (1 << 22)) >> 23);
    }
    for (int i = 0; i < lanes; i++)
        differ |= offset[i] ^ offset[0];
    return !differ;
}

/* What is seen there. */
static void look(struct row *row, bool together, int lanes)
{
    const int16_t *restrict from = row->blur + (together ? row->offset[0] : 0);
    int16_t *restrict seen = row->seen;

    if (together)
        for (int i = 0; i < lanes; i++)
            seen[i] = from[i];
    else
        for (int i = 0; i < lanes; i++)
            seen[i] = from[row->offset[i] + i];
}

static inline bool is_off(int seen, int guess, int within)
{
    return (seen - guess > within) | (guess - seen > within);
}

static bool any_off(const struct row *row, int within, int lanes)
{
    int most = 0, least = 0;

    for (int i = 0; i < lanes; i++) {
        const int apart = row->seen[i] - row->guess[i];

        most = apart > most ? apart : most;
        least = apart < least ? apart : least;
    }
    return most > within || -least > within;
}

/* Further tests of one pixel, and the pixel itself in place of a farther miss. */
static void try_on(struct row *row, const struct rf_search_ray *ray, int32_t stride, int tests,
                   int i)
{
    int guess = row->guess[i], seen = row->seen[i];

    while (is_off(seen, guess, ray->within) && --tests > 0) {
        guess = seen;
        row->offset[i] = offset_of(ray, guess, stride);
        seen = row->blur[row->offset[i] + i];
    }
    if (is_off(seen, guess, ray->within) && seen > row->blur[i])
        row->offset[i] = 0;
}

static void add(uint32_t *restrict sum, const uint16_t *restrict light, const struct row *row,
                bool together, int lanes)
{
    if (together) {
        light += row->offset[0];
        for (int i = 0; i < lanes; i++)
            sum[i] += light[i];
    } else {
        for (int i = 0; i < lanes; i++)
            sum[i] += light[row->offset[i] + i];
    }
}

static void RF_VEC(rf_search)(uint32_t sum[3][RF_TILE * RF_TILE],
                              const struct rf_search_job *job)
{
    const int32_t stride = (int32_t)job->stride;
    const int lanes = job->lanes;

    for (int y = 0; y < RF_TILE; y++) {
        const ptrdiff_t at = y * job->stride;
        struct row row = {.blur = job->blur + at};

        for (int n = 0; n < job->rays; n++) {
            const struct rf_search_ray *ray = &job->ray[n];
            bool together = first_guess(&row, ray, stride, lanes);

            look(&row, together, lanes);
            if (any_off(&row, ray->within, lanes)) {
                together = false;
                for (int i = 0; i < lanes; i++)
                    if (is_off(row.seen[i], row.guess[i], ray->within))
                        try_on(&row, ray, stride, job->tests, i);
            }
            for (int c = 0; c < 3; c++)
                add(sum[c] + y * RF_TILE, job->light[c] + at, &row, together, lanes);
        }
    }
}

void RF_VEC(rf_search_use)(struct rf_kernels *kernels)
{
    kernels->search = RF_VEC(rf_search);
}
