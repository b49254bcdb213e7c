/* check_light.c: checks the kernels for means of weighted sums and for the brightest light of a
 * row. */
#include "check.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { LANES = RF_TILE * RF_TILE, WHITE = 4 * 4095 };

static int wrong(const struct subject *subject, const char *kernel, const char *what, double is,
                 double should)
{
    printf("FAIL  %-12s %-6s %s is %g, should be %g\n", kernel, subject->cpu, what, is, should);
    return 1;
}

/* Every light in every lane: the mean of equal ones is four times that, whatever they weigh. */
static int check_equal(const struct subject *subject)
{
    uint64_t sum[LANES], weight[LANES];
    uint16_t mean[LANES];
    uint32_t seed = 11;

    for (int light = 0; light < WHITE; light += LANES - 1) {
        for (int i = 0; i < LANES; i++) {
            const uint64_t rays = 1 + noise(&seed) % 65025;

            weight[i] = rays * (1 + noise(&seed) % RF_WEIGHT_MAX);
            sum[i] = weight[i] * (uint64_t)(light + i <= WHITE ? light + i : WHITE);
        }
        subject->kernels.weighted_means(mean, sum, weight, LANES);
        for (int i = 0; i < LANES; i++) {
            const int should = 4 * (light + i <= WHITE ? light + i : WHITE);

            if (mean[i] != should)
                return wrong(subject, "weighted_means", "of equal values", mean[i], should);
        }
    }
    return 0;
}

/* Sums of any size round half up in whole numbers, but where the half is nearer than 2^-30. Any
 * count works, and nothing is written after it. */
static int check_any(const struct subject *subject)
{
    uint64_t sum[LANES], weight[LANES];
    uint16_t mean[LANES + 1];
    uint32_t seed = 12;

    for (int round = 0; round < 500; round++) {
        const int n = (int)(noise(&seed) % (LANES + 1));

        for (int i = 0; i < n; i++) {
            weight[i] = 1 + ((uint64_t)noise(&seed) << 12 ^ noise(&seed));
            sum[i] = weight[i] / 4096 * (noise(&seed) % WHITE) + noise(&seed) % 4096;
        }
        mean[n] = 12345;
        subject->kernels.weighted_means(mean, sum, weight, n);
        if (mean[n] != 12345)
            return wrong(subject, "weighted_means", "one past the end", mean[n], 12345);
        for (int i = 0; i < n; i++) {
            const uint64_t should = (4 * sum[i] + weight[i] / 2) / weight[i];

            if (mean[i] != should && (4 * sum[i] + weight[i] / 2) % weight[i] > weight[i] >> 30)
                return wrong(subject, "weighted_means", "of a sum", mean[i], (double)should);
        }
    }
    return 0;
}

static int check_brightest(const struct subject *subject)
{
    uint16_t row[3][LANES];
    uint32_t seed = 13;

    for (int round = 0; round < 500; round++) {
        const int n = 1 + (int)(noise(&seed) % LANES);
        uint16_t most = 0, is;

        for (int c = 0; c < 3; c++) {
            for (int i = 0; i < LANES; i++) {
                row[c][i] = (uint16_t)(noise(&seed) % (WHITE + 1));
                if (i < n && row[c][i] > most)
                    most = row[c][i];
                if (i >= n)
                    row[c][i] = 0xffff;
            }
        }
        is = subject->kernels.brightest(row[0], row[1], row[2], n);
        if (is != most)
            return wrong(subject, "brightest", "of a row", is, most);
    }
    return 0;
}

/* The cubic through four of the computed rows, by Lagrange; its shares are rounded to Q14. */
static double cubic(const uint16_t *computed, const int *at, int rows, int x, int y)
{
    int first = 0;
    double v = 0;

    while (first + 4 < rows && at[first + 2] <= y)
        first++;
    for (int k = first; k < first + 4; k++) {
        double share = 1;

        for (int j = first; j < first + 4; j++)
            if (j != k)
                share *= (double)(y - at[j]) / (at[k] - at[j]);
        v += share * computed[k * RF_TILE + x];
    }
    for (int k = 0; k + 1 < rows; k++) {
        const double a = computed[k * RF_TILE + x], b = computed[(k + 1) * RF_TILE + x];

        if (at[k] <= y && y <= at[k + 1])
            return fmin(fmax(v, fmin(a, b)), fmax(a, b));
    }
    return -1;
}

static int check_between(const struct subject *subject)
{
    static const int at[3][8] = {{0, 2, 4, 6, 9, 11, 13, 15}, {0, 3, 6, 9, 12, 15}, {0, 5, 10, 15}};
    static const int rows[] = {8, 6, 4}, steps[] = {2, 3, 5};
    uint32_t seed = 14;

    for (int round = 0; round < 300; round++) {
        const int i = round % 3;
        uint16_t computed[LANES], mean[LANES], plain[LANES];

        for (int k = 0; k < rows[i] * RF_TILE; k++)
            computed[k] = (uint16_t)(k % RF_TILE == 0 ? round * 217 : (int)noise(&seed) % 65536);
        subject->kernels.between_rows(mean, computed, steps[i]);
        subject->plain.between_rows(plain, computed, steps[i]);
        if (memcmp(mean, plain, sizeof mean))
            return wrong(subject, "between_rows", "not as in C", round, steps[i]);
        for (int k = 0; k < LANES; k++) {
            const double should = cubic(computed, at[i], rows[i], k % RF_TILE, k / RF_TILE);
            const double off = mean[k] - should;

            if (k % RF_TILE == 0 ? mean[k] != computed[0] : off > 8 || off < -8)
                return wrong(subject, "between_rows", "a pixel", mean[k], should);
        }
    }
    return 0;
}

