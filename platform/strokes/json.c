/* json.c: the file of strokes is read. */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "hold.h"
#include "json.h"

#ifdef RF_HAVE_JANSSON
#include <jansson.h>

enum { MAX_BYTES = 64 << 20 };

const char *const rf_stroke_kinds[] = {"all", "object", "more", "less", "brush", "fill"};

struct reading {
    struct refocus_strokes *strokes;
    struct refocus_strokes_reason *reason;
    int32_t width, height;
};

#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
static int
refuse(struct refocus_strokes_reason *reason, int status, const char *why, ...)
{
    va_list arguments;

    va_start(arguments, why);
    vsnprintf(reason->text, sizeof reason->text, why, arguments);
    va_end(arguments);
    /* A file may hold any bytes. */
    for (char *c = reason->text; *c; c++)
        if (*c < ' ' || *c > '~')
            *c = '?';
    return status;
}

static int no_memory(struct refocus_strokes_reason *reason)
{
    return refuse(reason, REFOCUS_ERR_MEMORY, "not enough memory");
}

/* The first key that is none of those named, or NULL. */
static const char *strange_key(json_t *object, const char *const *known)
{
    const char *key;
    json_t *value;

    json_object_foreach(object, key, value)
    {
        int i = 0;

        while (known[i] && strcmp(known[i], key) != 0)
            i++;
        if (!known[i])
            return key;
    }
    return NULL;
}

static bool read_number(const json_t *value, double least, double greatest, float *number)
{
    const double v = json_is_number(value) ? json_number_value(value) : greatest + 1;

    if (!(v >= least && v <= greatest))
        return false;
    *number = (float)v;
    return true;
}

/* Key, or its default; the range is told. */
static int read_key(struct reading *reading, int index, json_t *object, const char *key,
                    double least, double greatest, float *number)
{
    json_t *const value = json_object_get(object, key);

    if (!value || read_number(value, least, greatest, number))
        return REFOCUS_OK;
    return refuse(reading->reason, REFOCUS_ERR_FORMAT,
                  "strokes[%d].%s must be a number from %g to %g", index, key, least, greatest);
}

static bool read_end(const json_t *end, float *x, float *y, float *d)
{
    const double far = 1048576;

    return json_is_array(end) && json_array_size(end) == 3 &&
           read_number(json_array_get(end, 0), -far, far, x) &&
           read_number(json_array_get(end, 1), -far, far, y) &&
           read_number(json_array_get(end, 2), 0, 1, d);
}

static int read_fill(struct reading *reading, int index, json_t *object, struct refocus_fill *fill)
{
    json_t *const solid = json_object_get(object, "disparity");
    json_t *const gradient = json_object_get(object, "gradient");
    float dx, dy;

    if (solid && gradient)
        return refuse(reading->reason, REFOCUS_ERR_FORMAT,
                      "strokes[%d] has both a disparity and a gradient; give one", index);
    if (solid)
        fill->kind = REFOCUS_FILL_SOLID;
    if (!gradient)
        return read_key(reading, index, object, "disparity", 0, 1, &fill->d0);
    fill->kind = REFOCUS_FILL_GRADIENT;
    if (!json_is_array(gradient) || json_array_size(gradient) != 2 ||
        !read_end(json_array_get(gradient, 0), &fill->x0, &fill->y0, &fill->d0) ||
        !read_end(json_array_get(gradient, 1), &fill->x1, &fill->y1, &fill->d1))
        return refuse(reading->reason, REFOCUS_ERR_FORMAT,
                      "strokes[%d].gradient must be [[X, Y, D], [X, Y, D]] with D from 0 to 1",
                      index);
    dx = fill->x1 - fill->x0;
    dy = fill->y1 - fill->y0;
    if (dx < 1 && dx > -1 && dy < 1 && dy > -1)
        return refuse(reading->reason, REFOCUS_ERR_FORMAT,
                      "strokes[%d].gradient must go from one pixel to another", index);
    return REFOCUS_OK;
}

/* The points of a stroke; *points is to be freed. */
static int read_points(struct reading *reading, int index, json_t *object, float **points,
                       int *count)
{
    json_t *const list = json_object_get(object, "points");
    const size_t size = json_is_array(list) ? json_array_size(list) : 0;

    *points = NULL;
    *count = 0;
    if (size == 0)
        return refuse(reading->reason, REFOCUS_ERR_FORMAT,
                      "strokes[%d].points must be a list of [X, Y], one at least", index);
    if (size > REFOCUS_MAX_STROKE_POINTS)
        return refuse(reading->reason, REFOCUS_ERR_SIZE,
                      "strokes[%d] has %zu points; all strokes may have %d", index, size,
                      (int)REFOCUS_MAX_STROKE_POINTS);
    *points = malloc(2 * size * sizeof **points);
    if (!*points)
        return no_memory(reading->reason);
    for (size_t i = 0; i < size; i++) {
        const json_t *const point = json_array_get(list, i);
        float *const p = *points + 2 * i;

        if (!json_is_array(point) || json_array_size(point) != 2 ||
            !read_number(json_array_get(point, 0), -0.5, reading->width - 0.5, p) ||
            !read_number(json_array_get(point, 1), -0.5, reading->height - 0.5, p + 1))
            return refuse(reading->reason, REFOCUS_ERR_FORMAT,
                          "strokes[%d].points[%zu] must be a pixel, 0 to %d and 0 to %d", index, i,
                          (int)reading->width - 1, (int)reading->height - 1);
    }
    *count = (int)size;
    return REFOCUS_OK;
}

