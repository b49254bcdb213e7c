/* with_failures.c: runs inputs with every allocation failing once, as well. */
#define _GNU_SOURCE /* memfd_create */
#include "with_failures.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "failing.h"

enum { MOST_FAILURES = 30 };

/* replay.c has one, a search has none. */
extern const char fuzz_replays __attribute__((weak));

static int is_chosen(const uint8_t *data, size_t size)
{
    uint32_t hash = 2166136261u; /* FNV-1a */

    for (size_t i = 0; i < size; i++)
        hash = (hash ^ data[i]) * 16777619u;
    return &fuzz_replays || (hash ^ hash >> 16) % 8 == 0;
}

int fuzz_open(const uint8_t *data, size_t size, char name[64])
{
    const int fd = memfd_create("fuzz", MFD_CLOEXEC);

    if (fd < 0 || write(fd, data, size) != (ssize_t)size) {
        perror("memfd_create");
        abort();
    }
    snprintf(name, 64, "/proc/self/fd/%d", fd);
    return fd;
}

/* The descriptor that would be next: it grows when one is left open. */
static int next_descriptor(void)
{
    const int fd = dup(STDERR_FILENO);

    close(fd);
    return fd;
}

void fuzz_run_failing(void (*run)(const uint8_t *data, size_t size), const uint8_t *data,
                      size_t size)
{
    const long most = is_chosen(data, size) ? MOST_FAILURES : 0;
    static int descriptor;
    long all = 0;

    if (!descriptor)
        descriptor = next_descriptor();
    for (long k = 0; k <= all && k <= most; k++) {
        failing.fail_at = k;
        failing.calls = failing.live = 0;
        run(data, size);
        if (k == 0)
            all = failing.calls;
        if (failing.live != 0 || next_descriptor() != descriptor) {
            fprintf(stderr, "%ld allocations and %d descriptors are left, the %ld-th failed\n",
                    failing.live, next_descriptor() - descriptor, k);
            abort();
        }
    }
    failing.fail_at = 0;
}
