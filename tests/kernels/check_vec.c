/* The operations of simd/vec.h against their meaning in C; compiled for each instruction
 * set, as the kernels are. Lanes take every pair of some extremes, then noise. */
#include "check.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "simd/vec.h"

#define TEXT_OF(set) #set
#define TEXT(set)    TEXT_OF(set)

enum { MOST_LANES = 32, ROUNDS = 2000 };

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
    const vec_mask both = vec_mask_or(
        vec_mask_equal(mask, vec_u16_or(b, vec_u16_set(1)), b), equal);

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
    {"load, store", first, c_first},         {"add", vec_u16_add, c_add},
    {"sub", vec_u16_sub, c_sub},             {"and", vec_u16_and, c_and},
    {"without", vec_u16_without, c_without}, {"at_most", vec_u16_at_most, c_at_most},
    {"or", vec_u16_or, c_or},                {"xor", vec_u16_xor, c_xor},
    {"max", vec_u16_max, c_max},             {"min", vec_u16_min, c_min},
    {"equal", vec_u16_equal, c_equal},       {"offset", vec_u16_offset, c_offset},
    {"bytes", vec_u16_bytes, c_bytes},
    {"half", half, c_half},                  {"mul_high", vec_u16_mul_high, c_mul_high},
    {"mul", vec_u16_mul, c_mul},             {"s16_max", vec_s16_max, c_s16_max},
    {"s16_scale", s16_scale, c_s16_scale_bound},
    {"add_where", add_where, c_add_where},
    {"put_where", put_where, c_put_where},
    {"choose", choose, c_choose},            {"among", among, c_among},
    {"load_where", load_where, c_choose},
    {"first", first_on, c_first_on},         {"less", vec_s16_less, c_less},
    {"apart", vec_s16_apart, c_apart},
};

static uint16_t pick(int round, int lane, int which, uint32_t *seed)
{
    static const uint16_t extreme[] = {0,      1,      2,      0x7ffe, 0x7fff, 0x8000,
                                       0x8001, 0xfffe, 0xffff, 0x00ff, 0x0100, 0xff00};
    const int pair = round * (int)VEC_U16 + lane;

    if (pair < 12 * 12)
        return extreme[which ? pair / 12 : pair % 12];
    return (uint16_t)noise(seed);
}

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

