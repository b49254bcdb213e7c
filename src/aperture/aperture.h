/* aperture.h: the inside of an aperture: its shape and how light is spread over it. The public
 * functions are in refocus/aperture.h. */
#ifndef RF_APERTURE_H
#define RF_APERTURE_H

#include <assert.h>
#include <stdbool.h>

#include <refocus/aperture.h>

#include "support/pool.h"

struct rf_shape;
extern const struct rf_shape rf_shape_disc;

/* The side of the reduced mask that rays are spread over: a power of two, which a Hilbert curve can
 * fill. */
enum { RF_CURVE_SIDE = 64 };

/* The number of vertices of an outline, one for each step of the circle; see outline.c. */
enum { RF_OUTLINE = 720 };

/* The number of heights that chords are kept for, and of chords at one height at most; see
 * chords.c. */
enum { RF_CHORDS = 256, RF_CHORD_SETS = 2 };

/* How light is spread from the middle to the edge; see refocus_aperture_params. */
struct rf_profile {
    double hole, edge;
};

/* How light is spread over an aperture that is not evenly open, as a summed-area table: light
 * within a rectangle takes four look-ups. Cells are squares of the aperture without its squeeze,
 * which goes from -1 to 1 in x and y; those of a mask are its pixels. */
enum { RF_SUMMED_SIDE = REFOCUS_MAX_APERTURE_SIDE, RF_SUMMED_POINTS = 4 /* across a cell, down */ };
struct rf_summed_light {
    int side; /* cells across, and down */
    struct rf_summed_side {
        uint32_t before[RF_SUMMED_SIDE + 1][RF_SUMMED_SIDE + 1]; /* sums of cells above and left */
        uint8_t first[RF_SUMMED_SIDE], end[RF_SUMMED_SIDE]; /* cells of each row that have light */
        int most;                                           /* light of the brightest cell */
    } behind, in_front; /* sides of the focus; that in front is set where they differ */
};
static_assert((uint64_t)RF_SUMMED_SIDE * RF_SUMMED_SIDE * 255 * RF_SUMMED_POINTS *
                      RF_SUMMED_POINTS <=
                  UINT32_MAX,
              "a sum of all cells");

/* The tables of masks and outlines. A disc has none, so that the constant one is small. */
struct rf_aperture_tables {
    uint8_t mask[REFOCUS_MAX_APERTURE_SIDE * REFOCUS_MAX_APERTURE_SIDE];
    uint8_t reduced[RF_CURVE_SIDE * RF_CURVE_SIDE];            /* spans -1..1 in x and y */
    double vertex_x[RF_OUTLINE + 1], vertex_y[RF_OUTLINE + 1]; /* an outline, y up */
    double area[RF_OUTLINE + 1]; /* sums of the triangles before a vertex, 1 = all */
    int16_t chord[RF_CHORD_SETS][RF_CHORDS + 1][2]; /* first and last x, Q14 */
    struct rf_summed_light light;                   /* set if `summed` is */
};

struct refocus_aperture {
    uint64_t id;                       /* equal for equal shapes, so that ray sets can be kept */
    const struct rf_shape *shape;      /* table of operations: shape.h */
    struct rf_aperture_tables *tables; /* NULL in rf_disc; owned: one block with the aperture */
    int blades;
    double corner_x[16], corner_y[16]; /* units of K, y down, as the mask is seen */
    int width, height;                 /* size of the mask picture */
    double squeeze_x, squeeze_y;       /* factors that narrow the shape as it is drawn */
    struct rf_profile behind, before;  /* light for blurs behind and before the focus */
    bool figure;                       /* an outline that is no iris: a heart or a star */
    int chord_sets; /* most chords in a row of an outline; 0: more than are kept, or no outline */
    double chord_area;                    /* area within the outline */
    const struct rf_summed_light *summed; /* set where there are no chords, or NULL */
};

/* Whether rays before the focus differ from those behind it. */
static inline bool rf_aperture_has_sides(const struct refocus_aperture *a)
{
    return a->before.edge != a->behind.edge;
}

/* The rho^2 within which a share of the light lies, and the density of light at a rho^2, 1 where it
 * is largest. */
double rf_profile_square(const struct rf_profile *profile, double share);
double rf_profile_density(const struct rf_profile *profile, double square);
static inline bool rf_profile_is_even(const struct rf_profile *profile)
{
    return profile->hole == 0 && profile->edge == 0;
}

static inline bool rf_aperture_is_disc(const struct refocus_aperture *a)
{
    return a->shape == &rf_shape_disc;
}

/* Whether an aperture has structure much finer than itself, which a blur by it still shows. */
bool rf_aperture_is_fine(const struct refocus_aperture *a);

/* Whether an aperture may be open outside of the circle of radius K. */
bool rf_aperture_fills_square(const struct refocus_aperture *a);

/* Makes the chords of an iris or a figure that is evenly lit, once all else but its id is known.
 * Discs and masks have none. */
void rf_chords_make(struct refocus_aperture *aperture);

/* Measures the light of apertures without chords (rf_chords_make()), once all else but their id is
 * known. */
void rf_summed_light_make(struct refocus_aperture *aperture);

/* The disc that a NULL aperture stands for. */
extern const struct refocus_aperture rf_disc;

/* How far the aperture is open at (x, y), 0 to 255; x, y in units of K, y down. */
int rf_aperture_open(const struct refocus_aperture *aperture, double x, double y);

/* Do as refocus_aperture_rays(), for the side before the focus if asked for, and as
 * refocus_aperture_full_rays(). The rays of a cancelled run are not valid. */
int rf_aperture_rays(const struct refocus_aperture *aperture, int count, bool before,
                     struct refocus_ray *rays, struct rf_run *run);
int rf_aperture_full_rays(const struct refocus_aperture *aperture, double max_blur_radius,
                          int capacity, struct refocus_ray *rays, struct rf_run *run);

/* Computes sin and cos of a number of turns from IEEE operations alone: the C library's may
 * differ in the last bit from one system to the next. Within 1e-12 for |turns| < 2^20. */
void rf_sincos_turns(double turns, double *sine, double *cosine);

#endif
