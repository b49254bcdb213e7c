/* check_windows.c: checks the kernels that find which blurs lie around a place, against their
 * contracts' words, one element at a time. */
#include "check.h"

#include <stdio.h>
#include <stdlib.h>

#include "guarded.h"

enum {
    MOST_BLUR = 127 * 256,
    MOST_CELLS = 150,
    MOST_BORDER = 33,
    MOST_WINDOWS = MOST_CELLS + 2 * MOST_BORDER,
};

/* A few of everything that is passed between guarded pages. */
struct stage {
    struct guarded blur, background, least[3], most[3], range, scratch;
};

static int blur_noise(uint32_t *seed, int kind)
{
    const int any = noise_between(seed, -MOST_BLUR, MOST_BLUR);

    return kind == 0 ? any : kind == 1 ? (any < 0 ? -MOST_BLUR : MOST_BLUR) : any / 64;
}

static int16_t *make_row(struct guarded *guarded, int n, enum place place, uint32_t *seed)
{
    int16_t *row = guarded_place(guarded, (size_t)n * 2, 2, place, noise(seed) % 17);
    const int kind = (int)(noise(seed) % 3);

    for (int i = 0; i < n; i++)
        row[i] = (int16_t)blur_noise(seed, kind);
    return row;
}

static bool fail(const struct subject *subject, const char *what, uint32_t seed, int n, int at,
                 long is, long should)
{
    printf("FAIL  %-12s %-6s seed %u, n = %d: element %d is %ld, should be %ld\n", what,
           subject->cpu, (unsigned)seed, n, at, is, should);
    return false;
}

static bool check_cells(const struct subject *subject, struct stage *s, int n, enum place place,
                        uint32_t seed)
{
    const uint32_t first = seed;
    const ptrdiff_t stride = RF_CELL * n + noise_between(&seed, 0, 5);
    const int16_t *blur = make_row(&s->blur, (int)(3 * stride) + RF_CELL * n, place, &seed);
    int16_t *least = make_row(&s->least[0], n, place, &seed);
    int16_t *most = make_row(&s->most[0], n, place, &seed);

    subject->kernels.cells(least, most, blur, stride, n);
    for (int x = 0; x < n; x++) {
        int low = INT16_MAX, high = INT16_MIN;

        for (int i = 0; i < RF_CELL * RF_CELL; i++) {
            const int v = blur[i / RF_CELL * stride + x * RF_CELL + i % RF_CELL];

            low = v < low ? v : low;
            high = v > high ? v : high;
        }
        if (least[x] != low)
            return fail(subject, "cells", first, n, x, least[x], low);
        if (most[x] != high)
            return fail(subject, "cells", first, n, x, most[x], high);
    }
    return guarded_intact(&s->least[0]) && guarded_intact(&s->most[0]);
}

static int inside(int x, int n)
{
    return x < 0 ? 0 : x >= n ? n - 1 : x;
}

static bool check_ranges(const struct subject *subject, struct stage *s, int n, enum place place,
                         uint32_t seed)
{
    const uint32_t first = seed;
    const int border = noise_between(&seed, 0, MOST_BORDER), windows = n + 2 * border;
    const int16_t *least[RF_WINDOW_Y], *most[RF_WINDOW_Y];
    uint32_t *range = guarded_place(&s->range, (size_t)windows * 4, 4, place, 3);
    int16_t *scratch = make_row(&s->scratch, 2 * (windows + RF_WINDOW_X - 1), place, &seed);

    for (int j = 0; j < RF_WINDOW_Y; j++) {
        least[j] = make_row(&s->least[j], n, place, &seed);
        most[j] = make_row(&s->most[j], n, place, &seed);
    }
    subject->kernels.windows(range, least, most, scratch, n, border);
    for (int x = 0; x < windows; x++) {
        int low = INT16_MAX, high = INT16_MIN;

        for (int i = 0; i < RF_WINDOW_X * RF_WINDOW_Y; i++) {
            const int j = i / RF_WINDOW_X, at = inside(x - border + i % RF_WINDOW_X, n);

            low = least[j][at] < low ? least[j][at] : low;
            high = most[j][at] > high ? most[j][at] : high;
        }
        high += high & 1;
        if (range[x] != ((uint32_t)(low & 0xffff) | (uint32_t)high << 16))
            return fail(subject, "windows", first, n, x, (long)range[x], low);
    }
    return guarded_intact(&s->range) && guarded_intact(&s->scratch);
}

static bool check_foreground(const struct subject *subject, struct stage *s, int n,
                             enum place place, uint32_t seed)
{
    const uint32_t first = seed;
    const ptrdiff_t stride = RF_CELL * n + noise_between(&seed, 0, 5);
    const int size = (int)(3 * stride) + RF_CELL * n, often = noise_between(&seed, 1, 20);
    const int16_t *blur = make_row(&s->blur, size, place, &seed);
    int16_t *background = make_row(&s->background, size, place, &seed);
    int16_t *most = make_row(&s->most[0], n, place, &seed);

