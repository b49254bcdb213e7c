/* block_motion.c: finds where each block of a depth map was in the frame before. */
#include "depth/temporal.h"
#include "support/compare.h"

#include <stdbool.h>
#include <stdlib.h>

enum {
    MOST_STEPS = 8,
    MOST_APART = 40, /* disparities, in 1/256 of the range: a hole is not a movement */
    STANDING = 48,   /* a movement has to be better by so much */
};

struct block {
    const struct rf_frame *now, *last;
    int width, height;
    int x, y, columns, rows;
};

static int cost(const struct block *b, struct rf_motion v)
{
    int sum = v.x || v.y ? STANDING : 0;

    for (int y = b->y; y < b->y + b->rows; y++) {
        const long here = (long)y * b->width;
        const long there = (long)rf_clamp(y + v.y, 0, b->height - 1) * b->width;

        for (int x = b->x; x < b->x + b->columns; x++) {
            const long p = here + x, q = there + rf_clamp(x + v.x, 0, b->width - 1);
            const int apart = abs(b->now->disparity[p] - b->last->disparity[q]) >> 8;

            sum += abs(b->now->guide[p] - b->last->guide[q]) +
                   (apart < MOST_APART ? apart : MOST_APART);
        }
    }
    return sum;
}

static bool try(const struct block *b, struct rf_motion v, struct rf_motion *best, int *least)
{
    int c;

    if (abs(v.x) > RF_MOST_MOTION || abs(v.y) > RF_MOST_MOTION)
        return false;
    c = cost(b, v);
    if (c >= *least)
        return false;
    *least = c;
    *best = v;
    return true;
}

static struct rf_motion follow(const struct block *b, const struct rf_motion *candidate, int n)
{
    static const struct rf_motion step[8] = {{2, 0}, {-2, 0}, {0, 2}, {0, -2},
                                             {1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    struct rf_motion best = {0, 0};
    int least = cost(b, best);

    for (int i = 0; i < n; i++)
        if (candidate[i].x || candidate[i].y)
            try(b, candidate[i], &best, &least);
    for (int i = 0; i < MOST_STEPS && least > 0; i++) {
        const struct rf_motion from = best;
        bool better = false;

        for (int k = 0; k < 8; k++)
            better |= try(
                b, (struct rf_motion){(int8_t)(from.x + step[k].x), (int8_t)(from.y + step[k].y)},
                &best, &least);
        if (!better)
            break;
    }
    return best;
}

void rf_find_motion(struct rf_motion *motion, const struct rf_frame *now,
                    const struct rf_frame *last, int width, int height, struct rf_run *run)
{
    const int columns = (width + RF_BLOCK - 1) / RF_BLOCK;

    for (int y = 0; y < height && !rf_run_cancelled(run); y += RF_BLOCK) {
        struct rf_motion *row = motion + (long)(y / RF_BLOCK) * columns;

        for (int i = 0; i < columns; i++) {
            const int x = i * RF_BLOCK;
            const struct block block = {now,
                                        last,
                                        width,
                                        height,
                                        x,
                                        y,
                                        width - x < RF_BLOCK ? width - x : RF_BLOCK,
                                        height - y < RF_BLOCK ? height - y : RF_BLOCK};
            struct rf_motion candidate[4];
            int n = 0;

            candidate[n++] = row[i];
            if (i > 0)
                candidate[n++] = row[i - 1];
            if (y > 0)
                candidate[n++] = row[i - columns];
            if (y > 0 && i + 1 < columns)
                candidate[n++] = row[i - columns + 1];
            row[i] = follow(&block, candidate, n);
        }
    }
}
