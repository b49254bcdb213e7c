/* show.h: from a picture of the photo, whole or reduced, to the pixels of the window. */
#ifndef RF_VIEW_SHOW_H
#define RF_VIEW_SHOW_H

#include <stdint.h>
#include <refocus/image.h>
#include "view_state.h"

struct rf_show {
    const uint8_t *rgb; /* packed */
    int width, height;
    int reduction;             /* pixels of the photo for one of these, each way */
    const uint16_t *disparity; /* the photo's disparities, packed */
    int photo_width, photo_height;
    float focus; /* for peaking */
};

/* Draw state's part of the photo into state->width x state->height pixels. scratch:
 * RF_SHOW_SCRATCH numbers a column, and as many again. */
enum { RF_SHOW_SCRATCH = 10 };
void rf_show(const struct rf_show *show, const struct rf_view_state *state, uint32_t *pixels,
             uint32_t *scratch);

#endif
