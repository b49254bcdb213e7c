/* cut.c: tells a cut of a video from movement and from a change of the exposure. */
#include <stdint.h>

#include "depth/temporal.h"
#include "support/compare.h"

enum {
    CELLS = 16,     /* at most, along a side */
    UNIT = 16,      /* one code of a mean */
    LEAST_STEP = 3, /* Codes: noise and a plain wall show nothing to compare. */
};

/* Means of the cells of a guide. */
struct cells {
    int across, down;
    int mean[CELLS][CELLS];
};

static int mean_of(const uint8_t *guide, int width, int x0, int x1, int y0, int y1)
{
    const int64_t count = (int64_t)(x1 - x0) * (y1 - y0);
    int64_t sum = 0;

    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++)
            sum += guide[(int64_t)y * width + x];
    return (int)((sum * UNIT + count / 2) / count);
}

static void fill(struct cells *cells, const uint8_t *guide, int width, int height)
{
    const int64_t w = width, h = height;
    const int m = cells->across = rf_smaller(width, CELLS);
    const int n = cells->down = rf_smaller(height, CELLS);

    for (int j = 0; j < n; j++)
        for (int i = 0; i < m; i++)
            cells->mean[j][i] = mean_of(guide, width, (int)(i * w / m), (int)((i + 1) * w / m),
                                        (int)(j * h / n), (int)((j + 1) * h / n));
}

/* Sums over the steps from each cell to its neighbours. */
struct steps {
    int64_t count, now, last, both; /* squares of either frame, and products of both */
};

static void add(struct steps *steps, int now, int last)
{
    steps->count++;
    steps->now += now * now;
    steps->last += last * last;
    steps->both += now * last;
}

bool rf_is_cut(const uint8_t *now, const uint8_t *last, int width, int height)
{
    struct cells a, b;
    struct steps steps = {0, 0, 0, 0};
    int64_t larger;

    fill(&a, now, width, height);
    fill(&b, last, width, height);
    for (int y = 0; y < a.down; y++)
        for (int x = 0; x < a.across; x++) {
            if (x > 0)
                add(&steps, a.mean[y][x] - a.mean[y][x - 1], b.mean[y][x] - b.mean[y][x - 1]);
            if (y > 0)
                add(&steps, a.mean[y][x] - a.mean[y - 1][x], b.mean[y][x] - b.mean[y - 1][x]);
        }
    larger = steps.now > steps.last ? steps.now : steps.last;
    return larger >= steps.count * (LEAST_STEP * UNIT) * (LEAST_STEP * UNIT) &&
           4 * steps.both < larger;
}
