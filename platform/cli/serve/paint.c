/* paint.c: depth is painted by strokes from the page, each an element of a file of strokes. */
#include <stdlib.h>
#include <string.h>
#include "serve/serving.h"

static json_t *count_json(const struct serving *s)
{
    return json_pack("{s:i, s:i}", "strokes", refocus_strokes_count(s->strokes), "undone",
                     (int)json_array_size(s->undone));
}

/* The answer to what has changed the strokes. */
static json_t *strokes_json(const struct serving *s)
{
    json_t *const object = count_json(s);

    json_object_set_new(object, "range", serve_range_json(s));
    return object;
}

static int failed(int status, const char *words)
{
    return report_failure(EXIT_WRONG, "stroke", "%s", words[0] ? words : refocus_strerror(status));
}

static int begin(struct serving *s)
{
    const struct refocus_image *const photo = s->input.photo->image;
    const struct refocus_disparity base =
        refocus_disparity16(s->placed, photo->width, photo->height, 2 * (ptrdiff_t)photo->width);
    int status = REFOCUS_OK;

    if (!s->undone)
        s->undone = json_array();
    if (!s->strokes)
        status = refocus_strokes_create(&s->strokes, photo, &base);
    return s->undone && status == REFOCUS_OK ? EXIT_DONE : failed(REFOCUS_ERR_MEMORY, "");
}

/* Paint one more stroke: by the parser of files of them. */
static int add(struct serving *s, json_t *stroke)
{
    const struct refocus_image *const photo = s->input.photo->image;
    struct refocus_strokes_reason reason = {""};
    json_t *const file =
        json_pack("{s:i, s:i, s:i, s:[O]}", "refocus-strokes", 1, "width", (int)photo->width,
                  "height", (int)photo->height, "strokes", stroke);
    char *const text = file ? json_dumps(file, JSON_COMPACT | JSON_REAL_PRECISION(17)) : NULL;
    const int status =
        text ? refocus_strokes_load(s->strokes, text, strlen(text), &reason) : REFOCUS_ERR_MEMORY;

    free(text);
    json_decref(file);
    return status == REFOCUS_OK ? EXIT_DONE : failed(status, reason.text);
}

/* NULL: it is none, which is reported. */
static json_t *read_stroke(const char *bytes, size_t size)
{
    json_t *const stroke = json_loadb(bytes, size, JSON_REJECT_DUPLICATES, NULL);

    if (json_is_object(stroke))
        return stroke;
    json_decref(stroke);
    failed(REFOCUS_ERR_FORMAT, "it is no JSON object");
    return NULL;
}

static void set_draft(struct serving *s, json_t *stroke)
{
    json_decref(s->draft);
    s->draft = json_incref(stroke);
}

static int drop_draft(struct serving *s)
{
    if (s->draft && refocus_strokes_undo(s->strokes, NULL) != REFOCUS_OK)
        return failed(REFOCUS_ERR_MEMORY, "");
    if (s->draft)
        s->small_stale = s->full_stale = true;
    set_draft(s, NULL);
    return EXIT_DONE;
}

/* Have strokes, of which none is a draft. */
static int begin_whole(struct serving *s)
{
    const int status = begin(s);

    return status == EXIT_DONE ? drop_draft(s) : status;
}

/* Whether a stroke is the draft, or goes on from it. */
static bool continues_draft(const struct serving *s, json_t *stroke)
{
    json_t *const points = json_object_get(stroke, "points");
    const json_t *const old = json_object_get(s->draft, "points");
    const json_t *value;
    const char *name;
    bool same = true;
    size_t i;

    if (!old || json_array_size(points) < json_array_size(old) ||
        json_object_size(stroke) != json_object_size(s->draft))
        return false;
    json_object_foreach(stroke, name, value)
    {
        same = same && (value == points || json_equal(value, json_object_get(s->draft, name)));
    }
    json_array_foreach(old, i, value)
    {
        same = same && json_equal(value, json_array_get(points, i));
    }
    return same;
}

/* Paint only what a stroke has more than the draft, which takes a fraction of the time and comes to
 * the same. False: the stroke is to be painted by itself. */
static bool extend_draft(struct serving *s, json_t *stroke)
{
    const json_t *const points = json_object_get(stroke, "points");
    const size_t old = json_array_size(json_object_get(s->draft, "points"));
    const bool longer = continues_draft(s, stroke);
    const size_t count = longer ? json_array_size(points) - old : 0;
    float *const more = malloc((2 * count + 1) * sizeof *more);
    bool done = more && longer;

    for (size_t i = 0; i < count && done; i++) {
        double x, y;

        done = json_unpack(json_array_get(points, old + i), "[F, F!]", &x, &y) == 0;
        if (done) {
            more[2 * i] = (float)x;
            more[2 * i + 1] = (float)y;
        }
    }
    if (done && count > 0)
        done = refocus_strokes_extend(s->strokes, more, (int)count, NULL) == REFOCUS_OK;
    free(more);
    return done;
}

