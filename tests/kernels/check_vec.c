/* check_vec.c: the operations of simd/vec.h against their meaning in C; compiled for each
 * instruction set, as the kernels are. Lanes take every pair of some extremes, then noise. */
#include "check_vec.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct lanes {
    uint16_t a[MOST_LANES + 1], b[MOST_LANES + 1], out[MOST_LANES + 1];
};

typedef vec_u16 operation(vec_u16 a, vec_u16 b);
typedef uint16_t meaning(uint16_t a, uint16_t b);

static uint16_t c_add(uint16_t a, uint16_t b)
{
    return (uint16_t)(a + b);
}

static uint16_t c_sub(uint16_t a, uint16_t b)
{
    return (uint16_t)(a - b);
}

static uint16_t c_and(uint16_t a, uint16_t b)
{
    return a & b;
}

static uint16_t c_or(uint16_t a, uint16_t b)
{
    return a | b;
}

static uint16_t c_without(uint16_t a, uint16_t b)
{
    return (uint16_t)(a & ~b);
}

static uint16_t c_at_most(uint16_t a, uint16_t b)
{
    return a <= b ? 0xffff : 0;
}

static uint16_t c_xor(uint16_t a, uint16_t b)
{
    return a ^ b;
}

static uint16_t c_mul_high(uint16_t a, uint16_t b)
{
    return (uint16_t)(((uint32_t)a * b) >> 16);
}

static uint16_t c_max(uint16_t a, uint16_t b)
{
    return a > b ? a : b;
}

static uint16_t c_min(uint16_t a, uint16_t b)
{
    return a < b ? a : b;
}

static uint16_t c_equal(uint16_t a, uint16_t b)
{
    return a == b ? 0xffff : 0;
}

/* Floor by division; the high half of -32768 * -32768 is beyond what kernels ask for. */
static uint16_t c_offset(uint16_t a, uint16_t b)
{
    const int64_t x = (int64_t)(int16_t)a * (int16_t)b + (1 << 22), one = 1 << 23;

    return (uint16_t)(x >= 0 ? x / one : -((-x + one - 1) / one));
}

static uint16_t c_bytes(uint16_t a, uint16_t b)
{
    return (uint16_t)((a & 0xff) | b << 8);
}

static uint16_t c_less(uint16_t a, uint16_t b)
{
    return (int16_t)a < (int16_t)b ? 0xffff : 0;
}

static uint16_t c_apart(uint16_t a, uint16_t b)
{
    const int d = abs((int16_t)a - (int16_t)b);

    return (uint16_t)(d < 32767 ? d : 32767);
}

static vec_u16 half(vec_u16 a, vec_u16 b)
{
    (void)b;
    return vec_u16_half(a);
}

static uint16_t c_half(uint16_t a, uint16_t b)
{
    (void)b;
    return a >> 1;
}

static vec_u16 first(vec_u16 a, vec_u16 b)
{
    (void)b;
    return a;
}

static uint16_t c_first(uint16_t a, uint16_t b)
{
    (void)b;
    return a;
}

static uint16_t c_mul(uint16_t a, uint16_t b)
{
    return (uint16_t)((uint32_t)a * b);
}

static uint16_t c_s16_max(uint16_t a, uint16_t b)
{
    return (int16_t)a > (int16_t)b ? a : b;
}

static uint16_t c_s16_scale(uint16_t a, uint16_t b)
{
    return (uint16_t)(((int16_t)a * (int16_t)b + (1 << 14)) >> 15);
}

/* Not both -2^15. */
static vec_u16 s16_scale(vec_u16 a, vec_u16 b)
{
    return vec_s16_scale(a, vec_s16_max(b, vec_u16_set(0x8001)));
}

static uint16_t c_s16_scale_bound(uint16_t a, uint16_t b)
{
    return c_s16_scale(a, c_s16_max(b, 0x8001));
}

/* Masks, among the lanes where a is even. */
static vec_mask mask_of(vec_u16 a, vec_u16 b)
{
    const vec_u16 one = vec_u16_set(1), zero = vec_u16_set(0);
    const vec_mask odd = vec_mask_less(vec_mask_all(), zero, vec_u16_and(a, one));

    return vec_mask_less(vec_mask_without(vec_mask_all(), odd), a, b);
}

static bool c_mask_of(uint16_t a, uint16_t b)
{
    return a % 2 == 0 && (int16_t)a < (int16_t)b;
}

