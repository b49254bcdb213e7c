/* aperture.h: what an aperture is inside. The public words are in refocus/aperture.h. */
#ifndef RF_APERTURE_H
#define RF_APERTURE_H

#include <refocus/aperture.h>

#include "support/pool.h"

enum rf_shape { RF_SHAPE_DISC, RF_SHAPE_POLYGON, RF_SHAPE_MASK };

/* A reduced mask for spreading rays: a side that a Hilbert curve can fill. */
enum { RF_CURVE_SIDE = 64 };

struct refocus_aperture {
    uint64_t id; /* equal for equal shapes, so that ray sets can be kept */
    enum rf_shape shape;
    int blades;
    double corner_x[16], corner_y[16]; /* units of K, y down, as the mask is seen */
    int width, height;                 /* of the mask picture */
    uint8_t mask[REFOCUS_MAX_APERTURE_SIDE * REFOCUS_MAX_APERTURE_SIDE];
    uint8_t reduced[RF_CURVE_SIDE * RF_CURVE_SIDE]; /* spans -1..1 in x and y */
};

/* The disc that a NULL aperture stands for. */
extern const struct refocus_aperture rf_disc;

/* How far the aperture is open at (x, y), 0 to 255; x, y in units of K, y down. */
int rf_aperture_open(const struct refocus_aperture *aperture, double x, double y);

/* refocus_aperture_rays() and refocus_aperture_full_rays(); what comes back from a cancelled
 * run is of no use. */
int rf_aperture_rays(const struct refocus_aperture *aperture, int count,
                     struct refocus_ray *rays, struct rf_run *run);
int rf_aperture_full_rays(const struct refocus_aperture *aperture, double max_blur_radius,
                          int capacity, struct refocus_ray *rays, struct rf_run *run);

/* sin and cos of a number of turns from IEEE operations alone: the C library's may
 * differ in the last bit from one system to the next. Within 1e-12 for |turns| < 2^20. */
void rf_sincos_turns(double turns, double *sine, double *cosine);

#endif
