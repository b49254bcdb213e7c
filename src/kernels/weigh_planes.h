/* weigh_planes.h: the template of weigh, which multiplies light by the weights of eq. 5. */
#ifndef RF_KERNELS_WEIGH_PLANES_H
#define RF_KERNELS_WEIGH_PLANES_H

#include "colour/transfer.h"
#include "kernels/kernels.h"

#include <assert.h>

enum { RF_LARGE_LIGHT = 16384 }; /* twice that is no signed 16-bit number */
static_assert(2 * (RF_LARGE_LIGHT - 1) <= INT16_MAX, "twice any less is one");
static_assert(4 * RF_LIGHT_MAX < RF_LARGE_LIGHT, "light of one plane is less");

/* Light of one plane is always less than RF_LARGE_LIGHT. */
static inline int rf_weigh_light(int light, int weight)
{
    return light < RF_LARGE_LIGHT ? (2 * light * weight + 2048) / 4096
                                  : (light * weight + 2048) / 4096 * 2;
}

/* Pixel x of a layer. */
static RF_ALWAYS_INLINE void rf_weigh_pixel(uint16_t *weight, uint16_t *const *light,
                                            uint16_t *brightest, const uint16_t *light_weight,
                                            int x, const int planes)
{
    int most = 0;

    for (int c = 0; c < planes; c++)
        most = light[c][x] > most ? light[c][x] : most;
    weight[x] = light_weight[most < RF_LIGHT_MAX ? most : RF_LIGHT_MAX] >> 3;
    for (int c = 0; c < planes; c++) {
        light[c][x] = (uint16_t)rf_weigh_light(light[c][x], weight[x]);
        if (light[c][x] > *brightest)
            *brightest = light[c][x];
    }
}

static RF_ALWAYS_INLINE void rf_weigh_planes(const struct rf_weigh_job *job, int n,
                                             const int planes)
{
    for (int x = 0; x < n; x++) {
        uint16_t *brightest = &job->brightest[x / RF_TILE];

        rf_weigh_pixel(job->near_weight, job->near, brightest, job->light_weight, x, planes);
        rf_weigh_pixel(job->far_weight, job->far, brightest, job->light_weight, x, planes);
    }
}

#endif
