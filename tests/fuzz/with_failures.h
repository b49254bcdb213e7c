/* with_failures.h: inputs run with every allocation failing once, as well. */
#ifndef RF_FUZZ_WITH_FAILURES_H
#define RF_FUZZ_WITH_FAILURES_H

#include <stddef.h>
#include <stdint.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Run it, then again with the first allocation failing, with the second one, and so on
 * up to the 30th. Aborts when one run leaves memory or descriptors behind. A search fails
 * allocations of one input in eight, which its bytes choose; replay.c those of all. */
void fuzz_run_failing(void (*run)(const uint8_t *data, size_t size), const uint8_t *data,
                      size_t size);

/* A file in memory: its descriptor, and its name. */
int fuzz_open(const uint8_t *data, size_t size, char name[64]);

#endif
