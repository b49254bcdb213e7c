/* memory.h: how much memory there is for this command. */
#ifndef RF_CLI_MEMORY_H
#define RF_CLI_MEMORY_H

#include <stdint.h>

/* KiB that can be had without taking them from other programs, at most what the process's group of
 * control (cgroup v2) may take; where Linux does not tell, half of the machine's. */
int64_t memory_free_kib(void);

#endif
