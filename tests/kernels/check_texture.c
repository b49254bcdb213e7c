/* check_texture.c: products and solve_lanes, bit for bit against their contracts. */
#include "check.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MOST = 40, LANES = RF_SOLVE_LANES, CELLS = MOST * (MOST + 1) / 2 };

static bool check_products(const struct subject *subject)
{
    enum { SIDE = 70 };
    static int16_t a[SIDE * SIDE], b[SIDE * SIDE];
    uint32_t seed = 3;

    for (int n = 0; n <= 66; n++) {
        const int rows = noise_between(&seed, 0, 20), most = n % 3 ? 4095 : 255;
        int16_t *from = a + noise(&seed) % 4, *to = b + noise(&seed) % 4;
        int64_t right = 0, is;

        for (int i = 0; i < SIDE * SIDE; i++) {
            a[i] = (int16_t)noise_between(&seed, -most, most);
            b[i] = (int16_t)(i % 7 ? noise_between(&seed, -most, most) : most);
        }
        for (int y = 0; y < rows; y++)
            for (int x = 0; x < n; x++)
                right += (int64_t)from[y * SIDE + x] * to[y * SIDE + x];
        is = subject->kernels.products(from, to, SIDE, n, rows);
        if (is != right) {
            printf("FAIL  %-12s %-6s %d x %d: %lld, should be %lld\n", "products", subject->cpu, n,
                   rows, (long long)is, (long long)right);
            return false;
        }
    }
    return true;
}

/* The equations of one lane, as the contract says, in the order of the reference. */
static void solve(float *matrix, float *x, int n)
{
    float inverse[MOST];

    for (int i = 0; i < n; i++) {
        float *row = matrix + i * (i + 1) / 2, pivot = row[i];
        const float least = row[i] * (1.0f / RF_SOLVE_PIVOT);

        for (int j = 0; j < i; j++)
            for (int k = 0; k < j; k++)
                row[j] -= row[k] * matrix[j * (j + 1) / 2 + k];
        for (int k = 0; k < i; k++) {
            const float quotient = row[k] * inverse[k];

            pivot -= row[k] * quotient;
            row[k] = quotient;
        }
        inverse[i] = 1.0f / (pivot > least ? pivot : least);
    }
    for (int i = 0; i < n; i++)
        for (int k = 0; k < i; k++)
            x[i] -= matrix[i * (i + 1) / 2 + k] * x[k];
    for (int i = 0; i < n; i++)
        x[i] *= inverse[i];
    for (int i = n - 1; i > 0; i--)
        for (int k = 0; k < i; k++)
            x[k] -= matrix[i * (i + 1) / 2 + k] * x[i];
}

/* Covariances exp(-|i - j| / w) with noise: a system as there are; every third lane is one that no
 * covariances have, where pivots are held. */
static void set_lane(float (*matrix)[LANES], float (*x)[LANES], int n, int lane, uint32_t *seed)
{
    const float width = 0.5f + (float)noise_between(seed, 0, 100) / 10;

    for (int i = 0, k = 0; i < n; i++) {
        for (int j = 0; j < i; j++)
            matrix[k++][lane] = lane % 3 == 2
                                    ? (float)noise_between(seed, -100, 100) / 100
                                    : (float)floor(1024 * exp(-(i - j) / (double)width)) / 1024;
        matrix[k++][lane] = 1 + (float)noise_between(seed, 10, 60) / 100;
        x[i][lane] = (float)noise_between(seed, -100, 100) / 100;
    }
}

static bool check_solve_lanes(const struct subject *subject)
{
    static float matrix[CELLS][LANES], own[CELLS], x[MOST][LANES], before[MOST][LANES];
    static float whole[CELLS][LANES];
    uint32_t seed = 7;

    for (int n = 0; n <= MOST; n++) {
        for (int lane = 0; lane < LANES; lane++)
            set_lane(matrix, x, n, lane, &seed);
        memcpy(before, x, sizeof before);
        memcpy(whole, matrix, sizeof whole);
        subject->kernels.solve_lanes(matrix, x, n);
        for (int lane = 0; lane < LANES; lane++) {
            float right[MOST];

            for (int i = 0; i < n; i++)
                right[i] = before[i][lane];
            for (int k = 0; k < n * (n + 1) / 2; k++)
                own[k] = whole[k][lane];
            solve(own, right, n);
            for (int i = 0; i < n; i++) {
                double sum = 0;

                for (int j = 0; j < n; j++)
                    sum += (double)whole[i > j ? i * (i + 1) / 2 + j : j * (j + 1) / 2 + i][lane] *
                           (double)x[j][lane];
                if (memcmp(&x[i][lane], &right[i], sizeof *right) != 0 ||
                    (lane % 3 != 2 && fabs(sum - (double)before[i][lane]) > 1e-4)) {
                    printf("FAIL  %-12s %-6s n = %d, lane %d: %.9g, should be %.9g\n",
                           "solve_lanes", subject->cpu, n, lane, (double)x[i][lane],
                           (double)right[i]);
                    return false;
                }
            }
        }
    }
    return true;
}

int check_texture(const struct subject *subject)
{
    int failures = 0;

    if (check_products(subject))
        printf("ok    %-12s %-6s\n", "products", subject->cpu);
    else
        failures++;
    if (check_solve_lanes(subject))
        printf("ok    %-12s %-6s\n", "solve_lanes", subject->cpu);
    else
        failures++;
    return failures;
}
