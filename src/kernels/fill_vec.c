/* fill_vec.c: push and pull of the background's pyramid. */
#include "kernels/kernels.h"
#include "simd/vec.h"

#define LANES ((int)VEC_U16)

/* Lanes where nothing is known, all bits. */
static inline vec_u16 unknown(vec_u16 blur)
{
    return vec_u16_at_most(vec_u16_xor(blur, vec_u16_set(0x8000)), vec_u16_set(0));
}

static inline vec_u16 invert(vec_u16 mask)
{
    return vec_u16_xor(mask, vec_u16_set(0xffff));
}

/* Which of four children are known, and how their sum becomes a mean. */
struct use {
    vec_u16 known[4];
    vec_u16 single; /* at most one */
    vec_u16 bias, factor;
};

/*
 * Half up, by the high half of a product, halved once more: the sum of four plus 2 times 2^15, of
 * three plus 1 times 43691 (a third), of two plus 2 times 65535, which takes 1 off it, and
 * one child twice, plus 1, times that.
 */
static inline struct use use_of(const vec_u16 blur[4])
{
    struct use use;
    vec_u16 first, last, either, odd, all;

    for (int i = 0; i < 4; i++)
        use.known[i] = invert(unknown(blur[i]));
    first = vec_u16_and(use.known[0], use.known[1]);
    last = vec_u16_and(use.known[2], use.known[3]);
    either =
        vec_u16_and(vec_u16_or(use.known[0], use.known[1]), vec_u16_or(use.known[2], use.known[3]));
    use.single = invert(vec_u16_or(vec_u16_or(first, last), either));
    odd = vec_u16_xor(vec_u16_xor(use.known[0], use.known[1]),
                      vec_u16_xor(use.known[2], use.known[3]));
    all = vec_u16_and(first, last);
    use.bias = vec_u16_add(vec_u16_set(2), odd);
    use.factor = vec_u16_sub(vec_u16_set(65535), vec_u16_and(all, vec_u16_set(32767)));
    use.factor =
        vec_u16_sub(use.factor, vec_u16_and(vec_u16_without(odd, use.single), vec_u16_set(21844)));
    return use;
}

/* The four children of a vector of parents: of the rows at a and b. */
static inline void children(vec_u16 child[4], const void *a, const void *b)
{
    const vec_u16 a0 = vec_u16_load(a), a1 = vec_u16_load((const char *)a + 2 * LANES);
    const vec_u16 b0 = vec_u16_load(b), b1 = vec_u16_load((const char *)b + 2 * LANES);

    child[0] = vec_u16_even(a0, a1);
    child[1] = vec_u16_odd(a0, a1);
    child[2] = vec_u16_even(b0, b1);
    child[3] = vec_u16_odd(b0, b1);
}

static inline void push_light(uint16_t *out, const uint16_t *upper, const uint16_t *lower,
                              const struct use *use)
{
    vec_u16 child[4], sum;

    children(child, upper, lower);
    sum = vec_u16_and(child[0], use->known[0]);
    for (int i = 1; i < 4; i++)
        sum = vec_u16_add(sum, vec_u16_and(child[i], use->known[i]));
    sum = vec_u16_add(sum, vec_u16_and(sum, use->single));
    vec_u16_store(out, vec_u16_half(vec_u16_mul_high(vec_u16_add(sum, use->bias), use->factor)));
}

static void RF_VEC(rf_push)(uint16_t *const out[3], int16_t *out_blur,
                            const uint16_t *const upper[3], const uint16_t *const lower[3],
                            const int16_t *blur0, const int16_t *blur1, int n)
{
    const vec_u16 sign = vec_u16_set(0x8000);
    int x = 0;

    for (; x + LANES <= n; x += LANES) {
        vec_u16 blur[4], farthest;
        struct use use;

        children(blur, blur0 + 2 * x, blur1 + 2 * x);
        use = use_of(blur);
        farthest = vec_u16_xor(blur[0], sign);
        for (int i = 1; i < 4; i++)
            farthest = vec_u16_max(farthest, vec_u16_xor(blur[i], sign));
        vec_u16_store(out_blur + x, vec_u16_xor(farthest, sign));
        for (int c = 0; c < 3; c++)
            push_light(out[c] + x, upper[c] + 2 * x, lower[c] + 2 * x, &use);
    }
    rf_push_c((uint16_t *const[3]){out[0] + x, out[1] + x, out[2] + x}, out_blur + x,
              (const uint16_t *const[3]){upper[0] + 2 * x, upper[1] + 2 * x, upper[2] + 2 * x},
              (const uint16_t *const[3]){lower[0] + 2 * x, lower[1] + 2 * x, lower[2] + 2 * x},
              blur0 + 2 * x, blur1 + 2 * x, n - x);
}

