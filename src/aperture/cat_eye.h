/* cat_eye.h: apertures that a lens cuts off at two sides away from its axis: circles, and masks,
 * which are squeezed like one. Other outlines are cut by cat_shape.h.
 *
 * The part of the unit circle that stays open is common to two unit circles, one pushed by
 * +d and one by -d along an axis: |x| <= 1 - d, half as high as sqrt(1 - (|x| + d)^2).
 * Rays of the circle are moved into it so that equal areas stay equal: along the axis
 * by the shares of area, across it in proportion to the heights. So every tile keeps
 * all its rays, and they move little from one tile to the next.
 */
#ifndef RF_CAT_EYE_H
#define RF_CAT_EYE_H

#include <stdbool.h>
#include <stdint.h>

#include <refocus/aperture.h>

enum {
    RF_CAT_LEVELS = 64, /* steps of d from 0 to 1 */
    RF_CAT_KNOTS = 32,  /* steps of |x| from 0 to 1 */
};

/* Tables of where rays of the circle go, for each level of d and each knot of |x|. */
struct rf_cat_eye {
    bool ready;
    int16_t to[RF_CAT_LEVELS][RF_CAT_KNOTS + 1];     /* Q15: where |x| goes */
    int16_t height[RF_CAT_LEVELS][RF_CAT_KNOTS + 1]; /* Q15: factor of y there */
};

/* Makes the tables, unless they are there. */
void rf_cat_eye_make(struct rf_cat_eye *eye);

/* The aperture at one place of the photo: a table, and the axis that it is pushed along, Q15. */
struct rf_cat_eye_here {
    bool is_round; /* nothing is cut off */
    int axis_x, axis_y;
    int16_t to[RF_CAT_KNOTS + 1], height[RF_CAT_KNOTS + 1];
};

/* Makes the aperture at (x, y) from the middle of a picture. `corner` is the squared distance from
 * there to a corner, where d is `amount`, Q16; (x, y) is no farther. */
void rf_cat_eye_at(const struct rf_cat_eye *eye, int64_t x, int64_t y, int64_t corner, int amount,
                   struct rf_cat_eye_here *here);

/* Moves a ray of the circle into that aperture. */
struct refocus_ray rf_cat_eye_ray(const struct rf_cat_eye_here *here,
                                  const struct refocus_ray *ray);

#endif
