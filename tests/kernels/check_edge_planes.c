/* check_edge_planes.c: checks the kernels that make planes of a disparity map and its photo to find
 * edges by, against their contracts' words, one element at a time. */
#include "check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "guarded.h"

enum {
    MOST = 150, /* elements of a row */
    ROUNDS = 3000,
    GREATEST_ROWS = 11,
    STRIDE = 21,
    CELL = (RF_CLIMB_CELL + 2) * STRIDE,
    BUFFERS = GREATEST_ROWS + 1,
};

/* Rows between guarded pages, and where they lie this time. */
struct stage {
    struct guarded buffer[BUFFERS];
    enum place place;
    uint32_t seed;
};

/* Extremes, then a few values near each other, then any. */
static uint32_t element(struct stage *s, uint32_t kind, uint32_t most)
{
    const uint32_t any = noise(&s->seed);

    switch (kind % 4) {
    case 0:
        return most;
    case 1:
        return any & 1 ? most : 0;
    case 2:
        return most / 2 + any % 64;
    default:
        return any % (most + 1);
    }
}

static void *row_of(struct stage *s, int buffer, int n, size_t size)
{
    return guarded_place(&s->buffer[buffer], (size_t)n * size, size, s->place,
                         noise(&s->seed) % 17);
}

static uint16_t *words(struct stage *s, int buffer, int n, uint32_t kind, uint32_t most)
{
    uint16_t *row = row_of(s, buffer, n, sizeof *row);

    for (int i = 0; i < n; i++)
        row[i] = (uint16_t)element(s, kind, most);
    return row;
}

static bool intact(const struct stage *s, int buffers)
{
    for (int i = 0; i < buffers; i++)
        if (!guarded_intact(&s->buffer[i]))
            return false;
    return true;
}

/* ----- three rows to one ----- */

static int binomial(int before, int own, int after)
{
    return before + 2 * own + after;
}

static bool check_binomial8(const struct subject *subject, struct stage *s, uint32_t round)
{
    const int n = (int)(round % MOST);
    const uint8_t *row[3];
    uint16_t *out = words(s, 3, n, 3, 65535);

    for (int k = 0; k < 3; k++) {
        uint8_t *codes = row_of(s, k, n + 2, 1);

        for (int i = 0; i < n + 2; i++)
            codes[i] = (uint8_t)element(s, round, 255);
        row[k] = codes + 1;
    }
    subject->kernels.binomial8(out, row, n);
    for (int x = 0; x < n; x++) {
        int sum[3];

        for (int k = 0; k < 3; k++)
            sum[k] = binomial(row[k][x - 1], row[k][x], row[k][x + 1]);
        if (out[x] != binomial(sum[0], sum[1], sum[2]))
            return false;
    }
    return intact(s, 4);
}

static bool check_binomial16(const struct subject *subject, struct stage *s, uint32_t round)
{
    const int n = (int)(round % MOST);
    const uint16_t *row[3];
    uint16_t *out = words(s, 3, n, 3, 65535);

    for (int k = 0; k < 3; k++)
        row[k] = words(s, k, n + 2, round, 65535) + 1;
    subject->kernels.binomial16(out, row, n);
    for (int x = 0; x < n; x++) {
        int sum[3];

        for (int k = 0; k < 3; k++)
            sum[k] = binomial(row[k][x - 1], row[k][x], row[k][x + 1]);
        if (out[x] != binomial(sum[0], sum[1], sum[2]) / 16)
            return false;
    }
    return intact(s, 4);
}

static void sobel(const uint16_t *const row[3], int x, int *right, int *down)
{
    *right = binomial(row[0][x + 1], row[1][x + 1], row[2][x + 1]) -
             binomial(row[0][x - 1], row[1][x - 1], row[2][x - 1]);
    *down = binomial(row[2][x - 1], row[2][x], row[2][x + 1]) -
            binomial(row[0][x - 1], row[0][x], row[0][x + 1]);
}

static bool check_photo_gradient(const struct subject *subject, struct stage *s, uint32_t round)
{
    const int n = (int)(round % MOST);
    const uint16_t *row[3];
    int16_t was[2][MOST], *out[2];

    for (int k = 0; k < 3; k++)
        row[k] = words(s, k, n + 2, round, 16 * 255) + 1;
    for (int i = 0; i < 2; i++) {
        out[i] = row_of(s, 3 + i, n, sizeof *out[i]);
        for (int x = 0; x < n; x++)
            was[i][x] = out[i][x] = (int16_t)noise_between(&s->seed, -900, 900);
    }
    for (int x = 0; x < n; x += 4) { /* as long, the other way */
        int right, down;

        sobel(row, x, &right, &down);
        was[0][x] = out[0][x] = (int16_t)(-right / 8);
        was[1][x] = out[1][x] = (int16_t)(-down / 8);
    }
    subject->kernels.photo_gradient(out[0], out[1], row, n);
    for (int x = 0; x < n; x++) {
        int right, down;
        bool longer;

        sobel(row, x, &right, &down);
        right /= 8;
        down /= 8;
        longer = right * right + down * down > was[0][x] * was[0][x] + was[1][x] * was[1][x];
        if (out[0][x] != (longer ? right : was[0][x]) || out[1][x] != (longer ? down : was[1][x]))
            return false;
    }
    return intact(s, 5);
}