/* line[i] moved towards the average of its two neighbours `step` apart, unless it is the first or
 * the last of n. */
static unsigned softened(const uint16_t *line, int step, int i, int n, unsigned share)
{
    const unsigned own = line[i * step];

    if (i == 0 || i == n - 1)
        return own;
    const unsigned average = (line[(i - 1) * step] + line[(i + 1) * step] + 1u) / 2;

    return average > own ? own + (average - own) * share / 131072
                         : own - (own - average) * share / 131072;
}

/* Every number of rows, of planes and of pairs; nothing written after them. */
static int check_soften(const struct subject *subject)
{
    uint32_t seed = 16;

    for (int round = 0; round < 200; round++) {
        const int rows = 1 + round % RF_TILE;
        const int each = 1 + round / RF_TILE % 2;
        const bool down = round / RF_TILE / 2 % 2;
        const uint16_t share = (uint16_t)(noise(&seed) % 3 ? noise(&seed) % 65536 : 65535);
        uint16_t mean[LANES + 1], all[LANES], across[LANES];

        for (int i = 0; i < LANES; i++)
            mean[i] = all[i] = (uint16_t)(noise(&seed) % 8 ? noise(&seed) % 65536 : 65535);
        mean[LANES] = 12345;
        for (int i = 0; i < LANES; i++)
            across[i] = (uint16_t)softened(all + i / RF_TILE * RF_TILE + i % each, each,
                                           i % RF_TILE / each, RF_TILE / each, share);
        subject->kernels.soften(mean, rows, each, down, share);
        for (int i = 0; i < LANES; i++) {
            const int x = i % RF_TILE, y = i / RF_TILE;
            const unsigned should = y >= rows ? all[i]
                                    : down    ? softened(across + x, RF_TILE, y, rows, share)
                                              : across[i];

            if (mean[i] != should)
                return wrong(subject, "soften", "a pixel", mean[i], should);
        }
        if (mean[LANES] != 12345)
            return wrong(subject, "soften", "what lies behind", mean[LANES], 12345);
    }
    return 0;
}

/* Between the middles of four cells, in real numbers. */
static double between_cells(int32_t cell[RF_COVERAGE_CELLS][RF_COVERAGE_CELLS][4], int c, int x,
                            int y)
{
    const double u = (2 * x + 5) / 8.0, v = (2 * y + 5) / 8.0;
    const int i = (int)u, j = (int)v;
    const double above = cell[j][i][c] + (u - i) * (cell[j][i + 1][c] - cell[j][i][c]);
    const double below = cell[j + 1][i][c] + (u - i) * (cell[j + 1][i + 1][c] - cell[j + 1][i][c]);

    return (above + (v - j) * (below - above)) / (1 << RF_COVERAGE_SHIFT) / 4096;
}

static int check_composite_thin(const struct subject *subject)
{
    uint32_t seed = 15;

    for (int round = 0; round < 200; round++) {
        int32_t cell[RF_COVERAGE_CELLS][RF_COVERAGE_CELLS][4];
        uint16_t mean[3][LANES], out[3][LANES], plain[3][LANES];
        struct rf_kernels c;
        uint32_t cpu = 1; /* plain C */

        rf_kernels_select(&c, &cpu);
        for (int i = 0; i < RF_COVERAGE_CELLS * RF_COVERAGE_CELLS; i++)
            for (int k = 0; k < 4; k++) /* a little below 0, and above 1 */
                cell[i / RF_COVERAGE_CELLS][i % RF_COVERAGE_CELLS][k] =
                    (int32_t)((round % 2 ? noise(&seed) : (uint32_t)round << 19) %
                              (9u << (RF_COVERAGE_SHIFT + 9))) -
                    (1 << 20);
        for (int i = 0; i < 3 * LANES; i++)
            mean[i / LANES][i % LANES] = (uint16_t)(noise(&seed) >> (round % 3 ? 18 : 16));
        memcpy(out, mean, sizeof out);
        memcpy(plain, mean, sizeof out);
        subject->kernels.composite_thin((uint16_t *const[3]){out[0], out[1], out[2]}, cell);
        c.composite_thin((uint16_t *const[3]){plain[0], plain[1], plain[2]}, cell);
        for (int i = 0; i < 3 * LANES; i++) {
            const int k = i / LANES, p = i % LANES;
            const double cover = fmin(fmax(between_cells(cell, 3, p % RF_TILE, p / RF_TILE), 0), 1);
            const double light = 16384 * between_cells(cell, k, p % RF_TILE, p / RF_TILE);
            const double should = fmin(fmax(mean[k][p] * (1 - cover) + light, 0), 65535);

            if (out[k][p] != plain[k][p] || fabs(out[k][p] - should) > 4)
                return wrong(subject, "composite_thin", "a pixel", out[k][p],
                             out[k][p] != plain[k][p] ? plain[k][p] : should);
        }
    }
    return 0;
}

int check_light(const struct subject *subject)
{
    const int failures = check_equal(subject) + check_any(subject) + check_brightest(subject) +
                         check_between(subject) + check_soften(subject) +
                         check_composite_thin(subject);

    if (!failures)
        printf("ok    %-12s %-6s means, brightest, rows between, softening, coverage\n", "light",
               subject->cpu);
    return failures;
}