/* Paint a stroke in place of the draft; an empty object is none. */
static int paint(struct serving *s, json_t *stroke)
{
    int status = begin(s);

    if (status != EXIT_DONE || extend_draft(s, stroke))
        return status;
    status = drop_draft(s);
    return status == EXIT_DONE && json_object_size(stroke) > 0 ? add(s, stroke) : status;
}

void serve_answer_stroke(struct serving *s, const char *bytes, size_t size)
{
    json_t *const stroke = read_stroke(bytes, size);
    const int status = stroke ? paint(s, stroke) : EXIT_WRONG;

    json_decref(stroke);
    s->small_stale = s->full_stale = true;
    if (status != EXIT_DONE) {
        answer_failure(s, ANSWER_WRONG);
        return;
    }
    set_draft(s, NULL);
    json_array_clear(s->undone);
    answer_json(s, strokes_json(s));
}

/* The selection of the last stroke, in the size of the reduced photo: first pixel and length of
 * each run of selected ones, row by row; NULL without memory. */
static json_t *selection_json(const struct serving *s)
{
    const size_t pixels = (size_t)s->width * (size_t)s->height;
    uint8_t *const mask = malloc(pixels);
    json_t *const runs = mask ? json_array() : NULL;

    if (mask && refocus_strokes_selection(s->strokes, mask, s->width, s->height, s->width) == 0)
        for (size_t i = 0, end; i < pixels; i = end) {
            for (end = i + 1; end < pixels && mask[end] == mask[i];)
                end++;
            if (mask[i]) {
                json_array_append_new(runs, json_integer((json_int_t)i));
                json_array_append_new(runs, json_integer((json_int_t)(end - i)));
            }
        }
    free(mask);
    return json_pack("{s:i, s:i, s:o}", "width", s->width, "height", s->height, "runs", runs);
}

void serve_answer_draft(struct serving *s, const char *bytes, size_t size)
{
    json_t *const stroke = read_stroke(bytes, size);
    json_t *object;

    s->small_stale = s->full_stale = true;
    if (!stroke || paint(s, stroke) != EXIT_DONE) {
        answer_failure(s, ANSWER_WRONG);
    } else {
        set_draft(s, json_object_size(stroke) > 0 ? stroke : NULL);
        object = count_json(s);
        json_object_set_new(object, "selection", s->draft ? selection_json(s) : json_null());
        answer_json(s, object);
    }
    json_decref(stroke);
}

/* The strokes as their file, parsed. */
static json_t *list(const struct serving *s)
{
    char *text = NULL;
    size_t size = 0;
    json_t *file = NULL;

    if (refocus_strokes_save(s->strokes, &text, &size) == REFOCUS_OK)
        file = json_loadb(text, size, 0, NULL);
    free(text);
    return file;
}

static int undo(struct serving *s)
{
    const int count = refocus_strokes_count(s->strokes);
    json_t *file;
    int status;

    if (count == 0)
        return failed(REFOCUS_ERR_STATE, "there is none to undo");
    file = list(s);
    status = json_array_append(s->undone, json_array_get(json_object_get(file, "strokes"),
                                                         (size_t)count - 1)) == 0
                 ? EXIT_DONE
                 : failed(REFOCUS_ERR_MEMORY, "");
    json_decref(file);
    if (status == EXIT_DONE && refocus_strokes_undo(s->strokes, NULL) != REFOCUS_OK) {
        json_array_remove(s->undone, json_array_size(s->undone) - 1);
        status = failed(REFOCUS_ERR_MEMORY, "");
    }
    return status;
}

static int redo(struct serving *s)
{
    const size_t count = json_array_size(s->undone);
    int status;

    if (count == 0)
        return failed(REFOCUS_ERR_STATE, "there is none to do again");
    status = add(s, json_array_get(s->undone, count - 1));
    if (status == EXIT_DONE)
        json_array_remove(s->undone, count - 1);
    return status;
}

void serve_answer_undo(struct serving *s, bool again)
{
    int status = begin_whole(s);

    if (status == EXIT_DONE)
        status = again ? redo(s) : undo(s);
    s->small_stale = s->full_stale = true;
    if (status == EXIT_DONE)
        answer_json(s, strokes_json(s));
    else
        answer_failure(s, ANSWER_REPLACED);
}

void serve_answer_strokes(struct serving *s)
{
    if (begin_whole(s) == EXIT_DONE)
        answer_json(s, list(s));
    else
        answer_failure(s, ANSWER_FAILED);
}
