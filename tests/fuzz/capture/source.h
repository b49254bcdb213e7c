/* source.h: plays a file that a source reads, for the targets that share it. */
#ifndef RF_FUZZ_SOURCE_H
#define RF_FUZZ_SOURCE_H

#include "backend.h"
#include "with_failures.h"

/* Open, start, take some frames and read every byte of them, restart, close. */
void fuzz_source(const char *name);

#endif
