/* cat_shape.h: irises and figures that a lens cuts off at two sides away from its axis.
 *
 * What is left is the part common to the opening and to two unit circles, one pushed by
 * +d and one by -d along an axis: straight blades stay straight, and corners stay where
 * no circle reaches them. Both rims, that of the whole opening and that of what is
 * left, are seen whole from the middle, so a ray keeps its share of the way from there
 * to the rim, and directions are turned so that equal areas stay equal. So every tile
 * keeps all its rays, and they move little from one tile to the next. (A circle's are
 * moved by cat_eye.h, for less.)
 */
#ifndef RF_CAT_SHAPE_H
#define RF_CAT_SHAPE_H

#include <stdbool.h>
#include <stdint.h>

#include "aperture/aperture.h"

/* Knots of the rim: at equal steps of |u| and |v| around the square |u| + |v| = 1, but
 * that those next to corners of the rim are in the corners. */
enum { RF_RIM_BITS = 6, RF_RIM = 4 << RF_RIM_BITS };

struct rf_cat_shape {
    uint64_t id;                             /* of the aperture; 0: not made yet */
    bool is_there;                           /* an outline, and no circle */
    double u[RF_RIM + 1], v[RF_RIM + 1];     /* the rim, as rays have it */
    double area[RF_RIM + 1];                 /* before it, 1 = all */
    double length[RF_RIM];                   /* from the middle, without the squeeze, */
    double along_u[RF_RIM], along_v[RF_RIM]; /* and the direction of that, length 1 */
    int32_t place[RF_RIM + 1];               /* quarter turns and parts of one, Q16 */
    int32_t span[RF_RIM + 1];                /* |u| + |v|, Q15 */
};

/* For an aperture, unless it is made for that. */
void rf_cat_shape_make(struct rf_cat_shape *shape, const struct refocus_aperture *aperture);

/* The rim of what is left at one place, Q15: at the shares of area that the knots of
 * the whole rim have. */
struct rf_cat_shape_here {
    int16_t u[RF_RIM + 1], v[RF_RIM + 1];
};

/* At (x, y) from the middle of a picture, not both 0, `corner` from there to a corner
 * squared, where d is `amount`, Q16, below 1. */
void rf_cat_shape_at(const struct rf_cat_shape *shape, int64_t x, int64_t y, int64_t corner,
                     int amount, struct rf_cat_shape_here *here);

/* A ray of the whole opening in what is left. */
struct refocus_ray rf_cat_shape_ray(const struct rf_cat_shape *shape,
                                    const struct rf_cat_shape_here *here,
                                    const struct refocus_ray *ray);

#endif
