/* speckle.c: marks small patches of wrong depth as unknown. */
#include "depth/speckle.h"

#include <stdbool.h>
#include <stdlib.h>

#include "depth/holes.h"

enum { STEP = 65535 / 24, MOST = 255 /* samples: larger patches are not told apart */ };

/* Patches as trees in `parent`: a root holds ROOT and the size of its patch, capped; what is no
 * root holds the index of another sample of its patch. */
#define ROOT UINT64_C(0x80000000)

struct patches {
    const uint16_t *disparity;
    ptrdiff_t stride;
    int width, height;
    const uint8_t *state;
    uint32_t *parent;
};

static uint32_t find(uint32_t *parent, uint32_t i)
{
    while (!(parent[i] & ROOT)) {
        const uint32_t up = parent[i];

        if (!(parent[up] & ROOT))
            parent[i] = parent[up]; /* halve the way for the next one */
        i = up;
    }
    return i;
}

static void join(uint32_t *parent, uint32_t a, uint32_t b)
{
    uint32_t size;

    a = find(parent, a);
    b = find(parent, b);
    if (a == b)
        return;
    size = (uint32_t)((parent[a] & ~ROOT) + (parent[b] & ~ROOT));
    if ((parent[a] & ~ROOT) < (parent[b] & ~ROOT)) {
        const uint32_t t = a;

        a = b;
        b = t;
    }
    parent[a] = (uint32_t)(ROOT | (size > MOST ? MOST : size));
    parent[b] = a;
}

static void visit(const struct patches *p, int x, int y)
{
    static const int step[4][2] = {{-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
    const uint32_t at = (uint32_t)y * (uint32_t)p->width + (uint32_t)x;
    const uint16_t d = ((const uint16_t *)((const char *)p->disparity + y * p->stride))[x];

    for (int i = 0; i < 4; i++) {
        const int nx = x + step[i][0], ny = y + step[i][1];

        if (nx < 0 || ny < 0 || nx >= p->width)
            continue;
        const uint32_t other = (uint32_t)ny * (uint32_t)p->width + (uint32_t)nx;
        const uint16_t near_by =
            ((const uint16_t *)((const char *)p->disparity + ny * p->stride))[nx];

        if (p->state[other] == RF_SAMPLE_KNOWN && abs(near_by - d) <= STEP)
            join(p->parent, at, other);
    }
}

uint64_t rf_remove_specks(const uint16_t *disparity, ptrdiff_t stride, int width, int height,
                          int least, uint8_t *state, uint32_t *work)
{
    const struct patches patches = {disparity, stride, width, height, state, work};
    const uint32_t samples = (uint32_t)width * (uint32_t)height;
    uint64_t removed = 0;

    for (uint32_t i = 0; i < samples; i++)
        work[i] = (uint32_t)(ROOT | 1);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            if (state[(size_t)y * (size_t)width + (size_t)x] == RF_SAMPLE_KNOWN)
                visit(&patches, x, y);
    for (uint32_t i = 0; i < samples; i++) {
        if (state[i] == RF_SAMPLE_KNOWN && (int)(work[find(work, i)] & ~ROOT) < least) {
            state[i] = RF_SAMPLE_UNKNOWN;
            removed++;
        }
    }
    return removed;
}
