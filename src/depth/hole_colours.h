/* hole_colours.h: what the photo shows at the samples of a depth map that has holes. */
#ifndef RF_DEPTH_HOLE_COLOURS_H
#define RF_DEPTH_HOLE_COLOURS_H

#include <stddef.h>
#include <stdint.h>

#include <refocus/image.h>

/* The state of a sample when rf_fill_holes() begins. */
enum { RF_SAMPLE_KNOWN = 0, RF_SAMPLE_UNKNOWN = 255 };

enum { RF_HOLE_COLOUR_BYTES = 6 }; /* six bytes a sample, in both */

/* Colours, three bytes a sample, row after row; NULL: there is no photo. */
struct rf_hole_colours {
    int width, height; /* samples */
    uint8_t *own;      /* the photo's, in the middle of the sample */
    uint8_t *surface;  /* the one of the surface whose disparity it has, or took */
};

/* Takes the colours of the samples from a packed photo of the same view and of any size. */
void rf_hole_colours_load(const struct rf_hole_colours *colours, const struct refocus_image *photo);

/* Sets the surface's colour at a known sample: the mean, half up, of those of its eight neighbours
 * and its own that are known and within `continuous` of its disparity. One pixel alone may be
 * mixed, or noise. */
void rf_hole_colours_settle(const struct rf_hole_colours *colours, const uint16_t *disparity,
                            ptrdiff_t stride, const uint8_t *state, int x, int y, int continuous);

/* The greatest difference, over the channels, of a sample's own colour and of that of the surface
 * at another. */
static inline uint32_t rf_hole_colours_apart(const struct rf_hole_colours *colours, size_t at,
                                             size_t other)
{
    const uint8_t *own = colours->own + 3 * at, *surface = colours->surface + 3 * other;
    uint32_t most = 0;

    for (int c = 0; c < 3; c++) {
        const uint32_t apart =
            (uint32_t)(own[c] > surface[c] ? own[c] - surface[c] : surface[c] - own[c]);

        most = apart > most ? apart : most;
    }
    return most;
}

#endif
