/* upsample.h: a disparity map of any size brought to the photo's. */
#ifndef RF_UPSAMPLE_H
#define RF_UPSAMPLE_H

#include "renderer/renderer.h"

/*
 * Each pixel looks at the 4x4 samples around it, weighted by nearness and by how much the
 * photo at the sample's place looks like the photo here. Samples that lie within 1/24 of
 * the range of each other are one surface; the surface with the most weight wins, and
 * only its samples are averaged, so that no disparity between two surfaces is invented.
 * A map that is larger than the photo is sampled.
 */
void rf_upsample_rows(struct refocus_renderer *r, const struct refocus_disparity *map, int y0,
                      int y1);

#endif
