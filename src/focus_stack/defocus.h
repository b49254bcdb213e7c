/* defocus.h: how the light of a pixel spreads over its circle of confusion, in the photo of a focus
 * stack: a disc of taps, and places in the photo and in its depth. */
#ifndef RF_FOCUS_STACK_DEFOCUS_H
#define RF_FOCUS_STACK_DEFOCUS_H

#include "focus_stack/focus_stack.h"

enum {
    RF_DEFOCUS_TAPS = 10, /* along a radius, at the most */
    RF_DEFOCUS_SIZE = 2 * RF_DEFOCUS_TAPS + 1,
    RF_DEFOCUS_ONE = 1 << 16, /* all light of a pixel */
};

/* A disc of taps: `apart` pixels lie between neighbours, and `taps` on either side of the middle.
 */
struct rf_defocus {
    int apart, taps;
    uint8_t distance[RF_DEFOCUS_SIZE][RF_DEFOCUS_SIZE]; /* Q4 taps from the middle */
    /* The weight of a tap by the radius in Q4 taps: all of a disc make RF_DEFOCUS_ONE. */
    uint32_t weight[16 * (RF_DEFOCUS_TAPS + 1) + 1];
};

/* A disc for radii up to this one, in pixels. */
void rf_defocus_make(struct rf_defocus *disc, double radius);

/* The share of a circle of confusion, radius in Q4 taps, that a tap takes. */
static inline uint32_t rf_defocus_share(const struct rf_defocus *disc, int radius, int i, int j)
{
    const int distance = disc->distance[j + RF_DEFOCUS_TAPS][i + RF_DEFOCUS_TAPS];

    return (uint32_t)rf_stack_clamp(radius + 8 - distance, 16) * disc->weight[radius];
}

/* The sample of depth that a pixel lies in. */
static inline size_t rf_defocus_sample(const struct refocus_stack *s, int x, int y)
{
    return (size_t)rf_stack_clamp(y / s->reduced, s->rows - 1) * (size_t)s->columns +
           (size_t)rf_stack_clamp(x / s->reduced, s->columns - 1);
}

/* The blur radius K in pixels of the photo's whole range, once `moved` has disparities; 0: no blur
 * explains the frames. */
double rf_defocus_find_radius(const struct refocus_stack *stack,
                              const struct rf_stack_photo *photo);

#endif
