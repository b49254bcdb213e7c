/* Means of weighted sums, and the brightest of a row. */
#include "check.h"

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

int check_light(const struct subject *subject)
{
    const int failures = check_equal(subject) + check_any(subject) + check_brightest(subject);

    if (!failures)
        printf("ok    %-12s %-6s weighted means, brightest\n", "light", subject->cpu);
    return failures;
}
