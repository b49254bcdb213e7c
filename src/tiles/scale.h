/* scale.h: which bin a blur is in, and the least blur of a bin. */
#ifndef RF_SCALE_H
#define RF_SCALE_H

#include <stdbool.h>

#include "image/planes.h"

/*
 * Bins of signed blur: a sixteenth of a pixel wide where none exceeds 7.5 pixels, an eighth up to
 * 15.5, a quarter up to 31.5, half up to 63.5, then whole pixels. The middle of a slab, by which
 * rays look, moves by half a bin as a surface comes to the next one, and many rays then hit the
 * next pixel at once: the narrower the bins, the more evenly a pull of the focus goes. Their edges
 * lie so that |s| < 1/2 pixel, the blurs that leave a pixel as it
 * is, are whole bins. Blurs in units of two pixels and more have bins of a pixel up to 31.5, and
 * from there on of a sixteenth of the octave: 2 pixels up to 63.5, 4 up to 127.5, and so on.
 */
struct rf_bin_scale {
    int shift;      /* a bin is 1 << shift in Q7.8 */
    int focus;      /* first bin of |s| < 1/2 pixel */
    int focus_bins; /* bins of |s| < 1/2 pixel */
    int unit;       /* unit of the blurs: image/planes.h */
    bool joins;     /* blurs differ by less than 2^15 */
};
/* Bins of blurs with a unit are of whole pixels p, half a pixel around each: |p| itself up to
 * RF_FINE, then RF_OCTAVE to an octave. */
enum { RF_FINE = 32, RF_OCTAVE = 16 };
/* The place of pixels p >= 0 among the bins, and the least p of a place. */
static inline int rf_place_of(int p)
{
    int octave = 0;

    while (p >> octave >= RF_FINE)
        octave++;
    return octave ? (p >> octave) + octave * RF_OCTAVE : p;
}

static inline int rf_least_of(int place)
{
    const int octave = place < RF_FINE ? 0 : (place - RF_OCTAVE) / RF_OCTAVE;

    return octave ? (place - octave * RF_OCTAVE) << octave : place;
}

static inline int rf_bin_of(struct rf_bin_scale scale, int s)
{
    const int p = (rf_in_pixels(s, scale.unit) + 128) >> 8;

    if (!scale.unit)
        return ((s + 128) >> scale.shift) + scale.focus;
    return scale.focus + (p < 0 ? -rf_place_of(-p) : rf_place_of(p));
}

/* Least blur of a bin. */
static inline int rf_edge_of(struct rf_bin_scale scale, int bin)
{
    const int place = bin - scale.focus;

    if (!scale.unit)
        return place * (1 << scale.shift) - 128;
    return ((place < 0 ? 1 - rf_least_of(1 - place) : rf_least_of(place)) * 256 - 128) >>
           scale.unit;
}

#endif
