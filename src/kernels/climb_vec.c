/* climb_vec.c: takes one more step up or down a map from each pixel of a cell. */
#include "kernels/kernels.h"
#include "simd/vec.h"

/* The step of a vector of pixels of a row; the lanes where it was taken. */
static RF_ALWAYS_INLINE vec_u16 climb(const struct rf_climb_cell *c, ptrdiff_t at, bool down)
{
    const uint16_t *here = c->from + at, *above = here - c->stride, *below = here + c->stride;
    const uint16_t *const around[RF_NO_DIRECTION] = {here + 1,  here - 1,  below,     above,
                                                     below + 1, above + 1, below - 1, above - 1};
    const vec_u16 one = vec_u16_set(1);
    const vec_u16 way =
        vec_u16_and(vec_u16_from_bytes(c->direction + at), vec_u16_set(down ? 0xf0 : 0x0f));
    const vec_u16 was = vec_u16_load(here), most = vec_u16_load(c->largest + at);
    const vec_u16 end = vec_u16_load(c->end + at), length = vec_u16_load(c->length + at);
    vec_u16 next = was, step, least, goes;

#pragma GCC unroll 8
    for (int k = 0; k < RF_NO_DIRECTION; k++)
        next = vec_u16_select(vec_u16_equal(way, vec_u16_set((uint16_t)(down ? 16 * k : k))),
                              vec_u16_load(around[k]), next);
    /* Ways go up or down all along. */
    step = down ? vec_u16_sub(was, next) : vec_u16_sub(next, was);
    static_assert(RF_RAMP_ENDS == 12, "(most - 1) / 12 is the greatest step that ends a way");
    least = vec_u16_mul_high(vec_u16_sub(vec_u16_max(most, one), one), vec_u16_set(43691));
    least = vec_u16_half(vec_u16_half(vec_u16_half(least)));
    least = vec_u16_max(least, vec_u16_set((uint16_t)(c->flat - 1)));
    goes = vec_u16_without(vec_u16_equal(length, vec_u16_set((uint16_t)(c->step - 1))),
                           vec_u16_at_most(step, least));
    vec_u16_store(c->to + at, next);
    vec_u16_store(c->end + at, vec_u16_select(goes, next, end));
    vec_u16_store(c->largest + at, vec_u16_max(most, vec_u16_and(step, goes)));
    vec_u16_store(c->length + at, vec_u16_select(goes, vec_u16_set(c->step), length));
    return goes;
}

static RF_ALWAYS_INLINE bool climb_cell(const struct rf_climb_cell *c, bool down)
{
    const struct rf_climb_cell cell = *c;
    vec_u16 any = vec_u16_set(0);

    for (int y = 0; y < cell.rows; y++)
        for (int x = 0; x < RF_CLIMB_CELL; x += VEC_U16)
            any = vec_u16_or(any, climb(&cell, y * cell.stride + x, down));
    return vec_u16_any(any);
}

bool RF_VEC(rf_climb)(const struct rf_climb_cell *c)
{
    if (c->columns < RF_CLIMB_CELL)
        return rf_climb_c(c);
    return c->down ? climb_cell(c, true) : climb_cell(c, false);
}
