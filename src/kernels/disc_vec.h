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

/* Where pixels from x on are, in 2^unit / 64 pixel, RF_DISC_SIGN added. */
static inline vec_u16 rf_disc_place_of(int x, int unit)
{
#define ROW(each)                                                                                  \
    {                                                                                              \
        AT(0, each), AT(1, each), AT(2, each), AT(3, each), AT(4, each), AT(5, each), AT(6, each), \
            AT(7, each), AT(8, each), AT(9, each), AT(10, each), AT(11, each), AT(12, each),       \
            AT(13, each), AT(14, each), AT(15, each)                                               \
    }
#define AT(x, each) (uint16_t)((each) * (x) + RF_DISC_SIGN)
    static const uint16_t place[RF_DISC_MOST_UNIT + 1][RF_TILE] = {ROW(64), ROW(32), ROW(16)};
#undef AT
#undef ROW

    return vec_u16_load(place[unit] + x);
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
