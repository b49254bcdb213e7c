/* text.h: letters of dots for pictures: small letters, digits and . + - = / : , _ */
#ifndef RF_CLI_TEXT_H
#define RF_CLI_TEXT_H

#include <stdbool.h>
#include <refocus/image.h>

enum { GLYPH_WIDTH = 5, GLYPH_HEIGHT = 7 };

/* Whether dot (x, y) of a letter is ink; letters that there are none of are blank. */
bool text_dot(char letter, int x, int y);

/* A line in light grey, in dots of zoom x zoom pixels, into RGB8; capitals become small
 * letters. What does not fit into `room` pixels from left on is cut off; the line has
 * to lie within the picture otherwise. */
void text_draw(const struct refocus_image *image, int left, int top, int zoom, int room,
               const char *text);

#endif
