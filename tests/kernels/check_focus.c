/* check_focus.c: checks what the numbers that kernels are given mean, against double precision. */
#include "check.h"

#include <math.h>
#include <stdio.h>

#include "focus/focus.h"

static int wrong(const char *name, const char *what, double is, double should)
{
    printf("FAIL  %-12s %s: %.9g, should be %.9g\n", name, what, is, should);
    return 1;
}

/* signed_blur is within 1.25/256 pixel of K (df - d): half a unit from each of K and the
 * result, a quarter from df. */
static int check_blur(const struct rf_kernels *kernels)
{
    uint32_t seed = 3;
    double worst = 0;

    for (int i = 0; i < 3000; i++) {
        const float K = (float)(i % 3 ? noise(&seed) % 127001 / 1000.0 : i % 128);
        const float df = (float)(i % 5 ? noise(&seed) % 1000001 / 1e6 : i % 2);
        const struct rf_focus focus = rf_focus_of(df, K);

        for (int k = 0; k < 40; k++) {
            const uint16_t d = (uint16_t)(k == 0 ? 0 : k == 1 ? 65535 : noise(&seed));
            const double real = (double)K * ((double)df - d / 65535.0);
            int16_t blur;

            kernels->signed_blur(&blur, &d, focus, 1);
            worst = fmax(worst, fabs(blur / 256.0 - real));
        }
    }
    if (worst > 1.25 / 256)
        return wrong("signed_blur", "off by", worst, 1.25 / 256);
    printf("ok    %-12s %-6s within %.2f/256 pixel of K (df - d)\n", "signed_blur", "c",
           256 * worst);
    return 0;
}

/* The mean of N equal values is that value; of any, within 1/2 + N / 2^17. */
static int check_scale(const struct rf_kernels *kernels)
{
    uint32_t seed = 4;

    for (int rays = 1; rays <= 65025; rays += rays < 1024 ? 1 : 997) {
        const uint32_t scale = rf_mean_scale((uint64_t)rays);
        uint32_t sum[4096];
        uint16_t mean[4096];

        for (int v = 0; v < 4096; v++)
            sum[v] = (uint32_t)(4 * v * rays);
        kernels->means(mean, sum, scale, 4096);
        for (int v = 0; v < 4096; v++)
            if (mean[v] != 16 * v)
                return wrong("means", "of equal values", mean[v], 16 * v);
        for (int i = 0; i < 200; i++)
            sum[i] = noise(&seed) % (4 * 4095u * (uint32_t)rays + 1);
        kernels->means(mean, sum, scale, 200);
        for (int i = 0; i < 200; i++)
            if (fabs(mean[i] - 4.0 * sum[i] / rays) > 0.5 + rays / 131072.0)
                return wrong("means", "of a sum", mean[i], 4.0 * sum[i] / rays);
    }
    printf("ok    %-12s %-6s exact of equal values, within 1/2 + N / 2^17 of all\n", "means", "c");
    return 0;
}

int check_focus(void)
{
    struct rf_kernels kernels;
    uint32_t cpu = REFOCUS_CPU_C;

    if (!rf_kernels_select(&kernels, &cpu))
        return 1;
    return check_blur(&kernels) + check_scale(&kernels);
}
