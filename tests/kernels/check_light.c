/* Means of weighted sums, and the brightest of a row. */
#include "check.h"

#include <math.h>
#include <stdio.h>

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

/* Of any sums: half up in whole numbers, but where the half is nearer than 2^-30. Any count,
 * and nothing written after it. */
static int check_any(const struct subject *subject)
{
    uint64_t sum[LANES], weight[LANES];
    uint16_t mean[LANES + 1];
    uint32_t seed = 12;

    for (int round = 0; round < 500; round++) {
        const int n = (int)(noise(&seed) % (LANES + 1));

        for (int i = 0; i < n; i++) {
            weight[i] = 1 + ((uint64_t)noise(&seed) << 12 ^ noise(&seed));
            sum[i] = weight[i] / 4096 * (noise(&seed) % WHITE) +
                     noise(&seed) % 4096;
        }
        mean[n] = 12345;
        subject->kernels.weighted_means(mean, sum, weight, n);
        if (mean[n] != 12345)
            return wrong(subject, "weighted_means", "one past the end", mean[n], 12345);
        for (int i = 0; i < n; i++) {
            const uint64_t should = (4 * sum[i] + weight[i] / 2) / weight[i];

            if (mean[i] != should &&
                (4 * sum[i] + weight[i] / 2) % weight[i] > weight[i] >> 30)
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
        uint16_t computed[LANES], mean[LANES];

        for (int k = 0; k < rows[i] * RF_TILE; k++)
            computed[k] = (uint16_t)(k % RF_TILE == 0 ? round * 217 : (int)noise(&seed) % 65536);
        subject->kernels.between_rows(mean, computed, steps[i]);
        for (int k = 0; k < LANES; k++) {
            const double should =
                cubic(computed, at[i], rows[i], k % RF_TILE, k / RF_TILE);
            const double off = mean[k] - should;

            if (k % RF_TILE == 0 ? mean[k] != computed[0] : off > 8 || off < -8)
                return wrong(subject, "between_rows", "a pixel", mean[k], should);
        }
    }
    return 0;
}

int check_light(const struct subject *subject)
{
    const int failures = check_equal(subject) + check_any(subject) + check_brightest(subject) +
                         check_between(subject);

    if (!failures)
        printf("ok    %-12s %-6s weighted means, brightest, rows between\n", "light", subject->cpu);
    return failures;
}
