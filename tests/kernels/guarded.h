/* guarded.h: rows of memory between unreadable pages, with canaries on the sides that have room. */
#ifndef KERNELS_GUARDED_H
#define KERNELS_GUARDED_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Where in its pages a row lies: at their start, at their end, or inside, unaligned. */
enum place { AT_START, AT_END, INSIDE, PLACES };

struct guarded {
    uint8_t *first; /* readable bytes between the pages that are not */
    size_t room;
    uint8_t *row;
    size_t bytes;
};

/* Memory for rows of up to `bytes` bytes; false: there is none. */
bool guarded_create(struct guarded *g, size_t bytes);
void guarded_destroy(struct guarded *g);

/* A row of `bytes` bytes, of elements of `size` bytes, with new canaries around it. `shift`
 * elements are left out before a row that is INSIDE. */
void *guarded_place(struct guarded *g, size_t bytes, size_t size, enum place place, unsigned shift);

/* Whether the canaries live. */
bool guarded_intact(const struct guarded *g);

#endif
