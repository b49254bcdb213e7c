/* paint.c: depth is painted by strokes from the page, each an element of a file of strokes. */
#include <stdlib.h>
#include <string.h>
#include "serve/serving.h"

static void answer_count(struct serving *s)
{
    answer_json(s, json_pack("{s:i, s:i}", "strokes", refocus_strokes_count(s->strokes), "undone",
                             (int)json_array_size(s->undone)));
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

static void changed(struct serving *s)
{
    s->small_stale = s->full_stale = true;
    answer_count(s);
}

void serve_answer_stroke(struct serving *s, const char *bytes, size_t size)
{
    json_error_t error;
    json_t *const stroke = json_loadb(bytes, size, JSON_REJECT_DUPLICATES, &error);
    int status = begin(s);

    if (status == EXIT_DONE && !json_is_object(stroke))
        status = failed(REFOCUS_ERR_FORMAT, "it is no JSON object");
    if (status == EXIT_DONE)
        status = add(s, stroke);
    json_decref(stroke);
    if (status != EXIT_DONE) {
        answer_failure(s, ANSWER_WRONG);
        return;
    }
    json_array_clear(s->undone);
    changed(s);
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
    int status = begin(s);

    if (status == EXIT_DONE)
        status = again ? redo(s) : undo(s);
    if (status == EXIT_DONE)
        changed(s);
    else
        answer_failure(s, ANSWER_REPLACED);
}

void serve_answer_strokes(struct serving *s)
{
    if (begin(s) == EXIT_DONE)
        answer_json(s, list(s));
    else
        answer_failure(s, ANSWER_FAILED);
}
