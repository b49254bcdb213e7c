/* aperture.h: what an aperture is inside. The public words are in refocus/aperture.h. */
#ifndef RF_APERTURE_H
#define RF_APERTURE_H

#include <stdbool.h>

#include <refocus/aperture.h>

#include "support/pool.h"

enum rf_shape { RF_SHAPE_DISC, RF_SHAPE_POLYGON, RF_SHAPE_MASK, RF_SHAPE_OUTLINE };

/* A reduced mask for spreading rays: a side that a Hilbert curve can fill. */
enum { RF_CURVE_SIDE = 64 };

/* Vertices of an outline, one for each step of the circle; see outline.c. */
enum { RF_OUTLINE = 720 };

/* Heights that chords are kept of, and how many of each at most; see chords.c. */
enum { RF_CHORDS = 256, RF_CHORD_SETS = 2 };

/* How light is spread from the middle to the rim; see refocus_aperture_params. */
struct rf_profile {
    double hole, edge;
};

struct refocus_aperture {
    uint64_t id; /* equal for equal shapes, so that ray sets can be kept */
    enum rf_shape shape;
    int blades;
    double corner_x[16], corner_y[16]; /* units of K, y down, as the mask is seen */
    int width, height;                 /* of the mask picture */
    uint8_t mask[REFOCUS_MAX_APERTURE_SIDE * REFOCUS_MAX_APERTURE_SIDE];
    uint8_t reduced[RF_CURVE_SIDE * RF_CURVE_SIDE];            /* spans -1..1 in x and y */
    double vertex_x[RF_OUTLINE + 1], vertex_y[RF_OUTLINE + 1]; /* of an outline, y up */
    double area[RF_OUTLINE + 1];      /* of the triangles before a vertex, 1 = all */
    double squeeze_x, squeeze_y;      /* factors of what is drawn */
    struct rf_profile behind, before; /* the focus */
    bool figure;                      /* an outline that no iris has */
    int chord_sets; /* of an outline: so many chords in a row at most; 0: too many, or none kept */
    int16_t chord[RF_CHORD_SETS][RF_CHORDS + 1][2]; /* first and last x, Q14, */
    double chord_area;                              /* and its area */
};

/* Whether rays before the focus differ from those behind it. */
static inline bool rf_aperture_has_sides(const struct refocus_aperture *a)
{
    return a->before.edge != a->behind.edge;
}

/* Rings' areas: rho^2 within which a share of the light lies, and how dense it is there, 1 at
 * the densest. */
double rf_profile_square(const struct rf_profile *profile, double share);
double rf_profile_density(const struct rf_profile *profile, double square);
static inline bool rf_profile_is_even(const struct rf_profile *profile)
{
    return profile->hole == 0 && profile->edge == 0;
}

/* Whether it has structure much finer than itself, which a blur by it still shows. */
static inline bool rf_aperture_is_fine(const struct refocus_aperture *a)
{
    return a->shape == RF_SHAPE_MASK || a->figure || a->behind.hole > 0 || a->before.hole > 0 ||
           a->behind.edge > 0 || a->before.edge > 0;
}

/* The outline of an iris or a figure, and its triangles' areas. */
void rf_outline_make(struct refocus_aperture *aperture,
                     const struct refocus_aperture_params *params);

/* Where on an outline: a share of its area, counter-clockwise. */
void rf_outline_at(const struct refocus_aperture *aperture, double share, double *x, double *y);

/* rho^2 of a place, 1 on the outline. */
double rf_outline_square(const struct refocus_aperture *aperture, double x, double y);

/* Its rows as chords, once all of it is known but its id, if it is evenly lit: of irises and
 * figures that are no discs. */
void rf_chords_make(struct refocus_aperture *aperture);

/* The disc that a NULL aperture stands for. */
extern const struct refocus_aperture rf_disc;

/* How far the aperture is open at (x, y), 0 to 255; x, y in units of K, y down. */
int rf_aperture_open(const struct refocus_aperture *aperture, double x, double y);

/* refocus_aperture_rays(), of the side before the focus if asked for, and
 * refocus_aperture_full_rays(); what comes back from a cancelled run is of no use. */
int rf_aperture_rays(const struct refocus_aperture *aperture, int count, bool before,
                     struct refocus_ray *rays, struct rf_run *run);
int rf_aperture_full_rays(const struct refocus_aperture *aperture, double max_blur_radius,
                          int capacity, struct refocus_ray *rays, struct rf_run *run);

/* sin and cos of a number of turns from IEEE operations alone: the C library's may
 * differ in the last bit from one system to the next. Within 1e-12 for |turns| < 2^20. */
void rf_sincos_turns(double turns, double *sine, double *cosine);

#endif
