/* steady.h: light of a video's highlights that follows the last frame's. */
#ifndef RF_HIGHLIGHTS_STEADY_H
#define RF_HIGHLIGHTS_STEADY_H

#include "highlights/highlights.h"

/* Light of two frames is compared only if all of this is the same. */
struct rf_frame_of_light {
    int32_t width, height; /* 0: there is none */
    int32_t blend;
    float estimate;
};

/* The light of the highlights around each cell of the last frame. */
struct rf_last_light {
    struct rf_frame_of_light of;
    uint32_t frames; /* one after the other, up to this one */
    float *light;    /* rf_steady_cells() of them */
};

uint64_t rf_steady_cells(int max_width, int max_height);

/* Brings the light of a frame's highlights near the last frame's, which this one replaces: of small
 * changes, the part `keep`, 0 to 1, is left out. Works in `scratch`, rf_steady_cells() of them. */
void rf_steady_highlights(struct rf_highlights *highlights, struct rf_last_light *last,
                          const struct rf_frame_of_light *frame, float keep, float *scratch);

#endif
