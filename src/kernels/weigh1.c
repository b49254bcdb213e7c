#include "colour/transfer.h"
#include "kernels/kernels.h"

/* Pixel x of a layer. */
static void weigh_pixel(uint16_t *weight, uint16_t *light, uint16_t *brightest,
                        const uint16_t *light_weight, int x)
{
    weight[x] = light_weight[light[x] < RF_LIGHT_MAX ? light[x] : RF_LIGHT_MAX] >> 3;
    light[x] = (uint16_t)((2 * light[x] * weight[x] + 2048) / 4096);
    if (light[x] > *brightest)
        *brightest = light[x];
}

void rf_weigh1_c(const struct rf_weigh1_job *job, int n)
{
    for (int x = 0; x < n; x++) {
        uint16_t *brightest = &job->brightest[x / RF_TILE];

        weigh_pixel(job->near_weight, job->near, brightest, job->light_weight, x);
        weigh_pixel(job->far_weight, job->far, brightest, job->light_weight, x);
    }
}

void rf_weigh_chroma_c(uint16_t *chroma, const uint16_t *weight, int n)
{
    for (int i = 0; i < 2 * n; i++)
        chroma[i] = (uint16_t)((chroma[i] * weight[i & ~1] + 2048) / 4096);
}
