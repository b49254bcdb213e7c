/* tone.h: the tones in which a photo's base rendition shows light, as the photo itself has them. */
#ifndef RF_FILE_TONE_H
#define RF_FILE_TONE_H

#include <stdbool.h>
#include <stdint.h>

#include <refocus/image.h>

#include "half.h"

struct rf_tone {
    bool by_brightest;             /* channels are scaled alike, by the brightest of them */
    float shown[RF_HALF_MOST + 1]; /* light of the base rendition for each half of true light */
    float light[256];              /* light for each code of sRGB */
    float code[4097];              /* code of sRGB, 0 to 255, of light (i / 4096)^2 */
};

/* Light of a code of sRGB. */
float rf_tone_light(int code);

/* Find the tones from a base rendition, RGB8, and its true light, packed halves.
 * Returns REFOCUS_OK or REFOCUS_ERR_MEMORY. */
int rf_tone_fit(struct rf_tone *tone, const struct refocus_image *base,
                const struct refocus_image *light, bool by_brightest);

/* A row of refocused light, halves at any address, and its pixels before that. */
struct rf_tone_row {
    const uint16_t *own; /* light */
    const uint8_t *base; /* codes of it */
    const uint8_t *light;
    uint8_t *out;
    int width, x;              /* pixels; column of the first */
    const uint8_t *thresholds; /* 8, 0 to 63, by column modulo 8 */
};

/* Pixels whose light did not change keep their code. */
void rf_tone_encode(const struct rf_tone *tone, const struct rf_tone_row *row);

#endif
