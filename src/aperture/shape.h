/* shape.h: the operations of a shape of aperture, one row of them in the file of each shape.
 *
 * A shape is a file of this folder with such a row; refocus_aperture_create() chooses it. A figure
 * needs none: it is an outline with a radius of its own (figures.c).
 */
#ifndef RF_SHAPE_H
#define RF_SHAPE_H

#include <stdbool.h>

#include <refocus/aperture.h>

struct rf_run;

/* A corner of the outline, units of K, y down, as the mask is seen. */
struct rf_corner {
    double x, y;
};

struct rf_shape {
    /* The light at (x, y), 0 to 255; units of K, y down. */
    int (*open)(const struct refocus_aperture *a, double x, double y);

    /* Spreads `count` rays of equal light, for blurs before the focus or behind it. */
    void (*rays)(const struct refocus_aperture *a, int count, bool before, struct refocus_ray *rays,
                 struct rf_run *run);

    /* The outline as a closed polygon: how many corners it has, and one of them. Both are NULL
     * where a shape has no such outline, which then is cut off as a circle is (cat_eye.h). */
    int (*corners)(const struct refocus_aperture *a);
    struct rf_corner (*corner)(const struct refocus_aperture *a, int i);

    bool is_fine;      /* it may have structure much finer than itself */
    bool fills_square; /* it may be open outside of the circle of radius K */
};

extern const struct rf_shape rf_shape_polygon, rf_shape_mask, rf_shape_outline;

/* Creates an aperture of a shape, of which only the id and the squeeze, 1, are set. */
int rf_shape_create(struct refocus_aperture **aperture, const struct rf_shape *shape);

/* Creates an iris or a figure. */
int rf_outline_create(struct refocus_aperture **aperture, const struct refocus_aperture_params *p);

/* The radius of an iris or a figure that is not turned, 0 to 1, in a direction. */
double rf_outline_radius(const struct refocus_aperture_params *p, double turns);

/* Continues a hash, or begins one with a number that no other shape begins with. */
uint64_t rf_shape_hash(uint64_t hash, const void *bytes, size_t size);

/* The light, 0 to 255, of a place that is open by `open` and whose rho^2 is `square`. */
int rf_shape_light(const struct refocus_aperture *a, int open, double square);

/* Point n of `count` of Vogel's spiral over the unit disc: radius, and angle in turns. */
void rf_spiral(int n, int count, double *radius, double *turns);

/* The ray through a place on the mask; that of a weight, or one of 255 through the squeezed mask.
 */
struct refocus_ray rf_shape_ray(double x, double y, int weight);
struct refocus_ray rf_squeezed_ray(const struct refocus_aperture *a, double x, double y);

#endif