static inline vec_u16 quarters(vec_u16 three, vec_u16 one)
{
    const vec_u16 sum = vec_u16_add(vec_u16_add(three, three), vec_u16_add(three, one));

    return vec_u16_half(vec_u16_half(vec_u16_add(sum, vec_u16_set(2))));
}

/* Where lanes of `mask` are set, `to` becomes v. */
static inline void put_where(void *to, vec_u16 mask, vec_u16 v)
{
    vec_u16_store(to, vec_u16_or(vec_u16_and(v, mask), vec_u16_without(vec_u16_load(to), mask)));
}

static inline uint16_t quarters_of(unsigned three, unsigned one)
{
    return (uint16_t)((3 * three + one + 2) >> 2);
}

static void RF_VEC(rf_pull)(uint16_t *out, const int16_t *out_blur, const uint16_t *near_row,
                            const uint16_t *far_row, uint16_t *mixed, int pairs)
{
    int x = 0;

    mixed++; /* mixed[-1] and mixed[pairs] repeat the ends */
    for (; x + LANES <= pairs; x += LANES)
        vec_u16_store(mixed + x, quarters(vec_u16_load(near_row + x), vec_u16_load(far_row + x)));
    for (; x < pairs; x++)
        mixed[x] = quarters_of(near_row[x], far_row[x]);
    mixed[-1] = mixed[0];
    mixed[pairs] = mixed[pairs - 1];
    for (x = 0; x + LANES <= pairs; x += LANES) {
        const vec_u16 left = unknown(vec_u16_load(out_blur + 2 * x));
        const vec_u16 right = unknown(vec_u16_load(out_blur + 2 * x + LANES));
        vec_u16 middle, even, odd;

        if (!vec_u16_any(vec_u16_or(left, right)))
            continue;
        middle = vec_u16_load(mixed + x);
        even = quarters(middle, vec_u16_load(mixed + x - 1));
        odd = quarters(middle, vec_u16_load(mixed + x + 1));
        put_where(out + 2 * x, left, vec_u16_zip_low(even, odd));
        put_where(out + 2 * x + LANES, right, vec_u16_zip_high(even, odd));
    }
    for (; x < pairs; x++) {
        if (out_blur[2 * x] == RF_NO_BLUR)
            out[2 * x] = quarters_of(mixed[x], mixed[x - 1]);
        if (out_blur[2 * x + 1] == RF_NO_BLUR)
            out[2 * x + 1] = quarters_of(mixed[x], mixed[x + 1]);
    }
}

static void RF_VEC(rf_pull_blur)(int16_t *out, const int16_t *near_row, int pairs)
{
    int x = 0;

    for (; x + LANES <= pairs; x += LANES) {
        const vec_u16 left = unknown(vec_u16_load(out + 2 * x));
        const vec_u16 right = unknown(vec_u16_load(out + 2 * x + LANES));
        const vec_u16 near = vec_u16_load(near_row + x);

        if (!vec_u16_any(vec_u16_or(left, right)))
            continue;
        put_where(out + 2 * x, left, vec_u16_zip_low(near, near));
        put_where(out + 2 * x + LANES, right, vec_u16_zip_high(near, near));
    }
    rf_pull_blur_c(out + 2 * x, near_row + x, pairs - x);
}

void RF_VEC(rf_fill_use)(struct rf_kernels *kernels)
{
    kernels->push = RF_VEC(rf_push);
    kernels->pull = RF_VEC(rf_pull);
    kernels->pull_blur = RF_VEC(rf_pull_blur);
}
