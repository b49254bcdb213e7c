/* peaking.h: focus peaking: sharp edges are marked. */
#ifndef RF_CLI_PEAKING_H
#define RF_CLI_PEAKING_H

#include <stdint.h>
#include <refocus/image.h>

/* The photo in grey, of RGB8 into RGB8; green where its brightness changes by more than
 * 20 of 255 to the pixel on the right or below and it is blurred by less than half a
 * pixel. blur: packed radii in 1/256 pixel. */
void peaking_draw(const struct refocus_image *photo, const uint16_t *blur,
                  const struct refocus_image *out);

/* Brightness of a pixel, 0 to 255. */
int peaking_luma(const uint8_t *rgb);

#endif
