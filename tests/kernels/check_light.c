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

enum { ROW = 300 };

struct layer {
    uint16_t row[3][ROW + 1], before[3][ROW + 1], weight[ROW + 1];
};

/* n pixels of a layer after `weigh`, and what is beyond; the brightest of each tile. */
static int check_layer(const struct subject *subject, const struct layer *l,
                       const uint16_t *light_weight, int n, uint16_t *brightest)
{
    for (int x = 0; x <= ROW; x++) {
        int m = 0, w;

        for (int c = 0; c < 3; c++)
            m = l->before[c][x] > m ? l->before[c][x] : m;
        w = x < n ? light_weight[m < 4095 ? m : 4095] / 8 : 4321;
        if (l->weight[x] != w)
            return wrong(subject, "weigh", "a weight", l->weight[x], w);
        for (int c = 0; c < 3; c++) {
            const uint32_t v = l->before[c][x];
            const uint32_t should = x >= n      ? v
                                    : v > 16383 ? 2 * ((v * (uint32_t)w + 2048) / 4096)
                                                : (2 * v * (uint32_t)w + 2048) / 4096;

            if (l->row[c][x] != should)
                return wrong(subject, "weigh", "light", l->row[c][x], should);
            if (x < n && should > brightest[x / RF_TILE])
                brightest[x / RF_TILE] = (uint16_t)should;
        }
    }
    return 0;
}

static void make_layer(struct layer *l, int most, uint32_t *seed)
{
    for (int x = 0; x <= ROW; x++) {
        for (int c = 0; c < 3; c++)
            l->before[c][x] = (uint16_t)noise_between(seed, 0, most);
        l->weight[x] = 4321;
    }
}

/* Light of every size; a background that is the same for some tiles. */
static int check_weigh(const struct subject *subject)
{
    static uint16_t table[4096];
    static struct layer near, far;
    uint32_t seed = 14;

    for (int round = 0; round < 500; round++) {
        const int n = (int)(noise(&seed) % (ROW + 1)), most = noise(&seed) % 2 ? 8 * 4095 : 20;
        uint16_t is[ROW / RF_TILE + 2], brightest[ROW / RF_TILE + 2];
        const struct rf_weigh_job job = {
            .near = {near.row[0], near.row[1], near.row[2]},
            .far = {far.row[0], far.row[1], far.row[2]},
            .near_weight = near.weight,
            .far_weight = far.weight,
            .brightest = is,
            .light_weight = table,
        };

        for (int i = 0; i < 4096; i++)
            table[i] = (uint16_t)noise_between(&seed, 8, RF_WEIGHT_MAX);
        for (int i = 0; i < ROW / RF_TILE + 2; i++)
            is[i] = brightest[i] = (uint16_t)(noise(&seed) % 2 * (noise(&seed) % 65536));
        make_layer(&near, most, &seed);
        make_layer(&far, most, &seed);
        for (int x = 0; x < ROW; x++)
            for (int c = 0; c < 3 && (x / RF_TILE + round) % 3; c++)
                far.before[c][x] = (uint16_t)(near.before[c][x] ^ (noise(&seed) % 32 == 0));
        memcpy(near.row, near.before, sizeof near.row);
        memcpy(far.row, far.before, sizeof far.row);
        subject->kernels.weigh(&job, n);
        if (check_layer(subject, &near, table, n, brightest) ||
            check_layer(subject, &far, table, n, brightest))
            return 1;
        for (int i = 0; i < ROW / RF_TILE + 2; i++)
            if (is[i] != brightest[i])
                return wrong(subject, "weigh", "the brightest", is[i], brightest[i]);
    }
    return 0;
}

struct layer1 {
    uint16_t row[ROW + 1], before[ROW + 1], weight[ROW + 1];
};

/* n pixels of a layer after `weigh1`. */
static int check_layer1(const struct subject *subject, const struct layer1 *l,
                        const uint16_t *light_weight, int n, uint16_t *brightest)
{
    for (int x = 0; x <= ROW; x++) {
        const unsigned v = l->before[x];
        const unsigned w = x < n ? light_weight[v < 4095 ? v : 4095] / 8u : 4321;
        const unsigned should = x < n ? (2 * v * w + 2048) / 4096 : v;

        if (l->weight[x] != w)
            return wrong(subject, "weigh1", "a weight", l->weight[x], w);
        if (l->row[x] != should)
            return wrong(subject, "weigh1", "light", l->row[x], should);
        if (x < n && should > brightest[x / RF_TILE])
            brightest[x / RF_TILE] = (uint16_t)should;
    }
    return 0;
}

