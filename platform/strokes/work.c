/* work.c: strokes of a few bytes may reach over the whole picture, thousands of times: what they
 * will take is told by their areas and paths alone. */
#include <math.h>
#include "brush.h"
#include "select.h"
#include "work.h"

/* For each object its colours are counted in so many bins; for each of its strokes distances are
 * found on the coarsest level. */
enum { PER_OBJECT = 1 << 16, PER_STROKE = 1 << 13 };

static double length_of(const struct rf_stroke *stroke, int32_t i, int axis)
{
    const float *const p = stroke->points + 2 * (size_t)i + axis;

    return i > 0 ? fabs((double)p[0] - (double)p[-2]) : 0;
}

/* The path is drawn on a coarser level, where a step is some eighth of a pixel's work at most. */
static int64_t path_work(const struct rf_stroke *stroke)
{
    double length = 0;

    for (int32_t i = 0; i < stroke->count; i++)
        length += 1 + fmax(length_of(stroke, i, 0), length_of(stroke, i, 1));
    return (int64_t)(length / 8);
}

/* A segment fills a run in each of its rows. */
static int64_t brush_work(const struct rf_stroke *stroke, int32_t width, int32_t height)
{
    const double around = 2 * (double)stroke->stroke.radius + 1;
    double work =
        (double)rf_area_pixels(rf_brush_area(stroke, (double)stroke->stroke.radius, width, height));

    for (int32_t i = 0; i < stroke->count; i++) {
        const double rows = fmin(length_of(stroke, i, 1) + around, height);
        const double run = fmin(length_of(stroke, i, 0) + around, width);

        work += rows * (4 + run / 64);
    }
    return (int64_t)work;
}

int64_t rf_layer_work(const struct rf_pyramid *pyramid, const struct rf_stroke *strokes, int count)
{
    const int32_t width = pyramid->width[0], height = pyramid->height[0];
    int64_t work = PER_OBJECT;

    if (strokes[0].stroke.kind == REFOCUS_STROKE_ALL)
        return height;
    if (strokes[0].count == 0)
        return 0;
    if (strokes[0].stroke.kind == REFOCUS_STROKE_BRUSH)
        return brush_work(&strokes[0], width, height);
    for (int i = 0; i < count; i++)
        if (strokes[i].count > 0)
            work += PER_STROKE + path_work(&strokes[i]);
    return work + rf_select_work(pyramid, strokes, count);
}
