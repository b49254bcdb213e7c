/* check_rows.c: row kernels: an engine that gives each of them every length, place and extreme,
 * and compares all that it may touch with what it should be. */
#include "check.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "guarded.h"
#include "row_kernels.h"

enum {
    MOST = 300,   /* largest n */
    PATTERNS = 8, /* kinds of contents; see value() */
    MOST_BLUR = 127 * 256,
    ROW_BYTES = 4 * (2 * MOST + 2 * SPREAD_MARGIN + 2),
};

/* Rows that the kernel sees, and copies of them for what it should give. */
struct rows {
    struct guarded guarded[ROWS];
    void *row[ROWS];
    uint8_t *memory[ROWS];
    void *expected[ROWS];
};

static size_t size_of(enum kind kind)
{
    return kind == SUM ? 4 : 2;
}

static int margin_of(const struct row_spec *spec)
{
    return spec->margin + spec->scratch;
}

static size_t bytes_of(const struct row_spec *spec, int n)
{
    return (size_t)(spec->each * n + 2 * margin_of(spec)) * size_of(spec->kind);
}

/* The extremes of a kind; values of RAISED lie close together where there is a reach. */
static void range_of(enum kind kind, int parameter, uint32_t seed, int *least, int *most)
{
    *least = 0;
    *most = 4 * 4095;
    if (kind == DISPARITY || kind == SCRATCH)
        *most = 65535;
    if (kind == BLUR || kind == BLUR_OR_NONE) {
        *least = -MOST_BLUR;
        *most = MOST_BLUR;
    }
    if (kind == SUM)
        *most = 4 * 4095 * parameter;
    if (kind == RAISED) {
        *least = 32768 - MOST_BLUR;
        *most = 32768 + MOST_BLUR;
        if (parameter > 0) {
            const int span = parameter * RF_CONE_STEP;

            *least = span < 2 * MOST_BLUR ? noise_between(&seed, *least, *most - span) : *least;
            *most = *least + span < *most ? *least + span : *most;
        }
    }
}

/* Element i of a row: extremes before noise. */
static int value(int pattern, int i, int last, int least, int most, uint32_t *seed)
{
    int step;

    switch (pattern) {
    case 0:
        return least;
    case 1:
        return most;
    case 2:
        return i % 2 ? least : most;
    case 3:
        return noise(seed) % 2 ? least : most;
    case 4: /* beside the extremes and the middle */
        step = noise_between(seed, -1, 1);
        switch (noise(seed) % 3) {
        case 0:
            return least + abs(step);
        case 1:
            return most - abs(step);
        default:
            return least + (most - least) / 2 + step;
        }
    case 5: /* neighbours a little more or less than a pixel of blur apart */
        step = noise_between(seed, -1, 1) * 256 + noise_between(seed, -1, 1);
        last += step;
        return last < least ? least : last > most ? most : last;
    default:
        return noise_between(seed, least, most);
    }
}

static void put(enum kind kind, void *row, int i, int v)
{
    if (kind == SUM)
        ((uint32_t *)row)[i] = (uint32_t)v;
    else
        ((uint16_t *)row)[i] = (uint16_t)v;
}

static void fill(const struct row_spec *spec, void *row, int parameter, int pattern, int n,
                 uint32_t seed, uint32_t range_seed)
{
    int least, most, last;

    range_of(spec->kind, parameter, range_seed, &least, &most);
    last = least + (most - least) / 2;
    for (int i = -margin_of(spec); i < spec->each * n + margin_of(spec); i++) {
        last = value(pattern, i, last, least, most, &seed);
        if (spec->kind == BLUR_OR_NONE && noise(&seed) % 4 < (uint32_t)pattern % 4)
            put(spec->kind, row, i, RF_NO_BLUR);
        else
            put(spec->kind, row, i, last);
    }
}

static void place_rows(struct rows *rows, const struct row_kernel *kernel, int parameter,
                       int pattern, enum place place, int n, uint32_t seed)
{
    for (int i = 0; i < kernel->rows; i++) {
        const struct row_spec *spec = &kernel->row[i];
        const size_t size = size_of(spec->kind), bytes = bytes_of(spec, n);
        const size_t margin = (size_t)margin_of(spec) * size;
        uint8_t *all =
            guarded_place(&rows->guarded[i], bytes, size, place, (seed + 3 * (unsigned)i) % 17);

        rows->row[i] = all + margin;
        rows->expected[i] = rows->memory[i] + margin;
        fill(spec, rows->row[i], parameter, pattern, n, seed + (uint32_t)i * 77, seed);
        memcpy(rows->memory[i], all, bytes);
    }
}

