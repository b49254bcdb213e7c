/* classify.h: what is measured of clipped pixels to tell a highlight from what is merely white. */
#ifndef RF_CLASSIFY_H
#define RF_CLASSIFY_H

#include "highlights/detect.h"

/* Measures of what may be a highlight, and of what is around it. */
struct rf_measured {
    int64_t own[3], around[3]; /* mean colours of the component and of its surroundings */
    int64_t beyond[3];         /* mean colour 2 or 3 cells away, which the light falls to */
    int64_t base;              /* the brightest channel of `beyond` */
    int64_t edge_light[3];     /* light of the pixels beside the component, less `beyond` or the
                                  surroundings: a sum */
    int pixels;
    int edge, half_lit; /* the component's pixels that lie beside others, and the half lit pixels
                           beside it */
    int fade[2]; /* pixels in its cells and beside them, on the way to its surroundings: the upper
                    part of the way, from 0.4 on, and the lower one, from 0.1 */
};

/* The light that clipping cost a highlight, and what else its pixels have in common. */
struct rf_lost_light {
    int boost[3]; /* Q12 light that a gain of 4 adds, at full strength, */
    int strength; /* 0 to 256; 0: it is no highlight */
    int size, pixels;
};

/* Luminance by Rec. 709, of light of 12 bits. */
static inline int rf_luminance_q12(int r, int g, int b)
{
    return (218 * r + 732 * g + 74 * b) / 1024;
}

static inline int rf_mean_luminance(const int64_t colour[3])
{
    return rf_luminance_q12((int)colour[0], (int)colour[1], (int)colour[2]);
}

/* The pixel in the middle of a cell, in one direction. */
static inline int rf_middle_of(const struct rf_cell_photo *p, int cell, int pixels)
{
    return rf_within(cell * p->cell + p->cell / 2, pixels - 1);
}

/* The colour in the middle of a cell of the photo. */
static inline void rf_sample_cell(const struct rf_cell_photo *p, int x, int y, int colour[3])
{
    rf_colour_at(p, rf_middle_of(p, x, p->width), rf_middle_of(p, y, p->height), colour);
}

/* Adds the colours of the clipped pixels of a cell up; returns how many these are. */
int rf_add_clipped(const struct rf_cell_photo *p, int x, int y, int64_t own[3]);

/* Measures mean colours of a body, and of a sparse grid around the component that it is trimmed
 * from. False: there is nothing around. */
bool rf_measure_colours(const struct rf_cell_photo *p, const struct rf_component *body,
                        const struct rf_component *component, struct rf_measured *m);

/* Measures what lies beyond a body's edge, and then the edge: where the body meets a
 * limb, there is nothing to be told. The body of a photo with `core` set is a core, whose glow is
 * no limb. */
void rf_measure_edge(const struct rf_cell_photo *p, const struct rf_component *body,
                     const struct rf_component *component, struct rf_measured *m);

/* Gives the edge of a core in its own glow the colour of the glow. */
void rf_measure_glow(const struct rf_cell_photo *p, const struct rf_component *core,
                     struct rf_measured *m);

/* How much brighter it is than its surroundings, 0 to 256: from `halves` / 2 times as bright on,
 * and wholly at 3/2 of that. */
int rf_isolation(const struct rf_measured *m, int halves);

/* Q12 light of full strength: the colour of the edge, white if it has none. */
void rf_boost_of(const int64_t edge_light[3], int boost[3]);

/* Lists a clipped pixel as part of a highlight. */
void rf_list_pixel(struct rf_detection *d, int x, int y, const struct rf_lost_light *light);

#endif
