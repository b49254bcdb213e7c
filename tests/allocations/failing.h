/* Allocations that are counted and can fail, for programs linked with --wrap of malloc,
 * calloc, realloc and free, and of strdup if wanted. */
#ifndef ALLOCATIONS_FAILING_H
#define ALLOCATIONS_FAILING_H

#include <stddef.h>

/* Set and read between calls into what is tested, which may allocate from several
 * threads. */
extern struct failing {
    long calls;        /* calls that asked for memory */
    long fail_at;      /* the one of them that gets none, from 1 on; 0 = none */
    long live;         /* blocks not freed yet */
    size_t held, peak; /* bytes in them, now and at the most */
} failing;

/* For memory that a library of the system took. */
void __real_free(void *memory);

#endif
