/* cat_shape.h: irises and figures that a lens cuts off at two sides away from its axis.
 *
 * The cut shape is the part common to the aperture and to two unit circles, one pushed by
 * +d and one by -d along an axis: straight blades stay straight, and corners stay where
 * no circle reaches them. Both outlines, that of the whole aperture and that of the cut
 * shape, are seen whole from the middle, so a ray keeps its share of the way from there
 * to the outline, and directions are turned so that equal areas stay equal. So every tile
 * keeps all its rays, and they move little from one tile to the next. (A circle's are
 * moved by cat_eye.h, for less.)
 */
#ifndef RF_CAT_SHAPE_H
#define RF_CAT_SHAPE_H

#include <stdbool.h>
#include <stdint.h>

#include "aperture/aperture.h"

/* The number of knots of an outline. They lie at equal steps around the square |u| + |v| = 1, but
 * the knot that is nearest to a corner of the outline lies in that corner. */
enum { RF_KNOT_BITS = 6, RF_KNOTS = 4 << RF_KNOT_BITS };

struct rf_cat_shape {
    uint64_t id;                                 /* id of the aperture; 0: nothing is there yet */
    bool is_there;                               /* the aperture has an outline that is no circle */
    double u[RF_KNOTS + 1], v[RF_KNOTS + 1];     /* the outline, with the signs of rays */
    double area[RF_KNOTS + 1];                   /* sum before each knot, 1 = all */
    double length[RF_KNOTS];                     /* distance from the middle without the squeeze */
    double along_u[RF_KNOTS], along_v[RF_KNOTS]; /* direction from the middle, length 1 */
    int32_t place[RF_KNOTS + 1];                 /* direction in quarter turns, Q16 */
    int32_t span[RF_KNOTS + 1];                  /* |u| + |v|, Q15 */
};

/* Makes the knots of an aperture, unless they are those of that aperture already. */
void rf_cat_shape_make(struct rf_cat_shape *shape, const struct refocus_aperture *aperture);

/* The outline of the cut shape at one place of the photo, Q15, at the shares of area that the knots
 * of the whole outline have. */
struct rf_cat_shape_here {
    int16_t u[RF_KNOTS + 1], v[RF_KNOTS + 1];
};

/* Makes the cut shape at (x, y) from the middle of a picture, not both 0. `corner` is the squared
 * distance from there to a corner, where d is `amount`, Q16, below 1; (x, y) is no farther. */
void rf_cat_shape_at(const struct rf_cat_shape *shape, int64_t x, int64_t y, int64_t corner,
                     int amount, struct rf_cat_shape_here *here);

/* Moves a ray of the whole aperture into the cut shape. */
struct refocus_ray rf_cat_shape_ray(const struct rf_cat_shape *shape,
                                    const struct rf_cat_shape_here *here,
                                    const struct refocus_ray *ray);

#endif
