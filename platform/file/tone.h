/* tone.h: the tones in which a photo's base rendition shows light, as the photo itself has them. */
#ifndef RF_FILE_TONE_H
#define RF_FILE_TONE_H

#include <stdbool.h>
#include <stdint.h>

#include <refocus/image.h>

#include "half.h"

/* Curves of cells of the photo have knots at each quarter of an octave of light. */
enum {
    RF_TONE_CELLS = 12,    /* along the longer side, at the most */
    RF_TONE_BLOCKS = 64,   /* so are the blocks whose mean light is known */
    RF_TONE_STEP = 256,    /* halves from knot to knot */
    RF_TONE_MOST = 0x4c00, /* 16: what is above counts as that */
    RF_TONE_KNOTS = RF_TONE_MOST / RF_TONE_STEP + 2
};

/* Light of the base rendition at the knots, by channel. */
struct rf_tone_curves {
    float shown[3][RF_TONE_KNOTS];
};

struct rf_tone {
    bool by_brightest; /* channels are scaled alike, by the brightest of them: it has a curve */
    int width, height; /* pixels of the photo */
    int across, down;  /* cells */
    struct rf_tone_curves curves[RF_TONE_CELLS * RF_TONE_CELLS];
    int blocks_across, blocks_down;
    float mean[RF_TONE_BLOCKS * RF_TONE_BLOCKS][3]; /* light of the photo in each block */
    float light[256];                               /* light for each code of sRGB */
    float code[4097]; /* code of sRGB, 0 to 255, of light (i / 4096)^2 */
};

/* Curves of a cell. */
static inline int rf_tone_channels(const struct rf_tone *tone)
{
    return tone->by_brightest ? 1 : 3;
}

static inline int rf_tone_brightest(const uint16_t light[3])
{
    const int c = light[1] > light[0] ? 1 : 0;

    return light[2] > light[c] ? 2 : c;
}

/* Light as curves know it. */
static inline uint16_t rf_tone_saturated(uint16_t half)
{
    return half < RF_TONE_MOST ? half : RF_TONE_MOST;
}

/* Light of a code of sRGB. */
float rf_tone_light(int code);

/* Find the tones from a base rendition, RGB8, and its true light, packed halves.
 * Returns REFOCUS_OK or REFOCUS_ERR_MEMORY. */
int rf_tone_fit(struct rf_tone *tone, const struct refocus_image *base,
                const struct refocus_image *light, bool by_brightest);

/* A part of a photo that was refocused. */
struct rf_tone_part {
    const struct refocus_image *own, *base;  /* light and codes of the photo */
    const struct refocus_image *light, *out; /* the part itself; halves are at any address */
    int x, y;                                /* column and row of its first pixel */
    const uint8_t *thresholds;               /* 0 to 63, 8 by 8, by row and column modulo 8 */
};

/* Pixels whose light did not change keep their code. */
void rf_tone_encode(const struct rf_tone *tone, const struct rf_tone_part *part);

#endif
