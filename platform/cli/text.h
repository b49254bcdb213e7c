/* Letters of dots for pictures: small letters, digits, and .+-=: between them. */
#ifndef RF_CLI_TEXT_H
#define RF_CLI_TEXT_H

#include <stdbool.h>

enum { GLYPH_WIDTH = 5, GLYPH_HEIGHT = 7 };

/* Whether dot (x, y) of a letter is ink; letters that there are none of are blank. */
bool text_dot(char letter, int x, int y);

#endif
