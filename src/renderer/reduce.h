/* reduce.h: photos of half the size.
 *
 * Of 2 x 2 pixels the one is taken that is second nearest; those within 1/32 of the
 * range of its disparity are averaged, light in linear light and disparity, each half
 * up, and the light is brought to the nearest 8-bit code: what belongs to another
 * surface is left out. So a reduced photo is one that a caller could have prepared.
 * Alpha is the mean of all four. At an odd side the last column or row counts twice.
 */
#ifndef RF_REDUCE_H
#define RF_REDUCE_H

#include "renderer/renderer.h"

/* Make r->photo[1] of r->photo[0], or all of the reduced photos, with their rims. May
 * be cancelled; then what was made is of no use. */
void rf_reduce_once(struct refocus_renderer *r);
void rf_reduce_all(struct refocus_renderer *r);

#endif
