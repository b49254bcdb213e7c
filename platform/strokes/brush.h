/* brush.h: the area around the path of a stroke. */
#ifndef RF_STROKES_BRUSH_H
#define RF_STROKES_BRUSH_H

#include "stroke.h"

/* Distances from a path in sixteenths of a brush radius, in the pixels of an area of a level;
 * RF_FAR where it is farther than anything asks for. */
enum { RF_RADIUS = 16, RF_FAR = 65535 };
void rf_brush_distance(const struct rf_stroke *stroke, int level, struct rf_area area,
                       uint16_t *distance);
/* Set the pixels within the radius to 1, at full size. */
void rf_brush_cover(const struct rf_stroke *stroke, struct rf_area area, uint8_t *mask);
/* The rectangle of all pixels within that margin of the path, cut by the picture. */
struct rf_area rf_brush_area(const struct rf_stroke *stroke, double margin, int32_t width,
                             int32_t height);

#endif
