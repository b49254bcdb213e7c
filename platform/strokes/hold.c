/* hold.c: many strokes are listed first, and selected and painted in one go. */
#include "hold.h"
#include <string.h>
#include "layers.h"
#include "work.h"

int rf_strokes_hold(struct refocus_strokes *strokes, struct rf_spans *kept)
{
    const struct rf_layer *const layer = rf_last_layer(strokes);
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
        const struct rf_layer *const layer = &strokes->layers[i];

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
        struct rf_layer *const layer = &strokes->layers[i];
        struct rf_spans spans;
        int status;

        if (!layer->stale)
            continue;
        status = rf_cover(strokes, layer, &spans);
        if (status != REFOCUS_OK)
            return status;
        rf_spans_free(&layer->spans);
        layer->spans = spans;
        layer->stale = false;
    }
    rf_paint_all(strokes);
    return REFOCUS_OK;
}

void rf_strokes_return(struct refocus_strokes *strokes, int count, struct rf_spans *kept)
{
    strokes->held = false;
    while (strokes->count > count)
        rf_drop_stroke(strokes);
    if (rf_last_layer(strokes)) {
        rf_spans_free(&rf_last_layer(strokes)->spans);
        rf_last_layer(strokes)->spans = *kept;
        rf_last_layer(strokes)->stale = false;
        memset(kept, 0, sizeof *kept);
    }
    rf_paint_all(strokes);
}

void rf_strokes_size(const struct refocus_strokes *strokes, int32_t *width, int32_t *height)
{
    *width = strokes->pyramid.width[0];
    *height = strokes->pyramid.height[0];
}
