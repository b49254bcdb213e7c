/* stereo_views.h: the views of eyes beside the camera: a photo and its disparities are warped
 * sideways, and rendered through the lens there. Disoccluded pixels are filled from the far side.
 */
#ifndef RF_CLI_STEREO_VIEWS_H
#define RF_CLI_STEREO_VIEWS_H

#include "shot/shot.h"

enum { STEREO_MOST = 256 }; /* pixels of parallax */

/*
 * Warp a packed RGB8 photo with packed disparities of its size into another of each. A
 * pixel of disparity d moves by
 *
 *     parallax (d - focus)  pixels to the right
 *
 * in steps of 1/256, so that the plane in focus stays where it is; the nearest that
 * hits a pixel wins. nearest: room for a row. All in integers: the same bits
 * everywhere.
 */
void stereo_warp(const struct refocus_image *photo, const uint16_t *disparity, double focus,
                 double parallax, const struct refocus_image *view, uint16_t *seen,
                 int32_t *nearest);

struct stereo {
    struct refocus_image view;
    uint16_t *disparity, *seen;
    int32_t *nearest;
};

/* These return exit codes and print why it is not EXIT_DONE. */

/* Called with an open shot, before anything else is prepared with its engine. */
int stereo_open(struct stereo *stereo, const struct shot *shot);

/* Render what an eye sees by the lens setting of the engine. */
int stereo_render(const struct stereo *stereo, struct shot *shot, double parallax,
                  const struct refocus_image *out);

/* Called after stereo_open(), whatever it returned. */
void stereo_close(struct stereo *stereo);

#endif