static bool check_map_slope(const struct subject *subject, struct stage *s, uint32_t round)
{
    const int n = (int)(round % MOST);
    const uint16_t *row[3];
    uint16_t *out = words(s, 3, n, 3, 65535);

    for (int k = 0; k < 3; k++)
        row[k] = words(s, k, n + 2, round, 65535) + 1;
    subject->kernels.map_slope(out, row, n);
    for (int x = 0; x < n; x++) {
        int right, down;
        volatile float across, along; /* each operation is rounded */

        sobel(row, x, &right, &down);
        across = (float)right;
        along = (float)down;
        across = across * across;
        along = along * along;
        across = across + along;
        if (out[x] != (uint16_t)(sqrtf(across) / 8) || fabs(out[x] - hypot(right, down) / 8) > 1.01)
            return false;
    }
    return intact(s, 4);
}

/* ----- blocks ----- */

static bool check_block_ranges(const struct subject *subject, struct stage *s, uint32_t round)
{
    const int width = 1 + (int)(round % (MOST / RF_EDGE_BLOCK)), rows = 1 + (int)(round % 8);
    const int gap = (int)(round % 3), blocks = (width + RF_EDGE_BLOCK - 1) / RF_EDGE_BLOCK;
    const int stride = width + gap;
    const uint16_t *plane = words(s, 0, (rows - 1) * stride + width, round, 65535);
    struct rf_edge_range *range = row_of(s, 1, blocks * 2, sizeof(uint16_t));

    subject->kernels.block_ranges(range, plane, stride, width, rows);
    for (int b = 0; b < blocks; b++) {
        int least = 65535, most = 0;

        for (int y = 0; y < rows; y++)
            for (int x = b * RF_EDGE_BLOCK; x < width && x < (b + 1) * RF_EDGE_BLOCK; x++) {
                const int d = plane[y * stride + x];

                least = d < least ? d : least;
                most = d > most ? d : most;
            }
        if (range[b].least != least || range[b].most != most)
            return false;
    }
    return intact(s, 2);
}

static bool check_greatest(const struct subject *subject, struct stage *s, uint32_t round)
{
    const int n = (int)(round % MOST), rows = 1 + (int)(round / 7 % GREATEST_ROWS);
    const uint16_t *row[GREATEST_ROWS];
    uint16_t *out = words(s, GREATEST_ROWS, n, 3, 65535);

    for (int k = 0; k < rows; k++)
        row[k] = words(s, k, n, round, 65535);
    subject->kernels.greatest(out, row, rows, n);
    for (int x = 0; x < n; x++) {
        uint16_t most = 0;

        for (int k = 0; k < rows; k++)
            most = row[k][x] > most ? row[k][x] : most;
        if (out[x] != most)
            return false;
    }
    return guarded_intact(&s->buffer[GREATEST_ROWS]);
}

/* ----- windows ----- */

static bool check_edge_support(const struct subject *subject, struct stage *s, uint32_t round)
{
    const int columns = round % 2 ? 8 : 12, rows = (int)(round / 2 % 12);
    const int stride = columns + (int)(round % 5), n = rows ? (rows - 1) * stride + columns : 0;
    int16_t *gradient[2];
    int32_t was[12 * 12], *sum = row_of(s, 2, rows * columns, sizeof *sum);
    struct rf_edge_window w = {.stride = stride,
                               .rows = rows,
                               .columns = columns,
                               .normal_x = noise_between(&s->seed, -127, 127),
                               .normal_y = noise_between(&s->seed, -127, 127)};

    for (int i = 0; i < 2; i++) {
        const int most = round % 3 ? 700 : 2040;

        gradient[i] = row_of(s, i, n, sizeof *gradient[i]);
        for (int x = 0; x < n; x++)
            gradient[i][x] = (int16_t)noise_between(&s->seed, -most, most);
    }
    w.gradient_x = gradient[0];
    w.gradient_y = gradient[1];
    for (int i = 0; i < rows * columns; i++)
        was[i] = sum[i] = noise_between(&s->seed, 0, 1 << 22);
    subject->kernels.edge_support(sum, &w);
    for (int i = 0; i < rows * columns; i++) {
        const int at = i / columns * stride + i % columns;
        const int across = abs(gradient[0][at] * w.normal_x + gradient[1][at] * w.normal_y) / 128;

        if (sum[i] != was[i] + (across < RF_MOST_PHOTO_EDGE ? across : RF_MOST_PHOTO_EDGE))
            return false;
    }
    return intact(s, 3);
}

/* ----- climb ----- */

enum { FROM, TO, END, LARGEST, LENGTH, PLANES };