static vec_u16 add_where(vec_u16 a, vec_u16 b)
{
    return vec_u16_add_where(mask_of(a, b), a, b);
}

static uint16_t c_add_where(uint16_t a, uint16_t b)
{
    return (uint16_t)(c_mask_of(a, b) ? a + b : a);
}

static vec_u16 put_where(vec_u16 a, vec_u16 b)
{
    return vec_u16_put_where(mask_of(a, b), vec_u16_set(0), b);
}

static uint16_t c_put_where(uint16_t a, uint16_t b)
{
    return c_mask_of(a, b) ? b : 0;
}

static vec_u16 choose(vec_u16 a, vec_u16 b)
{
    return vec_u16_choose(mask_of(a, b), a, b);
}

static uint16_t c_choose(uint16_t a, uint16_t b)
{
    return c_mask_of(a, b) ? a : b;
}

static vec_u16 load_where(vec_u16 a, vec_u16 b)
{
    uint16_t lanes[MOST_LANES];

    vec_u16_store(lanes, a);
    return vec_u16_load_where(mask_of(a, b), b, lanes);
}

/* Equal lanes, but only where the mask is on, and those where it is on and b is not 1. */
static vec_u16 among(vec_u16 a, vec_u16 b)
{
    const vec_mask mask = mask_of(a, b), all = vec_mask_all();
    const vec_mask equal = vec_mask_equal(all, vec_u16_half(a), vec_u16_half(b));
    const vec_mask both =
        vec_mask_or(vec_mask_equal(mask, vec_u16_or(b, vec_u16_set(1)), b), equal);

    return vec_u16_choose(both, vec_u16_set(1), vec_u16_set(0));
}

static uint16_t c_among(uint16_t a, uint16_t b)
{
    return (c_mask_of(a, b) && b % 2) || a / 2 == b / 2;
}

/* The first lane where a lane differs from lane 0, in all lanes: its value is what counts. */
static vec_u16 first_on(vec_u16 a, vec_u16 b)
{
    const vec_mask others =
        vec_mask_without(vec_mask_all(), vec_mask_equal(vec_mask_all(), b, vec_u16_spread(b)));
    uint16_t lanes[MOST_LANES];

    (void)a;
    vec_u16_store(lanes, b);
    if (vec_mask_any(others) != (lanes[vec_mask_first(others)] != lanes[0]))
        return vec_u16_set(0);
    for (int i = 0; i < vec_mask_first(others); i++)
        if (i < (int)VEC_U16 - 1 && lanes[i] != lanes[0])
            return vec_u16_set(0);
    return vec_u16_set(1);
}

static uint16_t c_first_on(uint16_t a, uint16_t b)
{
    (void)a;
    (void)b;
    return 1;
}

static const struct {
    const char *name;
    operation *run;
    meaning *expect;
} operations[] = {
    {"load, store", first, c_first},
    {"add", vec_u16_add, c_add},
    {"sub", vec_u16_sub, c_sub},
    {"and", vec_u16_and, c_and},
    {"without", vec_u16_without, c_without},
    {"clamp_row", vec_u16_at_most, c_at_most},
    {"or", vec_u16_or, c_or},
    {"xor", vec_u16_xor, c_xor},
    {"max", vec_u16_max, c_max},
    {"min", vec_u16_min, c_min},
    {"equal", vec_u16_equal, c_equal},
    {"offset", vec_u16_offset, c_offset},
    {"bytes", vec_u16_bytes, c_bytes},
    {"half", half, c_half},
    {"mul_high", vec_u16_mul_high, c_mul_high},
    {"mul", vec_u16_mul, c_mul},
    {"s16_max", vec_s16_max, c_s16_max},
    {"s16_scale", s16_scale, c_s16_scale_bound},
    {"add_where", add_where, c_add_where},
    {"put_where", put_where, c_put_where},
    {"choose", choose, c_choose},
    {"among", among, c_among},
    {"load_where", load_where, c_choose},
    {"first", first_on, c_first_on},
    {"less", vec_s16_less, c_less},
    {"apart", vec_s16_apart, c_apart},
};

