/* strokes.c: the painting is a list of strokes, the layers that they make, and the disparities that
 * are seen from above. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "brush.h"
#include "fill.h"
#include "hold.h"
#include "select.h"
#include "valid.h"
#include "work.h"

/* The strokes of a layer follow each other in the list. */
struct layer {
    int first, count;
    bool stale; /* the strokes are others than its spans */
    struct rf_spans spans;
};

struct refocus_strokes {
    struct rf_pyramid pyramid;
    uint16_t *base; /* NULL: all 0 */
    uint16_t *disparity;
    struct rf_selector selector;
    struct rf_stroke *strokes;
    struct layer *layers;
    int count, layer_count;
    int room, layer_room;
    int points;
    bool held; /* nothing is selected or painted until rf_strokes_release() */
};

static struct layer *last_layer(const struct refocus_strokes *strokes)
{
    return strokes->layer_count > 0 ? &strokes->layers[strokes->layer_count - 1] : NULL;
}

/* The last stroke that says how. */
static const struct refocus_fill *fill_of(const struct refocus_strokes *strokes,
                                          const struct layer *layer)
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
static void repaint(struct refocus_strokes *strokes, const struct rf_spans *before,
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
static int cover(struct refocus_strokes *strokes, const struct layer *layer, struct rf_spans *spans)
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
static int update(struct refocus_strokes *strokes, bool all, struct refocus_changed *changed)
{
    struct layer *const layer = last_layer(strokes);
    struct rf_spans spans, before = layer->spans;
    int status;

    layer->stale = strokes->held;
    if (strokes->held)
        return REFOCUS_OK;
    status = cover(strokes, layer, &spans);
    if (status != REFOCUS_OK)
        return status;
    layer->spans = spans;
    repaint(strokes, &before, &layer->spans, all, changed);
    rf_spans_free(&before);
    return REFOCUS_OK;
}

static int reserve(void **list, int *room, int count, size_t size)
{
    void *more;

    if (count <= *room)
        return REFOCUS_OK;
    count = count < 16 ? 16 : 2 * count;
    more = realloc(*list, (size_t)count * size);
    if (!more)
        return REFOCUS_ERR_MEMORY;
    *list = more;
    *room = count;
    return REFOCUS_OK;
}

static void drop_stroke(struct refocus_strokes *strokes)
{
    struct rf_stroke *const last = &strokes->strokes[--strokes->count];
    struct layer *const layer = last_layer(strokes);

    strokes->points -= last->count;
    free(last->points);
    if (--layer->count == 0) {
        rf_spans_free(&layer->spans);
        strokes->layer_count--;
    }
}

int refocus_strokes_begin(struct refocus_strokes *strokes, const struct refocus_stroke *stroke,
                          struct refocus_changed *changed)
{
    const struct layer *const last = strokes ? last_layer(strokes) : NULL;
    struct refocus_stroke own;
    struct rf_stroke *added;
    int status;

    if (changed)
        memset(changed, 0, sizeof *changed);
    if ((status = refocus_struct_read(&own, sizeof own,
                                      REFOCUS_SIZE_TO(struct refocus_stroke, fill), stroke)))
        return status;
    stroke = &own;
    if (!strokes || !rf_stroke_is_valid(stroke))
        return REFOCUS_ERR_ARGUMENT;
    if (!rf_begins_layer(stroke->kind) &&
        (!last || (stroke->kind != REFOCUS_STROKE_FILL &&
                   strokes->strokes[last->first].stroke.kind != REFOCUS_STROKE_OBJECT)))
        return REFOCUS_ERR_STATE;
    if (strokes->count == REFOCUS_MAX_STROKES)
        return REFOCUS_ERR_SIZE;
    status = reserve((void **)&strokes->strokes, &strokes->room, strokes->count + 1,
                     sizeof *strokes->strokes);
    if (status == REFOCUS_OK)
        status = reserve((void **)&strokes->layers, &strokes->layer_room, strokes->layer_count + 1,
                         sizeof *strokes->layers);
    if (status != REFOCUS_OK)
        return status;
    if (rf_begins_layer(stroke->kind)) {
        struct layer *const layer = &strokes->layers[strokes->layer_count++];

        memset(layer, 0, sizeof *layer);
        layer->first = strokes->count;
    }
    last_layer(strokes)->count++;
    added = &strokes->strokes[strokes->count++];
    memset(added, 0, sizeof *added);
    added->stroke = *stroke;
    added->stroke.struct_size = sizeof *stroke;
    if (stroke->kind == REFOCUS_STROKE_ALL)
        status = update(strokes, false, changed);
    else if (!rf_begins_layer(stroke->kind) && stroke->fill.kind != REFOCUS_FILL_NONE &&
             !strokes->held)
        repaint(strokes, &last_layer(strokes)->spans, &last_layer(strokes)->spans, true, changed);
    if (status != REFOCUS_OK)
        drop_stroke(strokes);
    return status;
}

int refocus_strokes_extend(struct refocus_strokes *strokes, const float *points, int count,
                           struct refocus_changed *changed)
{
    struct rf_stroke *last;
    int status;

    if (changed)
        memset(changed, 0, sizeof *changed);
    if (!strokes || !points || count < 1)
        return REFOCUS_ERR_ARGUMENT;
    if (strokes->count == 0 || !rf_has_points(strokes->strokes[strokes->count - 1].stroke.kind))
        return REFOCUS_ERR_STATE;
    if (count > REFOCUS_MAX_STROKE_POINTS - strokes->points)
        return REFOCUS_ERR_SIZE;
    for (int i = 0; i < count; i++)
        if (!rf_in_bounds(points[2 * i], (float)-0.5,
                          (float)strokes->pyramid.width[0] - (float)0.5) ||
            !rf_in_bounds(points[2 * i + 1], (float)-0.5,
                          (float)strokes->pyramid.height[0] - (float)0.5))
            return REFOCUS_ERR_ARGUMENT;
    last = &strokes->strokes[strokes->count - 1];
    status = reserve((void **)&last->points, &last->room, last->count + count, 2 * sizeof *points);
    if (status != REFOCUS_OK)
        return status;
    memcpy(last->points + 2 * (size_t)last->count, points, 2 * (size_t)count * sizeof *points);
    last->count += count;
    strokes->points += count;
    status = update(strokes, false, changed);
    if (status != REFOCUS_OK) {
        last->count -= count;
        strokes->points -= count;
    }
    return status;
}

int refocus_strokes_undo(struct refocus_strokes *strokes, struct refocus_changed *changed)
{
    struct rf_stroke *last;
    struct layer *layer;
    struct rf_spans before, after = {0};
    bool refill;

    if (changed)
        memset(changed, 0, sizeof *changed);
    if (!strokes)
        return REFOCUS_ERR_ARGUMENT;
    if (strokes->count == 0)
        return REFOCUS_ERR_STATE;
    last = &strokes->strokes[strokes->count - 1];
    layer = last_layer(strokes);
    refill = last->stroke.fill.kind != REFOCUS_FILL_NONE;
    before = layer->spans;
    layer->count--;
    if (last->count > 0 && layer->count > 0) {
        const int status = cover(strokes, layer, &after);

        if (status != REFOCUS_OK) {
            layer->count++;
            return status;
        }
    } else if (layer->count > 0) {
        after = before;
        memset(&before, 0, sizeof before);
    }
    layer->count++;
    memset(&layer->spans, 0, sizeof layer->spans);
    if (layer->count > 1)
        layer->spans = after;
    drop_stroke(strokes);
    repaint(strokes, &before, &after, refill, changed);
    rf_spans_free(&before);
    return REFOCUS_OK;
}

static void paint_all(struct refocus_strokes *strokes)
{
    for (int32_t y = 0; y < strokes->pyramid.height[0]; y++)
        paint_row(strokes, y, 0, strokes->pyramid.width[0]);
}

int rf_strokes_hold(struct refocus_strokes *strokes, struct rf_spans *kept)
{
    const struct layer *const layer = last_layer(strokes);
    int status = REFOCUS_OK;

    memset(kept, 0, sizeof *kept);
    if (layer && layer->spans.first)
        status = rf_spans_copy(kept, &layer->spans);
    strokes->held = status == REFOCUS_OK;
    return status;
}

/* Strokes of a file are limited: whoever made it does not wait for them, as a finger does. */
static int check_work(const struct refocus_strokes *strokes)
{
    const int64_t pixels = (int64_t)strokes->pyramid.width[0] * (int64_t)strokes->pyramid.height[0];
    const int64_t most =
        pixels < REFOCUS_MAX_STROKE_WORK / 64 ? REFOCUS_MAX_STROKE_WORK : 64 * pixels;
    int64_t work = 0;

    for (int i = 0; i < strokes->layer_count && work <= most; i++) {
        const struct layer *const layer = &strokes->layers[i];

        if (layer->stale)
            work += rf_layer_work(&strokes->pyramid, &strokes->strokes[layer->first], layer->count);
    }
    return work <= most ? REFOCUS_OK : REFOCUS_ERR_SIZE;
}

int rf_strokes_release(struct refocus_strokes *strokes)
{
    if (check_work(strokes) != REFOCUS_OK)
        return REFOCUS_ERR_SIZE;
    strokes->held = false;
    for (int i = 0; i < strokes->layer_count; i++) {
        struct layer *const layer = &strokes->layers[i];
        struct rf_spans spans;
        int status;

        if (!layer->stale)
            continue;
        status = cover(strokes, layer, &spans);
        if (status != REFOCUS_OK)
            return status;
        rf_spans_free(&layer->spans);
        layer->spans = spans;
        layer->stale = false;
    }
    paint_all(strokes);
    return REFOCUS_OK;
}

void rf_strokes_return(struct refocus_strokes *strokes, int count, struct rf_spans *kept)
{
    strokes->held = false;
    while (strokes->count > count)
        drop_stroke(strokes);
    if (last_layer(strokes)) {
        rf_spans_free(&last_layer(strokes)->spans);
        last_layer(strokes)->spans = *kept;
        last_layer(strokes)->stale = false;
        memset(kept, 0, sizeof *kept);
    }
    paint_all(strokes);
}

void rf_strokes_size(const struct refocus_strokes *strokes, int32_t *width, int32_t *height)
{
    *width = strokes->pyramid.width[0];
    *height = strokes->pyramid.height[0];
}

static int take_base(struct refocus_strokes *strokes, const struct refocus_disparity *base)
{
    const int32_t width = strokes->pyramid.width[0], height = strokes->pyramid.height[0];
    const size_t pixels = (size_t)width * (size_t)height;

    strokes->disparity = calloc(pixels, sizeof *strokes->disparity);
    if (base)
        strokes->base = malloc(pixels * sizeof *strokes->base);
    if (!strokes->disparity || (base && !strokes->base))
        return REFOCUS_ERR_MEMORY;
    for (int32_t y = 0; base && y < height; y++) {
        const uint8_t *const from = (const uint8_t *)base->samples + y * base->stride;
        uint16_t *const to = strokes->base + (size_t)y * (size_t)width;

        if (base->bits == 16)
            memcpy(to, from, (size_t)width * sizeof *to);
        for (int32_t x = 0; base->bits == 8 && x < width; x++)
            to[x] = (uint16_t)(from[x] * 257);
    }
    if (base)
        memcpy(strokes->disparity, strokes->base, pixels * sizeof *strokes->base);
    return REFOCUS_OK;
}

int refocus_strokes_create(struct refocus_strokes **strokes, const struct refocus_image *photo,
                           const struct refocus_disparity *base)
{
    struct refocus_image own_photo;
    struct refocus_disparity own_base;
    struct refocus_strokes *made;
    int status;

    if (!strokes)
        return REFOCUS_ERR_ARGUMENT;
    *strokes = NULL;
    if ((status = refocus_image_read(&own_photo, photo)) ||
        (base && (status = refocus_disparity_read(&own_base, base))))
        return status;
    photo = &own_photo;
    base = base ? &own_base : NULL;
    if (!rf_is_photo(photo) || (base && !rf_is_base(base, photo)))
        return REFOCUS_ERR_ARGUMENT;
    if ((uint64_t)photo->width * (uint64_t)photo->height > SIZE_MAX / 16)
        return REFOCUS_ERR_SIZE;
    made = calloc(1, sizeof *made);
    if (!made)
        return REFOCUS_ERR_MEMORY;
    status = rf_pyramid_create(&made->pyramid, photo);
    if (status == REFOCUS_OK)
        status = take_base(made, base);
    if (status != REFOCUS_OK) {
        refocus_strokes_destroy(&made);
        return status;
    }
    *strokes = made;
    return REFOCUS_OK;
}

void refocus_strokes_destroy(struct refocus_strokes **strokes)
{
    if (!strokes || !*strokes)
        return;
    while ((*strokes)->count > 0)
        drop_stroke(*strokes);
    free((*strokes)->strokes);
    free((*strokes)->layers);
    free((*strokes)->base);
    free((*strokes)->disparity);
    rf_selector_free(&(*strokes)->selector);
    rf_pyramid_free(&(*strokes)->pyramid);
    free(*strokes);
    *strokes = NULL;
}

int refocus_strokes_count(const struct refocus_strokes *strokes)
{
    return strokes ? strokes->count : 0;
}

int refocus_strokes_get(const struct refocus_strokes *strokes, int index,
                        struct refocus_stroke *stroke, const float **points, int *count)
{
    const struct refocus_stroke *own;

    if (!strokes || index < 0 || index >= strokes->count)
        return REFOCUS_ERR_ARGUMENT;
    own = &strokes->strokes[index].stroke;
    if (stroke && refocus_struct_write(stroke, REFOCUS_SIZE_TO(struct refocus_stroke, fill), own,
                                       sizeof *own))
        return REFOCUS_ERR_ARGUMENT;
    if (points)
        *points = strokes->strokes[index].points;
    if (count)
        *count = strokes->strokes[index].count;
    return REFOCUS_OK;
}

const uint16_t *refocus_strokes_disparity(const struct refocus_strokes *strokes)
{
    return strokes ? strokes->disparity : NULL;
}

int refocus_strokes_selection(const struct refocus_strokes *strokes, uint8_t *mask, int width,
                              int height, ptrdiff_t stride)
{
    const struct layer *const layer = strokes ? last_layer(strokes) : NULL;

    if (!strokes || !mask || width < 1 || height < 1 || !rf_is_stride(stride, width, height))
        return REFOCUS_ERR_ARGUMENT;
    for (int y = 0; y < height; y++) {
        const int64_t rows = strokes->pyramid.height[0], columns = strokes->pyramid.width[0];
        const int32_t at = (int32_t)((2 * (int64_t)y + 1) * rows / (2 * (int64_t)height));
        const int32_t *ends = NULL;
        const int64_t n = layer ? rf_spans_row(&layer->spans, at, &ends) : 0;
        int64_t i = 0;

        for (int x = 0; x < width; x++) {
            const int64_t column = (2 * (int64_t)x + 1) * columns / (2 * (int64_t)width);

            while (i < n && ends[i] <= column)
                i++;
            mask[y * stride + x] = i & 1 ? 255 : 0;
        }
    }
    return REFOCUS_OK;
}
