#include "colour/transfer.h"
#include "kernels/kernels.h"

enum { LARGE = 16384 }; /* twice that is no signed 16-bit number */

static int weigh_light(int light, int weight)
{
    return light < LARGE ? (2 * light * weight + 2048) / 4096 : (light * weight + 2048) / 4096 * 2;
}

/* Pixel x of a layer. */
static void weigh_pixel(uint16_t *weight, uint16_t *const light[3], uint16_t *brightest,
                        const uint16_t *light_weight, int x)
{
    int most = 0;

    for (int c = 0; c < 3; c++)
        most = light[c][x] > most ? light[c][x] : most;
    weight[x] = light_weight[most < RF_LIGHT_MAX ? most : RF_LIGHT_MAX] >> 3;
    for (int c = 0; c < 3; c++) {
        light[c][x] = (uint16_t)weigh_light(light[c][x], weight[x]);
        if (light[c][x] > *brightest)
            *brightest = light[c][x];
    }
}

void rf_weigh_c(const struct rf_weigh_job *job, int n)
{
    for (int x = 0; x < n; x++) {
        uint16_t *brightest = &job->brightest[x / RF_TILE];

        weigh_pixel(job->near_weight, job->near, brightest, job->light_weight, x);
        weigh_pixel(job->far_weight, job->far, brightest, job->light_weight, x);
    }
}
