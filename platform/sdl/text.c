/* text.c: lines of text in a window of SDL, by SDL2_ttf where the build has it. */
#include "text.h"

#ifdef RF_HAVE_TTF
#include <SDL_ttf.h>

struct rf_text {
    SDL_Renderer *renderer;
    TTF_Font *font;
    int size;
};

static const char *const fonts[] = {
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", /* Debian */
    "/usr/share/fonts/truetype/noto/NotoSans-Regular.ttf",
    "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf",
    "/usr/share/fonts/truetype/liberation2/LiberationSans-Regular.ttf",
    "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf", /* Fedora */
    "/usr/share/fonts/TTF/DejaVuSans.ttf",               /* Arch */
    "/usr/share/fonts/ttf/DejaVuSans.ttf",               /* Yocto */
    "/usr/share/fonts/ttf/LiberationSans-Regular.ttf",
};

/* The size that fonts are opened with; it is set again before anything is drawn. */
enum { FIRST_SIZE = 16 };

static TTF_Font *open_any(void)
{
    TTF_Font *font = NULL;

    for (size_t i = 0; i < sizeof fonts / sizeof *fonts && !font; i++)
        font = TTF_OpenFont(fonts[i], FIRST_SIZE);
    return font;
}

struct rf_text *rf_text_open(SDL_Renderer *renderer, const char *font, char *reason)
{
    struct rf_text *text = SDL_calloc(1, sizeof *text);

    if (!text || TTF_Init() != 0) {
        SDL_snprintf(reason, 256, "%s", text ? TTF_GetError() : "not enough memory");
        SDL_free(text);
        return NULL;
    }
    text->renderer = renderer;
    text->font = font ? TTF_OpenFont(font, FIRST_SIZE) : open_any();
    if (!text->font) {
        SDL_snprintf(reason, 256, "%s", TTF_GetError());
        rf_text_close(&text);
    }
    return text;
}

void rf_text_close(struct rf_text **text)
{
    if (!*text)
        return;
    if ((*text)->font)
        TTF_CloseFont((*text)->font);
    TTF_Quit();
    SDL_free(*text);
    *text = NULL;
}

void rf_text_set_size(struct rf_text *text, double size)
{
    const int whole = (int)(size + 0.5);

    /* Points of 72 dpi are pixels; setting a size forgets the letters that were drawn. */
    if (whole != text->size && TTF_SetFontSize(text->font, whole) == 0)
        text->size = whole;
}

int rf_text_width(struct rf_text *text, const char *words)
{
    int width = 0;

    TTF_SizeUTF8(text->font, words, &width, NULL);
    return width;
}

int rf_text_height(const struct rf_text *text)
{
    return TTF_FontHeight(text->font);
}

void rf_text_draw(struct rf_text *text, const char *words, int x, int y, SDL_Color color)
{
    SDL_Surface *const surface = TTF_RenderUTF8_Blended(text->font, words, color);
    SDL_Texture *const texture =
        surface ? SDL_CreateTextureFromSurface(text->renderer, surface) : NULL;

    if (texture) {
        const SDL_Rect place = {x, y, surface->w, surface->h};

        SDL_RenderCopy(text->renderer, texture, NULL, &place);
        SDL_DestroyTexture(texture);
    }
    SDL_FreeSurface(surface);
}
#else
struct rf_text *rf_text_open(SDL_Renderer *renderer, const char *font, char *reason)
{
    (void)renderer;
    (void)font;
    SDL_snprintf(reason, 256, "this build draws no text; build it with SDL2_ttf");
    return NULL;
}

void rf_text_close(struct rf_text **text)
{
    (void)text;
}

void rf_text_set_size(struct rf_text *text, double size)
{
    (void)text;
    (void)size;
}

int rf_text_width(struct rf_text *text, const char *words)
{
    (void)text;
    (void)words;
    return 0;
}

int rf_text_height(const struct rf_text *text)
{
    (void)text;
    return 0;
}

void rf_text_draw(struct rf_text *text, const char *words, int x, int y, SDL_Color color)
{
    (void)text;
    (void)words;
    (void)x;
    (void)y;
    (void)color;
}
#endif
