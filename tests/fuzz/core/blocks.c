/* blocks.c: memory of renderers that is kept, by its exact size. */
#include "blocks.h"

#include <stdlib.h>
#include <string.h>

#ifdef __SANITIZE_ADDRESS__ /* gcc's; clang has a feature for it */
#include <sanitizer/asan_interface.h>
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#include <sanitizer/asan_interface.h>
#endif
#endif
#ifndef ASAN_POISON_MEMORY_REGION
#define ASAN_POISON_MEMORY_REGION(memory, size)   ((void)(memory), (void)(size))
#define ASAN_UNPOISON_MEMORY_REGION(memory, size) ((void)(memory), (void)(size))
#endif

enum { KEPT = 16 };

static struct block {
    void *memory;
    size_t size;
    int used;
} blocks[KEPT];
static int oldest;

static void *allocate(void *user, size_t size)
{
    struct block *block = NULL;

    (void)user;
    for (int i = 0; i < KEPT && !block; i++)
        if (blocks[i].memory && !blocks[i].used && blocks[i].size == size)
            block = &blocks[i];
    if (!block) {
        do
            block = &blocks[oldest++ % KEPT];
        while (block->used);
        free(block->memory);
        *block = (struct block){malloc(size), size, 0};
    }
    block->used = block->memory != NULL;
    if (block->used)
        ASAN_UNPOISON_MEMORY_REGION(block->memory, size);
    return block->memory;
}

static void release(void *user, void *memory)
{
    (void)user;
    for (int i = 0; i < KEPT; i++)
        if (blocks[i].memory == memory && memory) {
            blocks[i].used = 0;
            ASAN_POISON_MEMORY_REGION(memory, blocks[i].size);
            return;
        }
    abort();
}

struct refocus_allocator keeping_allocator(void)
{
    return (struct refocus_allocator){allocate, release, NULL};
}
