/* disc_vec.h: how much of a run of highlight pixels each pixel sees (discs.h), in vectors. */
#ifndef RF_DISC_VEC_H
#define RF_DISC_VEC_H

#include "kernels/discs.h"
#include "simd/vec.h"

/* Added to signed lanes makes them comparable as unsigned ones. */
enum { RF_DISC_SIGN = 0x8000 };

struct rf_disc_row {
    vec_u16 chord, low, high;
};

static inline struct rf_disc_row rf_disc_row_of(const struct rf_disc_job *job, int y)
{
    const int left = job->left[y], right = job->right[y];

    return (struct rf_disc_row){vec_u16_set((uint16_t)(right - left)),
                                vec_u16_set((uint16_t)(job->to - right + RF_DISC_SIGN)),
                                vec_u16_set((uint16_t)(job->from - left + RF_DISC_SIGN))};
}

/* Where pixels from x on are, 1/64 pixel, RF_DISC_SIGN added. */
static inline vec_u16 rf_disc_place_of(int x)
{
#define AT(x) (uint16_t)(64 * (x) + RF_DISC_SIGN)
    static const uint16_t place[RF_TILE] = {AT(0),  AT(1),  AT(2),  AT(3), AT(4),  AT(5),
                                            AT(6),  AT(7),  AT(8),  AT(9), AT(10), AT(11),
                                            AT(12), AT(13), AT(14), AT(15)};
#undef AT

    return vec_u16_load(place + x);
}

/* The part that pixels see begins `left` beyond rf_disc_first(), and ends `right` beyond
 * rf_disc_last(). */
static inline vec_u16 rf_disc_first(const struct rf_disc_row *row, vec_u16 place)
{
    return vec_u16_max(place, row->high);
}

static inline vec_u16 rf_disc_last(const struct rf_disc_row *row, vec_u16 place)
{
    return vec_u16_min(place, row->low);
}

/* How long it is, signed: less than nothing is nothing. */
static inline vec_u16 rf_disc_seen(const struct rf_disc_row *row, vec_u16 first, vec_u16 last)
{
    return vec_u16_add(vec_u16_sub(last, first), row->chord);
}

#endif
