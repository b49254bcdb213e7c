/* check_vec_across.c: operations of simd/vec.h that move lanes, or are of bytes or of groups of
 * elements. */
#include "check_vec.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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
                printf("FAIL  vec_u16_from_bytes, %s: round %d\n", TEXT(RF_VEC_SET), round);
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
    if (vec_u16_lane0(b) != in[N] ||
        vec_u16_any(vec_u16_xor(vec_u16_spread(b), vec_u16_set(in[N])))) {
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

/* Every pair of bytes, at odd addresses. */
static int check_bytes(void)
{
    enum { BYTES = 4 };
    static const char *const names[] = {"adds", "subs", "lookup_or_0", "apart", "wide"};
    const uint8_t codes[16] = {7, 255, 0, 128, 1, 2, 3, 4, 90, 91, 92, 93, 250, 251, 252, 253};
    uint8_t a[VEC_U8 + 1], half[VEC_U8], out[BYTES][VEC_U8 + 1];
    uint16_t wide[VEC_U8 + 1];

    for (int pair = 0; pair < 65536; pair++) {
        const uint8_t y = (uint8_t)(pair >> 8);
        vec_u16 sum[2] = {vec_u16_set(0xff00), vec_u16_set(0xff00)};

        for (int i = 0; i < (int)VEC_U8; i++)
            half[i] = (a[1 + i] = (uint8_t)(pair + 37 * i)) / 2;
        const vec_u8 v = vec_u8_load(a + 1), w = vec_u8_set(y);
        const vec_u8 result[BYTES] = {vec_u8_adds(v, w), vec_u8_subs(v, w),
                                      vec_u8_lookup_or_0(vec_u8_table(codes), v),
                                      vec_u8_apart(vec_u8_load(half), vec_u8_set(y / 2))};
        for (int k = 0; k < BYTES; k++)
            vec_u8_store(out[k], result[k]);
        vec_u8_add_wide(sum, v);
        vec_u8_store_wide(wide + 1, sum);
        for (int i = 0; i < (int)VEC_U8; i++) {
            const int x = a[1 + i];
            const int should[BYTES + 1] = {x + y > 255 ? 255 : x + y, x > y ? x - y : 0,
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

/* Checks the operations that ask something of all bytes together. */
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

        vec_u8_store(bytes, vec_u8_of_masks(vec_u16_load(mask), vec_u16_load(mask + VEC_U16)));
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
            vec_within64(p + 1, low, width) != within || vec_dot16(a + 1, b + 1) != dot) {
            printf("FAIL  vec_within16, within64 or dot16, %s: round %d\n", TEXT(RF_VEC_SET),
                   round);
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

/* Shares of any sign, whose magnitudes add up to less than 2^15. */
static int check_cubic(void)
{
    uint32_t seed = 31;

    for (int round = 0; round < ROUNDS; round++) {
        uint16_t in[4][VEC_U16], out[VEC_U16];
        int16_t share[4];
        int rest = 32767;

        for (int k = 0; k < 4; k++) {
            const int size = noise_between(&seed, 0, rest);

            share[k] = (int16_t)(noise(&seed) % 2 ? size : -size);
            rest -= size;
            for (int i = 0; i < (int)VEC_U16; i++)
                in[k][i] = pick(round, i, k % 2, &seed);
        }
        vec_u16_store(out, vec_u16_cubic4(vec_u16_load(in[0]), vec_u16_load(in[1]),
                                          vec_u16_load(in[2]), vec_u16_load(in[3]), share));
        for (int i = 0; i < (int)VEC_U16; i++) {
            int64_t sum = 1 << 13;

            for (int k = 0; k < 4; k++)
                sum += (int64_t)(in[k][i] - 32768) * share[k];
            sum = 32768 + (sum >> 14);
            sum = sum < 0 ? 0 : sum > 65535 ? 65535 : sum;
            if (out[i] != sum) {
                printf("FAIL  vec_u16_cubic4, %s: round %d\n", TEXT(RF_VEC_SET), round);
                return 1;
            }
        }
    }
    return 0;
}

int RF_VEC(check_vec_across)(void)
{
    return check_from_bytes() + check_order() + check_bytes() + check_together() + check_sixteen() +
           check_cubic();
}