static int read_kind(struct reading *reading, int index, json_t *object,
                     struct refocus_stroke *stroke)
{
    static const char *const plain[] = {"kind", "disparity", "gradient", NULL};
    static const char *const painted[] = {"kind",   "disparity", "gradient",
                                          "radius", "points",    NULL};
    static const char *const selecting[] = {"kind",   "disparity", "gradient", "radius",
                                            "points", "reach",     NULL};
    const char *const name = json_string_value(json_object_get(object, "kind"));
    const char *strange;
    uint32_t kind = 0;

    while (name && kind < sizeof rf_stroke_kinds / sizeof *rf_stroke_kinds &&
           strcmp(name, rf_stroke_kinds[kind]) != 0)
        kind++;
    if (!name || kind == sizeof rf_stroke_kinds / sizeof *rf_stroke_kinds)
        return refuse(reading->reason, REFOCUS_ERR_FORMAT,
                      "strokes[%d].kind must be all, object, more, less, brush or fill", index);
    *stroke = refocus_stroke_default(kind, 0);
    strange = strange_key(object, kind == REFOCUS_STROKE_ALL || kind == REFOCUS_STROKE_FILL ? plain
                                  : kind == REFOCUS_STROKE_OBJECT || kind == REFOCUS_STROKE_MORE
                                      ? selecting
                                      : painted);
    if (strange)
        return refuse(reading->reason, REFOCUS_ERR_FORMAT,
                      "strokes[%d] has a key '%.40s', which '%s' does not take", index, strange,
                      name);
    return REFOCUS_OK;
}

static int read_stroke(struct reading *reading, int index, json_t *object,
                       struct refocus_stroke *stroke, float **points, int *count)
{
    int status;

    *points = NULL;
    *count = 0;
    if (!json_is_object(object))
        return refuse(reading->reason, REFOCUS_ERR_FORMAT, "strokes[%d] must be an object", index);
    status = read_kind(reading, index, object, stroke);
    if (status == REFOCUS_OK)
        status = read_fill(reading, index, object, &stroke->fill);
    if (status != REFOCUS_OK)
        return status;
    if (stroke->kind == REFOCUS_STROKE_FILL && stroke->fill.kind == REFOCUS_FILL_NONE)
        return refuse(reading->reason, REFOCUS_ERR_FORMAT,
                      "strokes[%d] must have a disparity or a gradient to fill with", index);
    if (stroke->kind == REFOCUS_STROKE_ALL || stroke->kind == REFOCUS_STROKE_FILL)
        return REFOCUS_OK;
    if (!json_object_get(object, "radius"))
        return refuse(reading->reason, REFOCUS_ERR_FORMAT,
                      "strokes[%d] must have a radius, 0.5 to 4096 pixels", index);
    status = read_key(reading, index, object, "radius", 0.5, 4096, &stroke->radius);
    if (status == REFOCUS_OK)
        status = read_key(reading, index, object, "reach", 1, 64, &stroke->reach);
    return status == REFOCUS_OK ? read_points(reading, index, object, points, count) : status;
}

static int paint(struct reading *reading, int index, json_t *object)
{
    struct refocus_stroke stroke;
    float *points;
    int count, status;

    status = read_stroke(reading, index, object, &stroke, &points, &count);
    if (status == REFOCUS_OK) {
        status = refocus_strokes_begin(reading->strokes, &stroke, NULL);
        if (status == REFOCUS_ERR_STATE)
            status = refuse(reading->reason, REFOCUS_ERR_FORMAT,
                            "strokes[%d] is '%s', which needs %s before it", index,
                            rf_stroke_kinds[stroke.kind],
                            stroke.kind == REFOCUS_STROKE_FILL ? "a layer" : "an object");
        else if (status == REFOCUS_OK && count > 0)
            status = refocus_strokes_extend(reading->strokes, points, count, NULL);
        if (status == REFOCUS_ERR_MEMORY)
            no_memory(reading->reason);
        if (status == REFOCUS_ERR_SIZE)
            refuse(reading->reason, status, "more than %d strokes or %d points",
                   (int)REFOCUS_MAX_STROKES, (int)REFOCUS_MAX_STROKE_POINTS);
    }
    free(points);
    return status;
}

