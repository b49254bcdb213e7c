/* strokes.c: the public functions of a painting: strokes are added, taken back and read. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "layers.h"
#include "valid.h"

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

int refocus_strokes_begin(struct refocus_strokes *strokes, const struct refocus_stroke *stroke,
                          struct refocus_changed *changed)
{
    const struct rf_layer *const last = strokes ? rf_last_layer(strokes) : NULL;
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
        struct rf_layer *const layer = &strokes->layers[strokes->layer_count++];

        memset(layer, 0, sizeof *layer);
        layer->first = strokes->count;
    }
    rf_last_layer(strokes)->count++;
    added = &strokes->strokes[strokes->count++];
    memset(added, 0, sizeof *added);
    added->stroke = *stroke;
    added->stroke.struct_size = sizeof *stroke;
    if (stroke->kind == REFOCUS_STROKE_ALL)
        status = rf_update_layer(strokes, false, changed);
    else if (!rf_begins_layer(stroke->kind) && stroke->fill.kind != REFOCUS_FILL_NONE &&
             !strokes->held)
        rf_repaint(strokes, &rf_last_layer(strokes)->spans, &rf_last_layer(strokes)->spans, true,
                   changed);
    if (status != REFOCUS_OK)
        rf_drop_stroke(strokes);
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
    status = rf_update_layer(strokes, false, changed);
    if (status != REFOCUS_OK) {
        last->count -= count;
        strokes->points -= count;
    }
    return status;
}

int refocus_strokes_undo(struct refocus_strokes *strokes, struct refocus_changed *changed)
{
    struct rf_stroke *last;
    struct rf_layer *layer;
    struct rf_spans before, after = {0};
    bool refill;

    if (changed)
        memset(changed, 0, sizeof *changed);
    if (!strokes)
        return REFOCUS_ERR_ARGUMENT;
    if (strokes->count == 0)
        return REFOCUS_ERR_STATE;
    last = &strokes->strokes[strokes->count - 1];
    layer = rf_last_layer(strokes);
    refill = last->stroke.fill.kind != REFOCUS_FILL_NONE;
    before = layer->spans;
    layer->count--;
    if (last->count > 0 && layer->count > 0) {
        const int status = rf_cover(strokes, layer, &after);

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
    rf_drop_stroke(strokes);
    rf_repaint(strokes, &before, &after, refill, changed);
    rf_spans_free(&before);
    return REFOCUS_OK;
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
        rf_drop_stroke(*strokes);
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
    const struct rf_layer *const layer = strokes ? rf_last_layer(strokes) : NULL;

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
