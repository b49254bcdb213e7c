/* map_shape.h: a depth map has its photo's shape, or lies on its side and is turned. */
#ifndef RF_CLI_MAP_SHAPE_H
#define RF_CLI_MAP_SHAPE_H

#include <stdbool.h>
#include <refocus/refocus.h>

/* A map of another picture, or one that lies on its side: neither is stretched to fit.
 * Cameras' 4:3 and 16:9 go together, and a square is what networks make of any picture;
 * of a few samples the shape says nothing. */
bool shape_is_another(int width, int height, const struct refocus_image *photo);

/* Whether a picture has another shape as it lies, and the photo's once it is turned. */
bool shape_lies_on_its_side(int width, int height, const struct refocus_image *photo);

/* Whether a picture has the shape of one of two that lie side by side in the photo, and not the
 * photo's. */
bool shape_is_of_half(int width, int height, const struct refocus_image *photo);

/* An exit code, and prints why it is not EXIT_DONE: the shape is another. A shape that is off by
 * more than an eighth is told of. `what` names what has it. */
int shape_check(const char *file, int width, int height, const struct refocus_image *photo,
                const char *what);

#endif
