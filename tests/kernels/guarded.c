/* guarded.c: maps rows of memory between unreadable pages, and checks their canaries. */
#include "guarded.h"

#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

enum { CANARIES = 128, CANARY = 0xa5 };

static size_t page_size(void)
{
    return (size_t)sysconf(_SC_PAGESIZE);
}

bool guarded_create(struct guarded *g, size_t bytes)
{
    const size_t page = page_size();
    uint8_t *map;

    g->room = (bytes + 2 * CANARIES + page - 1) / page * page;
    map =
        mmap(NULL, g->room + 2 * page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (map == MAP_FAILED)
        return false;
    g->first = map + page;
    return mprotect(map, page, PROT_NONE) == 0 &&
           mprotect(g->first + g->room, page, PROT_NONE) == 0;
}

void guarded_destroy(struct guarded *g)
{
    munmap(g->first - page_size(), g->room + 2 * page_size());
}

/* The canaries before and after the row. */
static uint8_t *before(const struct guarded *g, size_t *count)
{
    const size_t space = (size_t)(g->row - g->first);

    *count = space < CANARIES ? space : CANARIES;
    return g->row - *count;
}

static uint8_t *after(const struct guarded *g, size_t *count)
{
    const size_t space = g->room - (size_t)(g->row - g->first) - g->bytes;

    *count = space < CANARIES ? space : CANARIES;
    return g->row + g->bytes;
}

void *guarded_place(struct guarded *g, size_t bytes, size_t size, enum place place, unsigned shift)
{
    size_t count;
    uint8_t *canary;

    g->bytes = bytes;
    g->row = g->first;
    if (place == AT_END)
        g->row += g->room - bytes;
    if (place == INSIDE)
        g->row += CANARIES / 2 + shift * size;
    canary = before(g, &count);
    memset(canary, CANARY, count);
    canary = after(g, &count);
    memset(canary, CANARY, count);
    return g->row;
}

static bool alive(const uint8_t *canary, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (canary[i] != CANARY)
            return false;
    return true;
}

bool guarded_intact(const struct guarded *g)
{
    size_t count;
    const uint8_t *canary = before(g, &count);

    if (!alive(canary, count))
        return false;
    canary = after(g, &count);
    return alive(canary, count);
}
