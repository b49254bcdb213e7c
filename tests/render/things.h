/* things.h: bright things drawn into test pictures, of known light, their edges lit in
 * part. */
#ifndef TEST_THINGS_H
#define TEST_THINGS_H

#include "pictures.h"

/* Centred at the origin. */
struct thing {
    enum { ELLIPSE, BOX, DIAMOND } kind;
    double wide, high; /* size of the whole thing */
    double light[3];
};

bool is_in_thing(const struct thing *t, double x, double y);

/* Share of the pixel from (x, y) to (x + 1, y + 1) that lies in it. */
double share_of_thing(const struct thing *t, double x, double y);

/* Over what the picture has, centred at (cx, cy), pixels. */
void draw_thing(struct picture *p, const struct thing *t, double cx, double cy);

/* Adds the light that a lens leaves around a thing of that area and light, centred at (cx, cy): a
 * share of all it has, which falls off with the square of the distance. Without it nothing tells a
 * lamp from white paint. */
void draw_skirt(struct picture *p, double cx, double cy, double area, const double light[3],
                double share);

/* A dark picture of noise with 150 lights of all shapes and sizes. */
struct picture night(uint32_t seed, int w, int h);

#endif
