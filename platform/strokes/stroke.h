/* stroke.h: a stroke as the painting keeps it, and rectangles of a picture. */
#ifndef RF_STROKES_STROKE_H
#define RF_STROKES_STROKE_H

#include <stdint.h>
#include <refocus/platform/strokes.h>

/* A rectangle of the picture, in pixels of a level. */
struct rf_area {
    int32_t x, y, width, height;
};
static inline int64_t rf_area_pixels(struct rf_area area)
{
    return (int64_t)area.width * area.height;
}

struct rf_stroke {
    struct refocus_stroke stroke;
    float *points; /* x and y of each point */
    int32_t count, room;
};

#endif
