/* json_write.c: the file of strokes is written. */
#include <string.h>
#include "hold.h"
#include "json.h"

#ifdef RF_HAVE_JANSSON
#include <jansson.h>

static json_t *fill_json(const struct refocus_fill *fill)
{
    return json_pack("[[f, f, f], [f, f, f]]", (double)fill->x0, (double)fill->y0, (double)fill->d0,
                     (double)fill->x1, (double)fill->y1, (double)fill->d1);
}

static json_t *points_json(const float *points, int count)
{
    json_t *const list = json_array();

    for (int i = 0; i < count; i++) {
        if (json_array_append_new(
                list, json_pack("[f, f]", (double)points[2 * i], (double)points[2 * i + 1]))) {
            json_decref(list);
            return NULL;
        }
    }
    return list;
}

static json_t *stroke_json(const struct refocus_stroke *stroke, const float *points, int count)
{
    const uint32_t kind = stroke->kind;
    json_t *const object = json_pack("{s:s}", "kind", rf_stroke_kinds[kind]);
    int failed = !object;

    if (kind != REFOCUS_STROKE_ALL && kind != REFOCUS_STROKE_FILL) {
        failed |= json_object_set_new(object, "radius", json_real((double)stroke->radius));
        if (kind == REFOCUS_STROKE_OBJECT || kind == REFOCUS_STROKE_MORE)
            failed |= json_object_set_new(object, "reach", json_real((double)stroke->reach));
        failed |= json_object_set_new(object, "points", points_json(points, count));
    }
    if (stroke->fill.kind == REFOCUS_FILL_SOLID)
        failed |= json_object_set_new(object, "disparity", json_real((double)stroke->fill.d0));
    if (stroke->fill.kind == REFOCUS_FILL_GRADIENT)
        failed |= json_object_set_new(object, "gradient", fill_json(&stroke->fill));
    if (!failed)
        return object;
    json_decref(object);
    return NULL;
}

int refocus_strokes_save(const struct refocus_strokes *strokes, char **text, size_t *size)
{
    json_t *root, *list;
    int32_t width, height;
    int failed;

    if (!strokes || !text || !size)
        return REFOCUS_ERR_ARGUMENT;
    *text = NULL;
    rf_strokes_size(strokes, &width, &height);
    list = json_array();
    root = json_pack("{s:i, s:i, s:i, s:O}", "refocus-strokes", (int)RF_STROKES_VERSION, "width",
                     (int)width, "height", (int)height, "strokes", list);
    failed = !root || !list;
    for (int i = 0; i < refocus_strokes_count(strokes) && !failed; i++) {
        struct refocus_stroke stroke = refocus_stroke_default(REFOCUS_STROKE_ALL, 1);
        const float *points;
        int count;

        refocus_strokes_get(strokes, i, &stroke, &points, &count);
        /* A stroke that was begun and never drawn selects nothing, and has no words. */
        if (count > 0 || stroke.kind == REFOCUS_STROKE_ALL || stroke.kind == REFOCUS_STROKE_FILL)
            failed = json_array_append_new(list, stroke_json(&stroke, points, count));
    }
    if (!failed)
        *text = json_dumps(root, JSON_REAL_PRECISION(9) | JSON_INDENT(1));
    json_decref(list);
    json_decref(root);
    if (!*text)
        return REFOCUS_ERR_MEMORY;
    *size = strlen(*text);
    return REFOCUS_OK;
}
#else
int refocus_strokes_save(const struct refocus_strokes *strokes, char **text, size_t *size)
{
    (void)strokes;
    if (text)
        *text = NULL;
    if (size)
        *size = 0;
    return REFOCUS_ERR_UNSUPPORTED;
}
#endif