static int check_from_bytes(void)
{
    uint32_t seed = 15;

    for (int round = 0; round < ROUNDS; round++) {
        uint8_t in[MOST_LANES + 1];
        uint16_t out[MOST_LANES];

        for (int i = 0; i <= (int)VEC_U16; i++)
            in[i] = (uint8_t)noise(&seed);
        vec_u16_store(out, vec_u16_from_bytes(in + round % 2));
        for (int lane = 0; lane < (int)VEC_U16; lane++)
            if (out[lane] != in[round % 2 + lane]) {
                printf("FAIL  vec_u16_from_bytes, %s: round %d\n", TEXT(RF_VEC_SET),
                       round);
                return 1;
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

/* Operations that move lanes, and any(). */
static int check_order(void)
{
    enum { N = (int)VEC_U16 };
    uint16_t in[2 * MOST_LANES], out[4][MOST_LANES];
    vec_u16 a, b;

    for (int i = 0; i < 2 * N; i++)
        in[i] = (uint16_t)(0x8000 + 257 * i);
    a = vec_u16_load(in);
    b = vec_u16_load(in + N);
    vec_u16_store(out[0], vec_u16_even(a, b));
    vec_u16_store(out[1], vec_u16_odd(a, b));
    vec_u16_store(out[2], vec_u16_zip_low(a, b));
    vec_u16_store(out[3], vec_u16_zip_high(a, b));
    for (int i = 0; i < N; i++) {
        if (out[0][i] != in[2 * i] || out[1][i] != in[2 * i + 1] ||
            out[2][i] != in[i / 2 + i % 2 * N] || out[3][i] != in[N / 2 + i / 2 + i % 2 * N]) {
            printf("FAIL  vec_u16_even, odd or zip, %s: lane %d\n", TEXT(RF_VEC_SET), i);
            return 1;
        }
    }
    vec_u16_store(out[0], vec_u16_twice(b));
    for (int i = 0; i < N; i++) {
        if (out[0][i] != in[N + i / 2 * 2]) {
            printf("FAIL  vec_u16_twice, %s: lane %d\n", TEXT(RF_VEC_SET), i);
            return 1;
        }
    }
    if (vec_u16_lane0(b) != in[N] || vec_u16_any(vec_u16_xor(vec_u16_spread(b),
                                                             vec_u16_set(in[N])))) {
        printf("FAIL  vec_u16_lane0 or spread, %s\n", TEXT(RF_VEC_SET));
        return 1;
    }
    for (int i = 0; i <= N; i++) { /* one lane alone, then none */
        memset(in, 0, sizeof in);
        in[i] = 0xffff;
        if (vec_u16_bits(vec_u16_load(in)) !=
            (i == N ? 0 : ((UINT64_C(1) << VEC_BITS) - 1) << i * VEC_BITS)) {
            printf("FAIL  vec_u16_bits, %s: lane %d\n", TEXT(RF_VEC_SET), i);
            return 1;
        }
        in[i] = i % 2 ? 1 : 0x8000;
        if (!vec_u16_any(vec_u16_load(in)) != (i == N)) {
            printf("FAIL  vec_u16_any, %s: lane %d\n", TEXT(RF_VEC_SET), i);
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

/* Every pair of bytes, at odd addresses. */
static int check_bytes(void)
{
    enum { BYTES = 7 };
    static const char *const names[] = {"absdiff", "adds", "subs", "half", "lookup",
                                        "lookup_or_0", "apart", "wide"};
    const uint8_t codes[16] = {7, 255, 0, 128, 1, 2, 3, 4, 90, 91, 92, 93, 250, 251, 252, 253};
    uint8_t a[VEC_U8 + 1], out[BYTES][VEC_U8 + 1];
    uint16_t wide[VEC_U8 + 1];

    for (int pair = 0; pair < 65536; pair++) {
        const uint8_t y = (uint8_t)(pair >> 8);
        vec_u16 sum[2] = {vec_u16_set(0xff00), vec_u16_set(0xff00)};

        for (int i = 0; i < (int)VEC_U8; i++)
            a[1 + i] = (uint8_t)(pair + 37 * i);
        const vec_u8 v = vec_u8_load(a + 1), w = vec_u8_set(y);
        const vec_u8 result[BYTES] = {vec_u8_absdiff(v, w), vec_u8_adds(v, w), vec_u8_subs(v, w),
                                  vec_u8_half(v),
                                  vec_u8_lookup(vec_u8_table(codes),
                                                vec_u8_half(vec_u8_half(vec_u8_half(
                                                    vec_u8_half(v))))),
                                  vec_u8_lookup_or_0(vec_u8_table(codes), v),
                                  vec_u8_apart(vec_u8_half(v), vec_u8_half(w))};
        for (int k = 0; k < BYTES; k++)
            vec_u8_store(out[k], result[k]);
        vec_u8_add_wide(sum, v);
        vec_u8_store_wide(wide + 1, sum);
        for (int i = 0; i < (int)VEC_U8; i++) {
            const int x = a[1 + i];
            const int should[BYTES + 1] = {abs(x - y), x + y > 255 ? 255 : x + y,
                                           x > y ? x - y : 0, x / 2, codes[x / 16],
                                           x < 16 ? codes[x] : 0, abs(x / 2 - y / 2), 0xff00 + x};

            for (int k = 0; k <= BYTES; k++)
                if ((k < BYTES ? out[k][i] : wide[1 + i]) != should[k]) {
                    printf("FAIL  vec_u8_%s, %s: lane %d of %d, %d should be %d\n", names[k],
                           TEXT(RF_VEC_SET), i, x, y, should[k]);
                    return 1;
                }
        }
    }
    return 0;
}

/* What all bytes say together. */
static int check_together(void)
{
    uint32_t seed = 12;

    for (int round = 0; round < ROUNDS; round++) {
        uint8_t a[MOST_LANES], b[MOST_LANES], bytes[MOST_LANES], least = 255, most = 0;
        uint16_t mask[MOST_LANES];
        uint64_t at_most = 0;
        bool same = true;

        for (int i = 0; i < (int)VEC_U8; i++) {
            const uint32_t some = noise(&seed);

            a[i] = (uint8_t)(round % 2 ? some : 100 + some % 3);
            b[i] = (uint8_t)(round % 2 ? some >> 8 : 100 + (some >> 8) % 3);
            mask[i] = some >> 16 & 1 ? 0xffff : 0;
            least = a[i] < least ? a[i] : least;
            most = a[i] > most ? a[i] : most;
            at_most |= (uint64_t)(a[i] <= b[i]) << i;
        }
        const vec_u8 v = vec_u8_load(a);

        vec_u8_store(bytes,
                     vec_u8_of_masks(vec_u16_load(mask), vec_u16_load(mask + VEC_U16)));
        for (int i = 0; i < (int)VEC_U8; i++)
            same = same && bytes[i] == (uint8_t)mask[i];
        if (vec_u8_least(v) != least || vec_u8_most(v) != most || !same ||
            vec_u8_bits_at_most(v, vec_u8_load(b)) != at_most) {
            printf("FAIL  vec_u8_least, most, bits_at_most or of_masks, %s: round %d\n",
                   TEXT(RF_VEC_SET), round);
            return 1;
        }
    }
    return 0;
}

/* Operations on 16 elements. */
static int check_sixteen(void)
{
    uint32_t seed = 13;

    for (int round = 0; round < ROUNDS; round++) {
        uint16_t p[65], out[4];
        int16_t a[17], b[17], share[4][4];
        const uint16_t low = (uint16_t)noise(&seed), width = (uint16_t)(noise(&seed) >> round % 17);
        uint64_t within = 0;
        int32_t dot = 0;

        for (int i = 1; i <= 16; i++) { /* products as large as kernels have them */
            p[i] = round % 2 ? pick(round / 2, i, 0, &seed) : (uint16_t)(low + noise(&seed) % 999);
            a[i] = (int16_t)noise_between(&seed, -6912, 6912);
            b[i] = (int16_t)noise_between(&seed, -8191, 8191);
            dot += a[i] * b[i];
        }
        for (int i = 17; i <= 64; i++)
            p[i] = (uint16_t)(i % 3 ? low + noise(&seed) % 999 : noise(&seed));
        for (int i = 1; i <= 64; i++)
            within |= (uint64_t)((uint16_t)(p[i] - low) <= width) << (i - 1);
        if (vec_within16(p + 1, low, width) != (within & 65535) ||
            vec_within64(p + 1, low, width) != within ||
            vec_dot16(a + 1, b + 1) != dot) {
            printf("FAIL  vec_within16, within64 or dot16, %s: round %d\n",
                   TEXT(RF_VEC_SET), round);
            return 1;
        }
        const uint16_t *const from[4] = {p + 1, p + 4, p + 9, p + 13};
        const int16_t *const shares[4] = {share[0], share[1], share[2], share[3]};

        for (int i = 0; i < 4; i++) {
            const int some = noise_between(&seed, 1, 32767);

            for (int k = 0; k < 4; k++)
                share[i][k] = (int16_t)(k == i ? some : k == (i + round) % 4 ? 32768 - some : 0);
            share[i][i] = (int16_t)(round % 4 ? some : 32767);
            share[i][(i + 1) % 4] = (int16_t)(round % 4 ? share[i][(i + 1) % 4] : 1);
        }
        vec_dots4(out, from, shares);
        for (int i = 0; i < 4; i++) {
            int sum = 1 << 14;

            for (int k = 0; k < 4; k++)
                sum += (from[i][k] - 32768) * share[i][k];
            if (out[i] != (uint16_t)((sum >> 15) + 32768)) {
                printf("FAIL  vec_dots4, %s: round %d\n", TEXT(RF_VEC_SET), round);
                return 1;
            }
        }
    }
    return 0;
}

/* Lanes of four vectors by one share each. */
static int check_mix(void)
{
    uint32_t seed = 14;

    for (int round = 0; round < ROUNDS; round++) {
        uint16_t in[4][MOST_LANES], out[MOST_LANES];
        const int some = noise_between(&seed, 1, 32767), least = round / 4 % 3;
        int16_t share[4] = {0};

        share[round % 4] = (int16_t)(round % 5 ? some : 32767);
        share[(round + 1 + least) % 4] = (int16_t)(32768 - share[round % 4]);
        if (round % 3 == 0) {
            share[round % 4] = (int16_t)(share[round % 4] / 2);
            share[(round + 1 + (least + 1) % 3) % 4] =
                (int16_t)(32768 - share[round % 4] - share[(round + 1 + least) % 4]);
        }
        for (int k = 0; k < 4; k++)
            for (int i = 0; i < (int)VEC_U16; i++)
                in[k][i] = pick(round, i, k % 2, &seed);
        vec_u16_store(out,
                      vec_u16_mix4(vec_u16_load(in[0]), vec_u16_load(in[1]),
                                   vec_u16_load(in[2]), vec_u16_load(in[3]), share));
        for (int i = 0; i < (int)VEC_U16; i++) {
            int64_t sum = 1 << 14;

            for (int k = 0; k < 4; k++)
                sum += (int64_t)in[k][i] * share[k];
            if (out[i] != sum >> 15) {
                printf("FAIL  vec_u16_mix4, %s: round %d\n", TEXT(RF_VEC_SET), round);
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
                                     vec_u16_load(factor[2 - 2 * twice]),
                                     vec_u16_load(factor[1]));
        sum[0] = UINT32_MAX;
        vec_u32_add_to(sum, v);
        for (int lane = 0; lane < (int)VEC_U16; lane++) {
            const uint64_t should = (lane ? 0 : (uint64_t)UINT32_MAX) +
                                    (uint32_t)((3u * factor[0][lane] + factor[2][lane]) *
                                               (uint32_t)factor[1][lane]);

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
    int failures = check_set() + check_order() + check_add_to() + check_products() +
                   check_bytes() + check_together() + check_sixteen() + check_mix() +
                   check_from_bytes();

    for (int i = 0; i < count; i++)
        failures += check_operation(i);
    if (failures == 0)
        printf("ok    %-12s %-6s %d operations, %d lanes\n", "vec_u16",
               TEXT(RF_VEC_SET), count + 9, (int)VEC_U16);
    return failures;
}
