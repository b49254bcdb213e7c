/* pull_mix.h: what two parents of the inpainting pyramid make together. */
#ifndef RF_KERNELS_PULL_MIX_H
#define RF_KERNELS_PULL_MIX_H

#include <stdbool.h>
#include <stdint.h>

#include "kernels/background.h"

/* The blurs of a nearer and of a farther parent: near and far from the child, that is. */
struct rf_two_blurs {
    int16_t near, far;
};

static inline bool rf_is_deeper(int blur, int other, int16_t apart)
{
    return apart < INT16_MAX && blur - other > apart;
}

/* Whether the other one's light does not count: it is known, and not merely continued. */
static inline bool rf_is_alone(int blur, int other, int16_t apart)
{
    return rf_is_deeper(blur, other, apart) && !(other & RF_INPAINTED);
}

static inline uint16_t rf_mix_light(unsigned near, unsigned far, struct rf_two_blurs blur,
                                    int16_t apart)
{
    if (rf_is_alone(blur.near, blur.far, apart))
        return (uint16_t)near;
    if (rf_is_alone(blur.far, blur.near, apart))
        return (uint16_t)far;
    return (uint16_t)((3 * near + far + 2) >> 2);
}

static inline int16_t rf_mix_blur(struct rf_two_blurs blur, int16_t apart)
{
    return rf_is_deeper(blur.far, blur.near, apart) ? blur.far : blur.near;
}

static inline int16_t rf_inpainted_blur(struct rf_two_blurs blur, int16_t apart)
{
    return (int16_t)(rf_mix_blur(blur, apart) | RF_INPAINTED);
}

#endif
