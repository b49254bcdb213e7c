/* layers.c: what the strokes of each layer cover, and the disparities that are seen from above. */
#include "layers.h"
#include <stdlib.h>
#include <string.h>
#include "brush.h"
#include "fill.h"
#include "select.h"

struct rf_layer *rf_last_layer(const struct refocus_strokes *strokes)
{
    return strokes->layer_count > 0 ? &strokes->layers[strokes->layer_count - 1] : NULL;
}

/* The last stroke that says how. */
static const struct refocus_fill *fill_of(const struct refocus_strokes *strokes,
                                          const struct rf_layer *layer)
{
    int i = layer->first + layer->count - 1;

    while (i > layer->first && strokes->strokes[i].stroke.fill.kind == REFOCUS_FILL_NONE)
        i--;
    return &strokes->strokes[i].stroke.fill;
}

/* The topmost layer that hides all below it between two columns, or 0. */
static int lowest_visible(const struct refocus_strokes *strokes, int32_t y, int32_t from,
                          int32_t to)
{
    int i = strokes->layer_count - 1;

    for (; i > 0; i--) {
        const int32_t *x = NULL;

        if (fill_of(strokes, &strokes->layers[i])->kind != REFOCUS_FILL_NONE &&
            rf_spans_row(&strokes->layers[i].spans, y, &x) == 2 && x[0] <= from && x[1] >= to)
            break;
    }
    return i > 0 ? i : 0;
}

/* Paint one row from x to the pixel before end, from the bottom up. */
static void paint_row(struct refocus_strokes *strokes, int32_t y, int32_t from, int32_t to)
{
    const size_t width = (size_t)strokes->pyramid.width[0];
    uint16_t *const row = strokes->disparity + (size_t)y * width;

    if (strokes->base)
        memcpy(row + from, strokes->base + (size_t)y * width + (size_t)from,
               (size_t)(to - from) * sizeof *row);
    else
        memset(row + from, 0, (size_t)(to - from) * sizeof *row);
    for (int i = lowest_visible(strokes, y, from, to); i < strokes->layer_count; i++) {
        const struct refocus_fill *const fill = fill_of(strokes, &strokes->layers[i]);
        const int32_t *x = NULL;
        const int64_t numbers = rf_spans_row(&strokes->layers[i].spans, y, &x);

        for (int64_t n = 0; n < numbers; n += 2) {
            const int32_t first = x[n] > from ? x[n] : from;
            const int32_t last = x[n + 1] < to ? x[n + 1] : to;

            if (first < last)
                rf_fill_span(fill, row, y, first, last);
        }
    }
}

struct bounds {
    int32_t x0, y0, x1, y1;
};

static void widen(struct bounds *bounds, int32_t y, int32_t from, int32_t to)
{
    bounds->x0 = from < bounds->x0 ? from : bounds->x0;
    bounds->x1 = to > bounds->x1 ? to : bounds->x1;
    bounds->y0 = y < bounds->y0 ? y : bounds->y0;
    bounds->y1 = y + 1 > bounds->y1 ? y + 1 : bounds->y1;
}

/* Paint anew where two layers cover different pixels, or all that they cover when the
 * fill is another. */
void rf_repaint(struct refocus_strokes *strokes, const struct rf_spans *before,
                const struct rf_spans *after, bool all, struct refocus_changed *changed)
{
    const int32_t height = strokes->pyramid.height[0];
    struct bounds bounds = {INT32_MAX, INT32_MAX, 0, 0};
    static const struct rf_spans none;

    for (int32_t y = 0; y < height; y++) {
        int32_t from, to, first, last;
        bool differs = rf_spans_differ(before, all ? &none : after, y, &from, &to);

        if (all && rf_spans_differ(after, &none, y, &first, &last)) {
            from = differs && from < first ? from : first;
            to = differs && to > last ? to : last;
            differs = true;
        }
        if (differs) {
            paint_row(strokes, y, from, to);
            widen(&bounds, y, from, to);
        }
    }
    if (changed && bounds.x0 < bounds.x1) {
        changed->x = bounds.x0;
        changed->y = bounds.y0;
        changed->width = bounds.x1 - bounds.x0;
        changed->height = bounds.y1 - bounds.y0;
    }
}

static int cover_brush(struct refocus_strokes *strokes, const struct rf_stroke *stroke,
                       struct rf_spans *spans)
{
    const struct rf_area area =
        rf_brush_area(stroke, (double)stroke->stroke.radius, strokes->pyramid.width[0],
                      strokes->pyramid.height[0]);
    uint8_t *const mask =
        rf_selector_scratch(&strokes->selector, 3, rf_area_pixels(area), sizeof *mask);

    if (!mask)
        return REFOCUS_ERR_MEMORY;
    memset(mask, 0, (size_t)rf_area_pixels(area));
    rf_brush_cover(stroke, area, mask);
    return rf_spans_of_mask(spans, mask, area);
}

/* Find the pixels that the strokes of the layer cover. */
int rf_cover(struct refocus_strokes *strokes, const struct rf_layer *layer, struct rf_spans *spans)
{
    const struct rf_stroke *const first = &strokes->strokes[layer->first];

    memset(spans, 0, sizeof *spans);
    if (first->stroke.kind == REFOCUS_STROKE_ALL)
        return rf_spans_of_all(spans, strokes->pyramid.width[0], strokes->pyramid.height[0]);
    if (first->count == 0)
        return REFOCUS_OK;
    if (first->stroke.kind == REFOCUS_STROKE_BRUSH)
        return cover_brush(strokes, first, spans);
    return rf_select(&strokes->selector, &strokes->pyramid, first, layer->count, spans);
}

/* The last layer's strokes have changed: cover again, and paint the difference. */
int rf_update_layer(struct refocus_strokes *strokes, bool all, struct refocus_changed *changed)
{
    struct rf_layer *const layer = rf_last_layer(strokes);
    struct rf_spans spans, before = layer->spans;
    int status;

    layer->stale = strokes->held;
    if (strokes->held)
        return REFOCUS_OK;
    status = rf_cover(strokes, layer, &spans);
    if (status != REFOCUS_OK)
        return status;
    layer->spans = spans;
    rf_repaint(strokes, &before, &layer->spans, all, changed);
    rf_spans_free(&before);
    return REFOCUS_OK;
}

void rf_drop_stroke(struct refocus_strokes *strokes)
{
    struct rf_stroke *const last = &strokes->strokes[--strokes->count];
    struct rf_layer *const layer = rf_last_layer(strokes);

    strokes->points -= last->count;
    free(last->points);
    if (--layer->count == 0) {
        rf_spans_free(&layer->spans);
        strokes->layer_count--;
    }
}

void rf_paint_all(struct refocus_strokes *strokes)
{
    for (int32_t y = 0; y < strokes->pyramid.height[0]; y++)
        paint_row(strokes, y, 0, strokes->pyramid.width[0]);
}
