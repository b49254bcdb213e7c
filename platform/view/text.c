/* text.c: small letters are drawn into the window, three pixels by five, enlarged. */
#include "text.h"

/* Rows of three pixels from the top, the left one the highest bit of each octal digit.
 */
static const struct {
    char letter;
    unsigned rows;
} glyphs[] = {
    {'A', 025755}, {'B', 065656}, {'C', 034443}, {'D', 065556}, {'E', 074647}, {'F', 074644},
    {'G', 034553}, {'H', 055755}, {'I', 072227}, {'J', 011152}, {'K', 055655}, {'L', 044447},
    {'M', 057755}, {'N', 065555}, {'O', 025552}, {'P', 065644}, {'Q', 025563}, {'R', 065655},
    {'S', 034216}, {'T', 072222}, {'U', 055557}, {'V', 055522}, {'W', 055775}, {'X', 055255},
    {'Y', 055222}, {'Z', 071247}, {'0', 025552}, {'1', 026227}, {'2', 061247}, {'3', 061216},
    {'4', 055711}, {'5', 074616}, {'6', 034752}, {'7', 071222}, {'8', 025252}, {'9', 025716},
    {'.', 000002}, {'/', 011244}, {'+', 002720}, {'-', 000700}, {':', 002020}, {',', 000024},
    {'[', 064446}, {']', 031113}, {'=', 007070}, {'%', 051245},
};

static unsigned rows_of(char letter)
{
    if (letter >= 'a' && letter <= 'z')
        letter = (char)(letter - 'a' + 'A');
    for (size_t i = 0; i < sizeof glyphs / sizeof *glyphs; i++)
        if (glyphs[i].letter == letter)
            return glyphs[i].rows;
    return 0;
}

void rf_text(SDL_Renderer *renderer, const char *text, int x, int y, int size)
{
    for (; *text; text++, x += 4 * size) {
        const unsigned rows = rows_of(*text);

        for (int i = 0; i < 15; i++) {
            const SDL_Rect dot = {x + i % 3 * size, y + i / 3 * size, size, size};

            if (rows >> (14 - i) & 1)
                SDL_RenderFillRect(renderer, &dot);
        }
    }
}

int rf_text_width(const char *text, int size)
{
    return 4 * size * (int)SDL_strlen(text) - size;
}