/* The members of the file but for the strokes. */
static int read_head(struct reading *reading, json_t *root)
{
    static const char *const known[] = {"refocus-strokes", "width", "height", "strokes", NULL};
    json_t *const width = json_object_get(root, "width");
    json_t *const height = json_object_get(root, "height");
    const char *strange;

    if (!json_is_object(root) || !json_object_get(root, "refocus-strokes"))
        return refuse(reading->reason, REFOCUS_ERR_FORMAT,
                      "no file of strokes: it has no key 'refocus-strokes'");
    if (json_integer_value(json_object_get(root, "refocus-strokes")) != RF_STROKES_VERSION)
        return refuse(reading->reason, REFOCUS_ERR_FORMAT,
                      "'refocus-strokes' must be %d, the version that is known here",
                      RF_STROKES_VERSION);
    strange = strange_key(root, known);
    if (strange)
        return refuse(reading->reason, REFOCUS_ERR_FORMAT, "it has an unknown key '%.40s'",
                      strange);
    if (!json_is_integer(width) || !json_is_integer(height))
        return refuse(reading->reason, REFOCUS_ERR_FORMAT,
                      "width and height must be those of the photo, %dx%d", (int)reading->width,
                      (int)reading->height);
    if (json_integer_value(width) != reading->width ||
        json_integer_value(height) != reading->height)
        return refuse(reading->reason, REFOCUS_ERR_SIZE,
                      "its strokes are of a picture of %lldx%lld, the photo has %dx%d",
                      (long long)json_integer_value(width), (long long)json_integer_value(height),
                      (int)reading->width, (int)reading->height);
    if (!json_is_array(json_object_get(root, "strokes")))
        return refuse(reading->reason, REFOCUS_ERR_FORMAT, "'strokes' must be a list");
    return REFOCUS_OK;
}

static int paint_all(struct reading *reading, json_t *root)
{
    json_t *const list = json_object_get(root, "strokes");
    const int before = refocus_strokes_count(reading->strokes);
    struct rf_spans kept;
    int status = rf_strokes_hold(reading->strokes, &kept);

    if (status != REFOCUS_OK)
        return no_memory(reading->reason);
    for (size_t i = 0; i < json_array_size(list) && status == REFOCUS_OK; i++)
        status = paint(reading, (int)i, json_array_get(list, i));
    if (status == REFOCUS_OK) {
        status = rf_strokes_release(reading->strokes);
        if (status == REFOCUS_ERR_SIZE)
            refuse(reading->reason, status,
                   "its strokes reach over too much of the picture too often; give fewer or "
                   "smaller ones");
        else if (status != REFOCUS_OK)
            no_memory(reading->reason);
    }
    if (status != REFOCUS_OK)
        rf_strokes_return(reading->strokes, before, &kept);
    rf_spans_free(&kept);
    return status;
}

int refocus_strokes_load(struct refocus_strokes *strokes, const void *bytes, size_t size,
                         struct refocus_strokes_reason *reason)
{
    struct refocus_strokes_reason unread;
    struct reading reading = {strokes, reason ? reason : &unread, 0, 0};
    json_error_t error;
    json_t *root;
    int status;

    reading.reason->text[0] = '\0';
    if (!strokes || (!bytes && size > 0))
        return REFOCUS_ERR_ARGUMENT;
    rf_strokes_size(strokes, &reading.width, &reading.height);
    if (size == 0)
        return refuse(reading.reason, REFOCUS_ERR_FORMAT, "it is empty");
    if (size > MAX_BYTES)
        return refuse(reading.reason, REFOCUS_ERR_SIZE, "it has more than %d bytes",
                      (int)MAX_BYTES);
    root = json_loadb(bytes, size, JSON_REJECT_DUPLICATES, &error);
    if (!root) {
        /* jansson has no words for a failed allocation. */
        if (json_error_code(&error) == json_error_out_of_memory || error.line < 1 || !error.text[0])
            return no_memory(reading.reason);
        return refuse(reading.reason, REFOCUS_ERR_FORMAT, "line %d is no JSON: %s", error.line,
                      error.text);
    }
    status = read_head(&reading, root);
    if (status == REFOCUS_OK)
        status = paint_all(&reading, root);
    json_decref(root);
    return status;
}

#else
int refocus_strokes_load(struct refocus_strokes *strokes, const void *bytes, size_t size,
                         struct refocus_strokes_reason *reason)
{
    (void)strokes;
    (void)bytes;
    (void)size;
    if (reason)
        snprintf(reason->text, sizeof reason->text,
                 "this build reads no files of strokes; build it with jansson");
    return REFOCUS_ERR_UNSUPPORTED;
}
#endif