static int check_weigh1(const struct subject *subject)
{
    static uint16_t table[4096];
    static struct layer1 layer[2];
    uint32_t seed = 21;

    for (int round = 0; round < 500; round++) {
        const int n = (int)(noise(&seed) % (ROW + 1)), most = noise(&seed) % 2 ? 4 * 4095 : 20;
        uint16_t is[ROW / RF_TILE + 2], brightest[ROW / RF_TILE + 2];
        const struct rf_weigh1_job job = {layer[0].row,    layer[1].row, layer[0].weight,
                                          layer[1].weight, is,           table};

        for (int i = 0; i < 4096; i++)
            table[i] = (uint16_t)noise_between(&seed, 8, RF_WEIGHT_MAX);
        for (int i = 0; i < ROW / RF_TILE + 2; i++)
            is[i] = brightest[i] = (uint16_t)(noise(&seed) % 2 * (noise(&seed) % 65536));
        for (int x = 0; x <= ROW; x++)
            for (int k = 0; k < 2; k++) {
                layer[k].before[x] = (uint16_t)noise_between(&seed, 0, most);
                if (k == 1 && (x / RF_TILE + round) % 3 && noise(&seed) % 100)
                    layer[1].before[x] = layer[0].before[x];
                layer[k].row[x] = layer[k].before[x];
                layer[k].weight[x] = 4321;
            }
        subject->kernels.weigh1(&job, n);
        for (int k = 0; k < 2; k++)
            if (check_layer1(subject, &layer[k], table, n, brightest))
                return 1;
        for (int i = 0; i < ROW / RF_TILE + 2; i++)
            if (is[i] != brightest[i])
                return wrong(subject, "weigh1", "the brightest", is[i], brightest[i]);
    }
    return 0;
}

static int check_weigh_chroma(const struct subject *subject)
{
    uint16_t chroma[ROW + 1], before[ROW + 1], weight[ROW + 1];
    uint32_t seed = 22;

    for (int round = 0; round < 500; round++) {
        const int n = (int)(noise(&seed) % (ROW / 2 + 1));

        for (int i = 0; i <= ROW; i++) {
            chroma[i] = before[i] = (uint16_t)noise_between(&seed, 0, 32767);
            weight[i] = (uint16_t)noise_between(&seed, 1, 4095);
        }
        subject->kernels.weigh_chroma(chroma, weight, n);
        for (int i = 0; i <= ROW; i++) {
            const unsigned product = before[i] * (unsigned)weight[i / 2 * 2];
            const unsigned should = i < 2 * n ? (product + 2048) / 4096 : before[i];

            if (chroma[i] != should)
                return wrong(subject, "weigh_chroma", "a value", chroma[i], should);
        }
    }
    return 0;
}

/* The operations one after the other, rounded to single precision each. */
static int check_weighed_means(const struct subject *subject)
{
    uint32_t sum[LANES], weight[LANES], seed = 15;
    uint16_t mean[LANES + 1];

    for (int round = 0; round < 500; round++) {
        const int n = (int)(noise(&seed) % (LANES + 1));

        for (int i = 0; i < n; i++) {
            weight[i] = 1 + noise(&seed) % (round % 2 ? 1u << 28 : 1u << 18);
            sum[i] = (uint32_t)((uint64_t)weight[i] * (noise(&seed) % 65536) / 8192);
            sum[i] = sum[i] < INT32_MAX ? sum[i] : INT32_MAX;
        }
        mean[n] = 12345;
        subject->kernels.premultiplied_means(mean, sum, weight, n);
        if (mean[n] != 12345)
            return wrong(subject, "premultiplied_means", "one past the end", mean[n], 12345);
        for (int i = 0; i < n; i++) {
            volatile float s = (float)sum[i], w = (float)weight[i];
            volatile float product = s * 8192, quotient = product / w, v = quotient + 0.5f;
            const uint16_t should = (uint16_t)(v < 65520 ? v : 65520);

            if (mean[i] != should)
                return wrong(subject, "premultiplied_means", "of a sum", mean[i], should);
            if (fabs(mean[i] - 8192.0 * sum[i] / weight[i]) > 0.5 + 1.0 / 64 && should < 65520)
                return wrong(subject, "premultiplied_means", "far from it", mean[i],
                             8192.0 * sum[i] / weight[i]);
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
                         check_between(subject) + check_soften(subject) + check_weigh(subject) +
                         check_weigh1(subject) + check_weigh_chroma(subject) +
                         check_weighed_means(subject) + check_composite_thin(subject);

    if (!failures)
        printf("ok    %-12s %-6s means, weights, brightest, rows between, softening, coverage\n",
               "light", subject->cpu);
    return failures;
}
