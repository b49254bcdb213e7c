/* push_vec.c: reduces a level of the inpainting pyramid to the next coarser one, a vector of
 * parents at a time. */
#include "kernels/kernels.h"
#include "kernels/push_planes.h"
#include "kernels/pyramid_vec.h"
#include "simd/vec.h"

static inline vec_u16 invert(vec_u16 mask)
{
    return vec_u16_xor(mask, vec_u16_set(0xffff));
}

/* The children that are known, of four, and how their sum becomes a mean. */
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
static inline struct use use_of(const vec_u16 blur[4], vec_u16 farthest, vec_u16 apart)
{
    struct use use;
    vec_u16 first, last, either, odd, all;

    for (int i = 0; i < 4; i++)
        use.known[i] = vec_u16_without(vec_u16_at_most(vec_u16_sub(farthest, blur[i]), apart),
                                       rf_unknown(blur[i]));
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

/* The four children of a vector of parents, from the rows at a and b. */
static inline void children(vec_u16 child[4], const void *a, const void *b)
{
    const vec_u16 a0 = vec_u16_load(a), a1 = vec_u16_load((const char *)a + 2 * (int)VEC_U16);
    const vec_u16 b0 = vec_u16_load(b), b1 = vec_u16_load((const char *)b + 2 * (int)VEC_U16);

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

void RF_VEC(rf_push)(uint16_t *const out[3], int16_t *out_blur, const uint16_t *const upper[3],
                     const uint16_t *const lower[3], const int16_t *blur0, const int16_t *blur1,
                     int16_t apart, int n)
{
    const vec_u16 sign = vec_u16_set(0x8000);
    int x = 0;

    for (; x + (int)VEC_U16 <= n; x += (int)VEC_U16) {
        vec_u16 blur[4], farthest;
        struct use use;

        children(blur, blur0 + 2 * x, blur1 + 2 * x);
        farthest = vec_u16_xor(blur[0], sign);
        for (int i = 1; i < 4; i++)
            farthest = vec_u16_max(farthest, vec_u16_xor(blur[i], sign));
        farthest = vec_u16_xor(farthest, sign);
        vec_u16_store(out_blur + x, vec_u16_without(farthest, vec_u16_set(RF_INPAINTED)));
        use = use_of(blur, farthest, vec_u16_set(rf_push_apart(apart)));
        for (int c = 0; c < 3; c++)
            push_light(out[c] + x, upper[c] + 2 * x, lower[c] + 2 * x, &use);
    }
    rf_push_c((uint16_t *const[3]){out[0] + x, out[1] + x, out[2] + x}, out_blur + x,
              (const uint16_t *const[3]){upper[0] + 2 * x, upper[1] + 2 * x, upper[2] + 2 * x},
              (const uint16_t *const[3]){lower[0] + 2 * x, lower[1] + 2 * x, lower[2] + 2 * x},
              blur0 + 2 * x, blur1 + 2 * x, apart, n - x);
}