/* One step from an element of planes that begin at the cell's first one. */
static bool step_on(const struct rf_climb_cell *c, uint16_t *const plane[PLANES], ptrdiff_t at)
{
    static const int down[RF_NO_DIRECTION + 1] = {0, 0, 1, -1, 1, -1, 1, -1, 0};
    static const int right[RF_NO_DIRECTION + 1] = {1, -1, 0, 0, 1, 1, -1, -1, 0};
    const int way = c->down ? c->direction[at] / 16 : c->direction[at] % 16;
    const uint16_t was = plane[FROM][at];
    const uint16_t next = plane[FROM][at + down[way] * STRIDE + right[way]];
    const int step = (uint16_t)(c->down ? was - next : next - was);

    plane[TO][at] = next;
    if (plane[LENGTH][at] != c->step - 1 || step < c->flat || step < plane[LARGEST][at] / 12.0)
        return false;
    plane[END][at] = next;
    if (step > plane[LARGEST][at])
        plane[LARGEST][at] = (uint16_t)step;
    plane[LENGTH][at] = c->step;
    return true;
}

static bool check_climb(const struct subject *subject, struct stage *s, uint32_t round)
{
    static const uint32_t most[PLANES] = {65535, 65535, 65535, 65535, 30};
    static uint16_t copy[PLANES][CELL];
    uint16_t *plane[PLANES], *expected[PLANES];
    uint8_t *direction = row_of(s, PLANES, CELL, 1);
    const int first = STRIDE + 1;
    struct rf_climb_cell c = {.direction = direction + first,
                              .down = round & 1,
                              .stride = STRIDE,
                              .columns = round % 3 ? RF_CLIMB_CELL
                                                   : noise_between(&s->seed, 1, RF_CLIMB_CELL),
                              .rows = noise_between(&s->seed, 1, RF_CLIMB_CELL),
                              .flat = (uint16_t)noise_between(&s->seed, 1, round % 5 ? 100 : 20000),
                              .step = (uint16_t)noise_between(&s->seed, 1, 28)};
    bool goes = false, any;

    for (int i = 0; i < CELL; i++)
        direction[i] =
            (uint8_t)(noise_between(&s->seed, 0, 8) + 16 * noise_between(&s->seed, 0, 8));
    for (int k = 0; k < PLANES; k++)
        plane[k] = words(s, k, CELL, round / 2, most[k]);
    for (int i = 0; i < CELL; i++) {
        /* Half of the ways still go on; some steps are just a twelfth of the largest one. */
        if (noise(&s->seed) & 1)
            plane[LENGTH][i] = (uint16_t)(c.step - 1);
        if (i > 0 && noise(&s->seed) & 1)
            plane[LARGEST][i] = (uint16_t)(abs(plane[FROM][i] - plane[FROM][i - 1]) % 5000 * 12 +
                                           noise_between(&s->seed, -1, 1));
    }
    for (int k = 0; k < PLANES; k++) {
        memcpy(copy[k], plane[k], sizeof copy[k]);
        expected[k] = copy[k] + first;
    }
    c.from = plane[FROM] + first;
    c.to = plane[TO] + first;
    c.end = plane[END] + first;
    c.largest = plane[LARGEST] + first;
    c.length = plane[LENGTH] + first;
    any = subject->kernels.climb(&c);
    for (int i = 0; i < c.rows * c.columns; i++)
        if (step_on(&c, expected, i / c.columns * STRIDE + i % c.columns))
            goes = true;
    for (int k = 0; k < PLANES; k++)
        if (memcmp(copy[k], plane[k], sizeof copy[k]) != 0)
            return false;
    return any == goes && intact(s, PLANES + 1);
}

int check_edge_planes(const struct subject *subject)
{
    static const struct {
        const char *name;
        bool (*check)(const struct subject *subject, struct stage *s, uint32_t round);
    } kernel[] = {{"binomial8", check_binomial8},           {"binomial16", check_binomial16},
                  {"photo_gradient", check_photo_gradient}, {"map_slope", check_map_slope},
                  {"block_ranges", check_block_ranges},     {"greatest", check_greatest},
                  {"edge_support", check_edge_support},     {"climb", check_climb}};
    struct stage s;
    int failures = 0;

    for (int i = 0; i < BUFFERS; i++)
        if (!guarded_create(&s.buffer[i], RF_EDGE_BLOCK * (MOST + 2) * 2)) {
            printf("FAIL  no memory between pages\n");
            return 1;
        }
    for (size_t k = 0; k < sizeof kernel / sizeof *kernel; k++) {
        uint32_t round = 0;

        for (; round < ROUNDS; round++) {
            s.place = (enum place)(round / 4 % PLACES);
            s.seed = round;
            if (!kernel[k].check(subject, &s, round))
                break;
        }
        if (round == ROUNDS)
            printf("ok    %-14s %-6s %d cases\n", kernel[k].name, subject->cpu, ROUNDS);
        else
            printf("FAIL  %-14s %-6s round %u\n", kernel[k].name, subject->cpu, (unsigned)round);
        failures += round < ROUNDS;
    }
    for (int i = 0; i < BUFFERS; i++)
        guarded_destroy(&s.buffer[i]);
    return failures;
}
