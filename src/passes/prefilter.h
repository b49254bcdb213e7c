/* prefilter.h: smooths light where rays lie so far apart that they would miss pixels.
 *
 * Rays of a set of N hit the picture |s| sqrt(pi / N) pixels apart. Step 0 closes gaps from 1.5
 * pixels on; steps 1 to 6 close those twice to 64 times as wide; steps 3 and 4 are there where
 * blurs may exceed 54 pixels, steps 5 and 6 where they may exceed 127. Each step goes, where |s| is
 * above above[step], over three rows and then three columns, 2^step pixels apart: a third of the
 * way to those pixels whose blur is within an eighth of its own (one pixel to two, of blurs in
 * units one unit to two) of that of the middle one. Light is left as it is elsewhere.
 */
#ifndef RF_PREFILTER_H
#define RF_PREFILTER_H

#include "aperture/ray_set.h"
#include "image/chroma.h"
#include "image/planes.h"
#include "image/viewport.h"
#include "support/executor.h"
#include "tiles/bins.h"

enum { RF_PREFILTER_STEPS = 7 };

/* The most steps of a frame with blurs up to that radius, which its margins have to hold; a frame
 * whose rays gather highlights has 3 up to 127 pixels. 64 rays lie 12 pixels apart from 54 pixels
 * of blur on, and 28 at 127. */
static inline int rf_prefilter_most_steps(float max_blur_radius)
{
    return max_blur_radius > RF_PLAIN_RADIUS ? RF_PREFILTER_STEPS : max_blur_radius > 54 ? 5 : 3;
}

/* Chroma of a photo of Y, U and V: distances are in its samples, so it has bounds of its own. */
struct rf_prefilter_chroma {
    struct rf_chroma_size size;
    int above[RF_PREFILTER_STEPS];
    int steps;                   /* as below */
    struct rf_blur_q8 blur;      /* read: of each sample */
    struct rf_chroma_q12 light;  /* read */
    struct rf_chroma_q12 spare;  /* overwritten */
    struct rf_chroma_q12 smooth; /* written, with its border */
};

struct rf_prefilter {
    int above[RF_PREFILTER_STEPS]; /* |s| that each step begins at, as it is stored */
    bool fades;                    /* steps come in over rf_prefilter_over() more of |s|, so that
                                      nothing jumps while the focus moves */
    int steps;                     /* rf_prefilter_steps() */
    const struct rf_bins *bins;    /* read: of each tile */
    struct rf_blur_q8 blur;        /* read */
    struct rf_light_q12 light;     /* read */
    struct rf_light_q12 spare;     /* read in step 0: the light of tiles that highlights are
                                      subtracted in (rf_bins.subtracted); then overwritten */
    struct rf_light_q12 smooth;    /* written, with its border */
    const struct rf_prefilter_chroma *chroma; /* NULL: a photo of R, G and B; else light is
                                                 luminance, in channel[0] alone */
};

/* Sets the |s|, as it is stored, from which on the rays of a preset lie 1.5, 3, 6 and so on
 * pixels apart: for 64 rays 6.8, 13.5, 27.1 to 433 pixels. Those that are not below `largest`,
 * stored alike, those beyond `steps`, and those of the rays of every pixel become INT16_MAX. */
void rf_prefilter_bounds(int above[RF_PREFILTER_STEPS], int steps, int rays, int largest, int unit);

/* The number of steps for blurs of up to `largest`: an odd one, as light is there and back between
 * two planes. */
static inline int rf_prefilter_steps(const int above[RF_PREFILTER_STEPS], float largest)
{
    int steps = 1;

    while (steps < RF_PREFILTER_STEPS && largest > (float)above[steps])
        steps += 2;
    return steps;
}

/* Sets the |s| at which gaps between the rays of chroma, in its samples, are as wide as those of
 * luma are at luma_above. */
void rf_prefilter_chroma_bounds(int above[RF_PREFILTER_STEPS],
                                const int luma_above[RF_PREFILTER_STEPS],
                                const struct rf_ray_set *set);

static inline int rf_prefilter_over(int above, bool fades)
{
    return fades && above >= 8 ? above / 4 : 1;
}

/* Writes the smooth light of the whole window, working in a share of rf_prefilter_share() bytes. */
void rf_prefilter(const struct rf_executor *exec, const struct rf_viewport *view,
                  const struct rf_prefilter *pass);
uint64_t rf_prefilter_share(void);

#endif
