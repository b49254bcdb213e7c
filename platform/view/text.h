/* text.h: small letters in a window of SDL. */
#ifndef RF_VIEW_TEXT_H
#define RF_VIEW_TEXT_H

#include <SDL.h>

/* Draw capitals, digits and some signs, three pixels by five, enlarged. */
void rf_text(SDL_Renderer *renderer, const char *text, int x, int y, int size);
int rf_text_width(const char *text, int size);

#endif
