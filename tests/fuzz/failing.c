/* The linker sends the allocations of what is tested here: --wrap. */
#define _GNU_SOURCE /* memfd_create */
#include "failing.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

enum { MOST_FAILURES = 30 };

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *memory, size_t size);
void __real_free(void *memory);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *memory, size_t size);
char *__wrap_strdup(const char *text);
void __wrap_free(void *memory);

static long calls, fail_at, live; /* fail_at: 0 = none */

static int refuse(void)
{
    if (++calls != fail_at)
        return 0;
    errno = ENOMEM;
    return 1;
}

void *__wrap_malloc(size_t size)
{
    void *const memory = refuse() ? NULL : __real_malloc(size);

    live += memory != NULL;
    return memory;
}

void *__wrap_calloc(size_t count, size_t size)
{
    void *const memory = refuse() ? NULL : __real_calloc(count, size);

    live += memory != NULL;
    return memory;
}

void *__wrap_realloc(void *memory, size_t size)
{
    void *const moved = refuse() ? NULL : __real_realloc(memory, size);

    live += !memory && moved;
    return moved;
}

char *__wrap_strdup(const char *text)
{
    const size_t size = strlen(text) + 1;
    char *const copy = __wrap_malloc(size);

    return copy ? memcpy(copy, text, size) : NULL;
}

void __wrap_free(void *memory)
{
    live -= memory != NULL;
    __real_free(memory);
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

void fuzz_run_failing(void (*run)(const uint8_t *data, size_t size),
                      const uint8_t *data, size_t size)
{
    const int descriptor = next_descriptor();
    long all = 0;

    for (fail_at = 0; fail_at <= all && fail_at <= MOST_FAILURES; fail_at++) {
        calls = live = 0;
        run(data, size);
        if (fail_at == 0)
            all = calls;
        if (live != 0 || next_descriptor() != descriptor) {
            fprintf(stderr,
                    "%ld allocations and %d descriptors are left, the %ld-th failed\n",
                    live, next_descriptor() - descriptor, fail_at);
            abort();
        }
    }
    fail_at = 0;
}
