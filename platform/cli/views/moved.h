/* moved.h: what putting the edges of a depth map on the photo's has changed. */
#ifndef RF_CLI_MOVED_H
#define RF_CLI_MOVED_H

#include <stdint.h>
#include <refocus/image.h>

/* The photo in grey, of RGB8 into RGB8: orange where `disparity`, packed and of the photo's size,
 * is nearer than `given`, blue where it is farther, the more so the more it differs, from 1/255 on.
 * `given` is brought to the photo's size by straight lines. NULL: nothing has changed. */
void moved_draw(const struct refocus_image *photo, const uint16_t *disparity,
                const struct refocus_disparity *given, const struct refocus_image *out);

#endif
