/* blocks.h: memory of renderers that is kept, by its exact size: pages that are new take longer
 * than a small picture. */
#ifndef RF_FUZZ_BLOCKS_H
#define RF_FUZZ_BLOCKS_H

#include <refocus/refocus.h>

/* Blocks that are not in use may not be touched, under the address sanitizer. */
struct refocus_allocator keeping_allocator(void);

#endif