/* Elements from [1] on, so that rows are unaligned. */
static int check_operation(int i)
{
    uint32_t seed = 9;
    struct lanes v;

    for (int round = 0; round < ROUNDS; round++) {
        for (int lane = 0; lane < (int)VEC_U16; lane++) {
            v.a[1 + lane] = pick(round, lane, 0, &seed);
            v.b[1 + lane] = pick(round, lane, 1, &seed);
        }
        vec_u16_store(v.out + 1, operations[i].run(vec_u16_load(v.a + 1), vec_u16_load(v.b + 1)));
        for (int lane = 1; lane <= (int)VEC_U16; lane++) {
            const uint16_t should = operations[i].expect(v.a[lane], v.b[lane]);

            if (v.out[lane] != should) {
                printf("FAIL  vec_u16_%s, %s: of 0x%04x, 0x%04x is 0x%04x, should be 0x%04x\n",
                       operations[i].name, TEXT(RF_VEC_SET), v.a[lane], v.b[lane], v.out[lane],
                       should);
                return 1;
            }
        }
    }
    return 0;
}

static int check_set(void)
{
    for (int x = 0; x <= 0xffff; x++) {
        uint16_t out[MOST_LANES];

        vec_u16_store(out, vec_u16_set((uint16_t)x));
        for (int lane = 0; lane < (int)VEC_U16; lane++)
            if (out[lane] != x) {
                printf("FAIL  vec_u16_set, %s: of %d is %d\n", TEXT(RF_VEC_SET), x, out[lane]);
                return 1;
            }
    }
    return 0;
}

static int check_add_to(void)
{
    uint32_t seed = 5, sum[MOST_LANES + 2], before[MOST_LANES + 2];
    uint16_t v[MOST_LANES];

    for (int round = 0; round < ROUNDS; round++) {
        for (int i = 0; i < (int)VEC_U16 + 2; i++)
            sum[i] = before[i] = round % 2 ? noise(&seed) : 0xffff0000 + noise(&seed) % 3;
        for (int lane = 0; lane < (int)VEC_U16; lane++)
            v[lane] = pick(round, lane, 0, &seed);
        vec_u16_add_to(sum + 1, vec_u16_load(v));
        for (int i = 0; i < (int)VEC_U16 + 2; i++) {
            const bool inside = i > 0 && i <= (int)VEC_U16;
            const uint32_t should = before[i] + (inside ? v[i - 1] : 0);

            if (sum[i] != should) {
                printf("FAIL  vec_u16_add_to, %s: sum %d is 0x%08x, should be 0x%08x\n",
                       TEXT(RF_VEC_SET), i, (unsigned)sum[i], (unsigned)should);
                return 1;
            }
        }
    }
    return 0;
}

/* a b + c d, added up twice: lanes come out in their order. */
static int check_products(void)
{
    uint32_t seed = 10;

    for (int round = 0; round < ROUNDS; round++) {
        uint16_t factor[4][MOST_LANES];
        uint64_t sum[MOST_LANES] = {0};
        vec_u32 v = vec_u32_zero();

        for (int i = 0; i < 4; i++)
            for (int lane = 0; lane < (int)VEC_U16; lane++)
                factor[i][lane] = pick(round, lane, i % 2, &seed) & 0x7fff;
        for (int twice = 0; twice < 2; twice++)
            v = vec_u32_add_products(v, vec_u16_load(factor[0]), vec_u16_load(factor[1]),
                                     vec_u16_load(factor[2 - 2 * twice]), vec_u16_load(factor[1]));
        sum[0] = UINT32_MAX;
        vec_u32_add_to(sum, v);
        for (int lane = 0; lane < (int)VEC_U16; lane++) {
            const uint64_t should =
                (lane ? 0 : (uint64_t)UINT32_MAX) +
                (uint32_t)((3u * factor[0][lane] + factor[2][lane]) * (uint32_t)factor[1][lane]);

            if (sum[lane] != should) {
                printf("FAIL  vec_u32_add_products, %s\n", TEXT(RF_VEC_SET));
                return 1;
            }
        }
    }
    return 0;
}

int RF_VEC(check_vec)(void)
{
    const int count = sizeof operations / sizeof operations[0];
    int failures = check_set() + check_add_to() + check_products() + RF_VEC(check_vec_across)();

    for (int i = 0; i < count; i++)
        failures += check_operation(i);
    if (failures == 0)
        printf("ok    %-12s %-6s %d operations, %d lanes\n", "vec_u16", TEXT(RF_VEC_SET), count + 9,
               (int)VEC_U16);
    return failures;
}