static int element(enum kind kind, const void *row, int i)
{
    if (kind == SUM)
        return (int)((const uint32_t *)row)[i];
    if (kind == BLUR || kind == BLUR_OR_NONE)
        return ((const int16_t *)row)[i];
    return ((const uint16_t *)row)[i];
}

/* Whether every row is as it should be; where not, says the first difference in `why`. */
static bool same_rows(const struct rows *rows, const struct row_kernel *kernel, int n, char *why,
                      size_t room)
{
    for (int i = 0; i < kernel->rows; i++) {
        const struct row_spec *spec = &kernel->row[i];

        if (!guarded_intact(&rows->guarded[i])) {
            snprintf(why, room, "row %d: overwritten beyond its ends", i);
            return false;
        }
        if (spec->kind == SCRATCH)
            continue;
        for (int x = -spec->margin; x < spec->each * n + spec->margin; x++) {
            const int is = element(spec->kind, rows->row[i], x);
            const int should = element(spec->kind, rows->expected[i], x);

            if (is != should) {
                snprintf(why, room, "row %d: element %d is %d, should be %d", i, x, is, should);
                return false;
            }
        }
    }
    return true;
}

static bool check_case(const struct subject *subject, const struct row_kernel *kernel,
                       struct rows *rows, int pattern, enum place place, int n, uint32_t seed)
{
    uint32_t state = seed;
    int parameter = noise_between(&state, kernel->least, kernel->most);
    char why[120];

    if (seed % 8 < 2)
        parameter = seed % 8 ? kernel->most : kernel->least;
    place_rows(rows, kernel, parameter, pattern, place, n, seed);
    kernel->expect(rows->expected, parameter, n);
    kernel->run(&subject->kernels, rows->row, parameter, n);
    if (same_rows(rows, kernel, n, why, sizeof why))
        return true;
    printf("FAIL  %-12s %-6s seed %u, parameter %d, pattern %d, n = %d, %s: %s\n", kernel->name,
           subject->cpu, (unsigned)seed, parameter, pattern, n,
           place == AT_START ? "after a page's end"
           : place == AT_END ? "before a page"
                             : "inside",
           why);
    return false;
}

static bool check_kernel(const struct subject *subject, const struct row_kernel *kernel,
                         struct rows *rows)
{
    static const int longer[] = {47, 63, 64, 65, 100, 127, 128, 129, 255, MOST};
    uint32_t seed = 1;
    int cases = 0;

    for (int i = 0; i <= 40 + 10; i++) {
        const int n = i <= 40 ? i : longer[i - 41];

        for (int pattern = 0; pattern < PATTERNS; pattern++)
            for (int place = 0; place < PLACES; place++, seed++, cases++)
                if (!check_case(subject, kernel, rows, pattern, (enum place)place, n, seed))
                    return false;
    }
    printf("ok    %-12s %-6s %d cases\n", kernel->name, subject->cpu, cases);
    return true;
}

static bool create(struct rows *rows)
{
    memset(rows, 0, sizeof *rows);
    for (int i = 0; i < ROWS; i++) {
        rows->memory[i] = malloc(ROW_BYTES);
        if (!rows->memory[i] || !guarded_create(&rows->guarded[i], ROW_BYTES))
            return false;
    }
    return true;
}

static void destroy(struct rows *rows)
{
    for (int i = 0; i < ROWS; i++) {
        free(rows->memory[i]);
        guarded_destroy(&rows->guarded[i]);
    }
}

int check_rows(const struct subject *subject)
{
    struct rows rows;
    int failures = 0;

    if (!create(&rows)) {
        printf("FAIL  no memory between pages\n");
        return 1;
    }
    for (int i = 0; i < row_kernel_count; i++)
        failures += !check_kernel(subject, &row_kernels[i], &rows);
    destroy(&rows);
    return failures;
}
