/* pyramids.h: the "low resolution" technique of Mulder & van Liere 2000.
 *
 * Two Gaussian pyramids (5 x 5, halved each time) hold the pixels before and behind the focus. A
 * pixel reads both between the two levels whose blurs are nearest to that of the side, and the
 * pixels before the focus, as far as they cover, are composited over the others.
 *
 * The paper has each pixel read the pyramid of its own side alone, and lets the original picture
 * show where that does not cover. Across a wide blur the picture then shines through sharply, so
 * here the other side shows in its place, and pixels before the focus spread over those behind.
 */
#ifndef RF_PYRAMIDS_H
#define RF_PYRAMIDS_H

#include "papers/papers.h"

enum {
    RF_PYRAMID_CHANNELS = 6, /* light times weight, weight, coverage, blur times coverage */
    RF_PYRAMID_LEVELS = 8,   /* level 7 is as wide as a disc of radius 181 */
};

struct rf_pyramid_level {
    int width, height;
    float *plane[RF_PYRAMID_CHANNELS];
};

struct rf_pyramids {
    struct rf_frame *f;
    struct rf_pyramid_level pyramid[2][RF_PYRAMID_LEVELS]; /* before and behind the focus */
    float *half[RF_PYRAMID_CHANNELS];                      /* rows of a level, halved in x */
    int levels, widest[2]; /* the level as wide as the side's largest blur */
    const struct rf_pyramid_level *from;
    struct rf_pyramid_level *to;
};

/* Takes the memory of the arena, or counts it where the arena has none. */
void rf_pyramids_lay_out(struct rf_pyramids *work, const struct rf_limits *limits,
                         struct rf_arena *arena);

/* Makes both pyramids of a frame, no larger than the limits. */
void rf_pyramids_make(struct rf_pyramids *work, struct rf_frame *f);

/* The light of a pixel, as the pyramids show it. */
void rf_pyramids_show(const struct rf_pyramids *work, int x, int y, double light[3]);

#endif
