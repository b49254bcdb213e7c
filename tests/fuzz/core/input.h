/* input.h: numbers of an input of fuzz_core. */
#ifndef RF_FUZZ_INPUT_H
#define RF_FUZZ_INPUT_H

#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Rest of the input; it reads as 0 for ever after its end. */
struct input {
    const uint8_t *data;
    size_t size;
};

static inline uint32_t take(struct input *in, int bytes)
{
    uint32_t value = 0;

    while (bytes-- > 0 && in->size > 0) {
        value = value << 8 | *in->data++;
        in->size--;
    }
    return value;
}

static inline float take_float(struct input *in)
{
    const uint32_t bits = take(in, 4);
    float value;

    memcpy(&value, &bits, sizeof value);
    return value;
}

/* A value in its range mostly; of all 32 bits when `wild`. */
static inline int32_t take_in(struct input *in, int wild, int32_t low, int32_t high)
{
    if (wild)
        return (int32_t)take(in, 4);
    return low + (int32_t)(take(in, 2) % (uint32_t)(high - low + 1));
}

static inline float take_fraction(struct input *in, int wild, float high)
{
    return wild ? take_float(in) : high * (float)take(in, 2) / 65535;
}

/* Not one of the documented ones: end the program, that is what a fuzzer looks for. */
static inline void check(int condition)
{
    if (!condition)
        abort();
}

#endif
