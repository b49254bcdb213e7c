/* arena.h: one block of memory, handed out in aligned pieces.
 *
 * A layout runs twice: with base == NULL it only adds up the bytes, then, on a
 * block of that size, it sets the pointers. So size and use cannot disagree. Sizes are
 * 64-bit and saturate at UINT64_MAX, which no allocation can satisfy.
 */
#ifndef RF_ARENA_H
#define RF_ARENA_H

#include <stddef.h>
#include <stdint.h>

enum { RF_ARENA_ALIGN = 64 };

struct rf_arena {
    uint8_t *base; /* NULL: only count */
    uint64_t used;
};

/* Begins to hand out a block, from its first aligned byte on: a piece of RF_ARENA_ALIGN bytes less
 * one is lost at the most, with which the bytes of a layout begin. */
static inline void rf_arena_begin(struct rf_arena *arena, void *block)
{
    const size_t over = (uintptr_t)block % RF_ARENA_ALIGN;

    arena->base = (uint8_t *)block + (over ? RF_ARENA_ALIGN - over : 0);
    arena->used = 0;
}

/* Hands out `count` elements of `size` bytes; NULL while only counting, or if they are too many. */
static inline void *rf_arena_take(struct rf_arena *arena, uint64_t count, uint64_t size)
{
    const uint64_t at = arena->used;
    uint64_t bytes;

    if (__builtin_mul_overflow(count, size, &bytes) ||
        __builtin_add_overflow(bytes, RF_ARENA_ALIGN - 1, &bytes) ||
        __builtin_add_overflow(at, bytes & ~(uint64_t)(RF_ARENA_ALIGN - 1), &arena->used)) {
        arena->used = UINT64_MAX;
        return NULL;
    }
    return arena->base ? arena->base + at : NULL;
}

#endif
