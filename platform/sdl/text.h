/* text.h: lines of text in a window of SDL, by SDL2_ttf where the build has it. */
#ifndef RF_SDL_TEXT_H
#define RF_SDL_TEXT_H

#include <SDL.h>

struct rf_text;

/* The font of a file, or where it is NULL the first that is there of DejaVu Sans, Noto Sans and
 * Liberation Sans, in the folders of Debian and some others. NULL: there is none, and reason
 * (256 bytes) says why. */
struct rf_text *rf_text_open(SDL_Renderer *renderer, const char *font, char *reason);
void rf_text_close(struct rf_text **text);

/* Set the font's size in pixels; the size to begin with is none. */
void rf_text_set_size(struct rf_text *text, double size);

int rf_text_width(struct rf_text *text, const char *words);
int rf_text_height(const struct rf_text *text);
void rf_text_draw(struct rf_text *text, const char *words, int x, int y, SDL_Color color);

#endif
