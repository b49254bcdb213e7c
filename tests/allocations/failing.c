#include "failing.h"

#include <errno.h>
#include <malloc.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *memory, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *memory, size_t size);
char *__wrap_strdup(const char *text);
void __wrap_free(void *memory);

struct failing failing;
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

static int refuse(void)
{
    int refused;

    pthread_mutex_lock(&lock);
    refused = ++failing.calls == failing.fail_at;
    pthread_mutex_unlock(&lock);
    if (refused)
        errno = ENOMEM;
    return refused;
}

/* A block came, or (bytes that it had) went. */
static void count(const void *memory, long blocks, size_t came, size_t went)
{
    if (!memory)
        return;
    pthread_mutex_lock(&lock);
    failing.live += blocks;
    failing.held += came;
    failing.peak = failing.held > failing.peak ? failing.held : failing.peak;
    failing.held -= went;
    pthread_mutex_unlock(&lock);
}

void *__wrap_malloc(size_t size)
{
    void *const memory = refuse() ? NULL : __real_malloc(size);

    count(memory, 1, memory ? malloc_usable_size(memory) : 0, 0);
    return memory;
}

void *__wrap_calloc(size_t n, size_t size)
{
    void *const memory = refuse() ? NULL : __real_calloc(n, size);

    count(memory, 1, memory ? malloc_usable_size(memory) : 0, 0);
    return memory;
}

void *__wrap_realloc(void *memory, size_t size)
{
    const size_t before = memory ? malloc_usable_size(memory) : 0;
    void *const moved = refuse() ? NULL : __real_realloc(memory, size);

    /* both exist for a moment */
    count(moved, !memory, moved ? malloc_usable_size(moved) : 0, before);
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
    count(memory, -1, 0, memory ? malloc_usable_size(memory) : 0);
    __real_free(memory);
}
