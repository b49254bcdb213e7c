/* occlude_disc_vec.c: which part of a highlight's disc nearer surfaces occlude, a vector of pixels
 * at a time.
 *
 * Places are found for all rows first, then the blurs there are looked up, then masks are made of
 * them, so that no vector waits for its elements.
 */
#include "kernels/kernels.h"
#include "simd/vec.h"
#include "kernels/disc_vec.h"

static const uint16_t column[RF_TILE] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

/* (s times + 2^(22 - unit)) >> (23 - unit), of signed lanes. Of a unit, the high half is made of
 * the unsigned one, and shifted by another high half. */
static inline vec_u16 offset_of(vec_u16 s, const struct rf_disc_way *way)
{
    const vec_u16 times = vec_u16_set((uint16_t)way->times);
    vec_u16 high;

    if (!way->unit)
        return vec_u16_offset(s, times);
    high = vec_u16_sub(vec_u16_mul_high(s, times),
                       vec_u16_and(vec_s16_less(s, vec_u16_set(0)), times));
    if (way->times < 0)
        high = vec_u16_sub(high, s);
    high = vec_u16_add(high, vec_u16_set((uint16_t)((64 >> way->unit) + RF_DISC_SIGN)));
    return vec_u16_sub(vec_u16_mul_high(high, vec_u16_set((uint16_t)(1 << (9 + way->unit)))),
                       vec_u16_set((uint16_t)(RF_DISC_SIGN >> (7 - way->unit))));
}

/* Finds the places in a row of blurs, counted from way->most pixels before the tile on, where
 * pixels look for each of the two masks. */
static inline void find_places(uint16_t *at, const struct rf_disc_job *job, int y,
                               const struct rf_disc_way *way)
{
    const struct rf_disc_row row = rf_disc_row_of(job, y);
    const vec_u16 both = vec_u16_set((uint16_t)(job->left[y] + job->right[y]));
    const vec_u16 power = vec_u16_set((uint16_t)(1 << way->shift));
    const vec_u16 zero = vec_u16_set(0);
    const vec_u16 before = vec_u16_set((uint16_t)(way->aside << 12));
    const vec_u16 after = vec_u16_set((uint16_t)((16 - way->aside) << 12));
    const vec_u16 middle = vec_u16_set((uint16_t)(job->from + job->to + RF_DISC_SIGN));
    const vec_u16 nearest = vec_u16_set((uint16_t)(2 * job->left[y] + RF_DISC_SIGN));
    const vec_u16 farthest = vec_u16_set((uint16_t)(2 * job->right[y] + RF_DISC_SIGN));
    const vec_u16 to = vec_u16_set((uint16_t)way->most);
    uint16_t *const left = way->mirrored ? at + RF_TILE * RF_TILE : at;
    uint16_t *const right = way->mirrored ? at : at + RF_TILE * RF_TILE;

    for (int x = 0; x < RF_TILE; x += (int)VEC_U16) {
        const vec_u16 place = rf_disc_place_of(x, job->unit);
        const vec_u16 first = rf_disc_first(&row, place), last = rf_disc_last(&row, place);
        const vec_u16 seen = rf_disc_seen(&row, first, last), some = vec_s16_less(zero, seen);
        const vec_u16 sum = vec_u16_add(vec_u16_add(first, last), both);
        const vec_u16 twice = vec_u16_add(place, place);
        const vec_u16 far = vec_u16_max(vec_u16_min(vec_u16_sub(middle, twice), farthest), nearest);
        const vec_u16 away = vec_u16_select(some, vec_u16_sub(sum, twice),
                                            vec_u16_sub(far, vec_u16_set(RF_DISC_SIGN)));
        const vec_u16 length = vec_u16_and(seen, some);
        const vec_u16 a = vec_u16_sub(away, vec_u16_mul_high(length, before));
        const vec_u16 b = vec_u16_add(away, vec_u16_mul_high(length, after));

        const vec_u16 own = vec_u16_add(vec_u16_load(column + x), to);

        vec_u16_store(left + x, vec_u16_add(own, offset_of(vec_u16_mul(a, power), way)));
        vec_u16_store(right + x, vec_u16_add(own, offset_of(vec_u16_mul(b, power), way)));
    }
}

/* Replaces places in a row by the blurs there. */
static inline void look_up(uint16_t *at, const int16_t *row)
{
    for (int x = 0; x < RF_TILE; x++)
        at[x] = (uint16_t)row[at[x]];
}

/* Sets the masks of rows y to end - 1 by the blurs that the pixels of one row find. */
static inline void set_masks(uint16_t *visible, const uint16_t *blur, vec_u16 from, vec_u16 to,
                             int y, int end)
{
    for (int x = 0; x < RF_TILE; x += (int)VEC_U16) {
        const vec_u16 hidden = vec_s16_less(vec_u16_sub(vec_u16_load(blur + x), from), to);
        const vec_u16 seen = vec_u16_without(vec_u16_set(0xffff), hidden);

        for (int i = y * RF_TILE + x; i < end * RF_TILE; i += RF_TILE)
            vec_u16_store(visible + i, seen);
    }
}

void RF_VEC(rf_occlude_disc)(uint16_t *visible, const int16_t *blur, ptrdiff_t stride,
                             const struct rf_slab *slab, const struct rf_disc_job *job,
                             const struct rf_disc_way *way)
{
    const vec_u16 from = vec_u16_set(rf_range_from(slab));
    const vec_u16 to = vec_u16_set(rf_range_to(slab, slab));
    const int step = way->times * (1 << way->shift), shift = 23 - way->unit,
              half = 1 << (shift - 1), pixel = 64 >> job->unit;
    uint16_t at[2 * RF_TILE * RF_TILE], *const second = at + RF_TILE * RF_TILE;

    for (int y = job->first; y < job->end; y += way->rows)
        find_places(at + y * RF_TILE, job, y, way);
    for (int y = job->first; y < job->end; y += way->rows) {
        const int down = pixel * (way->middle - 2 * y);
        const int above = y + (((down - pixel / 2) * step + half) >> shift);
        const int below = y + (((down + pixel / 2) * step + half) >> shift);

        look_up(at + y * RF_TILE, blur + above * stride - way->most);
        look_up(second + y * RF_TILE, blur + below * stride - way->most);
    }
    for (int y = job->first; y < job->end; y += way->rows) {
        const int end = y + way->rows < job->end ? y + way->rows : job->end;

        set_masks(visible, at + y * RF_TILE, from, to, y, end);
        set_masks(visible + RF_TILE * RF_TILE, second + y * RF_TILE, from, to, y, end);
    }
}