    for (int i = 0; i < size; i++)
        background[i] = noise(&seed) % (uint32_t)often
                            ? (int16_t)(blur[i] ^ (int)(noise(&seed) & RF_INPAINTED))
                            : background[i];
    subject->kernels.foreground(most, blur, background, stride, n);
    for (int x = 0; x < n; x++) {
        int high = RF_NO_BLUR;

        for (int i = 0; i < RF_CELL * RF_CELL; i++) {
            const ptrdiff_t at = i / RF_CELL * stride + x * RF_CELL + i % RF_CELL;

            high = (blur[at] | RF_INPAINTED) != (background[at] | RF_INPAINTED) && blur[at] > high
                       ? blur[at]
                       : high;
        }
        if (most[x] != high)
            return fail(subject, "foreground", first, n, x, most[x], high);
    }
    return guarded_intact(&s->most[0]);
}

/* 5/32 of a blur less a pixel, 5/4 of one at least. */
static int depth_of(int blur)
{
    const int depth = abs(blur) / 8 + abs(blur) / 32 - 256;

    return depth < 320 ? 320 : depth;
}

static bool check_bare(const struct subject *subject, struct stage *s, int n, enum place place,
                       uint32_t seed)
{
    const uint32_t first = seed;
    const int border = noise_between(&seed, 0, MOST_BORDER), windows = n + 2 * border;
    const int16_t *cell[RF_WINDOW_Y];
    uint32_t *range = guarded_place(&s->range, (size_t)windows * 4, 4, place, 3);
    int16_t *scratch = make_row(&s->scratch, windows + RF_WINDOW_X - 1, place, &seed);
    uint32_t before[MOST_WINDOWS];

    for (int j = 0; j < RF_WINDOW_Y; j++)
        cell[j] = make_row(&s->most[j], n, place, &seed);
    for (int x = 0; x < windows; x++)
        before[x] = range[x] = (uint32_t)(noise_between(&seed, -MOST_BLUR, MOST_BLUR) * 65536) |
                               (noise(&seed) & 0xffff);
    subject->kernels.mark_in_background(range, cell, scratch, n, border);
    for (int x = 0; x < windows; x++) {
        const int most = (int16_t)(before[x] >> 16 & 0xfffe);
        int high = RF_NO_BLUR;
        uint32_t should;

        for (int i = 0; i < RF_WINDOW_X * RF_WINDOW_Y; i++) {
            const int v = cell[i / RF_WINDOW_X][inside(x - border + i % RF_WINDOW_X, n)];

            high = v > high ? v : high;
        }
        should = (before[x] & ~(uint32_t)RF_IN_BACKGROUND) |
                 (high < most - depth_of(most) ? RF_IN_BACKGROUND : 0);
        if (range[x] != should)
            return fail(subject, "mark_in_background", first, n, x, (long)range[x], (long)should);
    }
    return guarded_intact(&s->range) && guarded_intact(&s->scratch);
}

int check_windows(const struct subject *subject)
{
    struct stage s;
    uint32_t seed = 1;
    bool good = guarded_create(&s.blur, 4 * RF_CELL * (MOST_CELLS + 2) * 2) &&
                guarded_create(&s.background, 4 * RF_CELL * (MOST_CELLS + 2) * 2) &&
                guarded_create(&s.range, MOST_WINDOWS * 4) &&
                guarded_create(&s.scratch, 2 * (MOST_WINDOWS + RF_WINDOW_X) * 2);

    for (int j = 0; j < RF_WINDOW_Y; j++)
        good = good && guarded_create(&s.least[j], MOST_CELLS * 2) &&
               guarded_create(&s.most[j], MOST_CELLS * 2);
    if (!good) {
        printf("FAIL  no memory between pages\n");
        return 1;
    }
    for (; good && seed <= 600; seed++) {
        const enum place place = (enum place)(seed % PLACES);
        const int n = 1 + (int)seed % MOST_CELLS;

        good = check_cells(subject, &s, n, place, seed) &&
               check_ranges(subject, &s, n, place, seed) &&
               check_foreground(subject, &s, n, place, seed) &&
               check_bare(subject, &s, n, place, seed);
    }
    guarded_destroy(&s.blur);
    guarded_destroy(&s.background);
    guarded_destroy(&s.range);
    guarded_destroy(&s.scratch);
    for (int j = 0; j < RF_WINDOW_Y; j++) {
        guarded_destroy(&s.least[j]);
        guarded_destroy(&s.most[j]);
    }
    if (good)
        printf("ok    %-12s %-6s %d cases\n", "windows", subject->cpu, (int)seed - 1);
    return !good;
}
