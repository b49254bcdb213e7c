/* save.c: what the page saves: the files that `refocus render` would write. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "inputs/painted.h"
#include "outputs/editable.h"
#include "outputs/outputs.h"
#include "serve/serving.h"

int serve_take_back(int status, char *path, struct refocus_blob *bytes)
{
    struct refocus_reason reason = {""};

    if (status == EXIT_DONE && refocus_file_read(path, UINT64_MAX, bytes, &reason) != REFOCUS_OK)
        status = report_failure(EXIT_FAILED, path, "%s", reason.text);
    unlink(path);
    free(path);
    return status;
}

int serve_temporary(const char *ending, char **path)
{
    const char *const folder = getenv("TMPDIR");
    struct refocus_reason reason = {""};
    char beside[4096];

    snprintf(beside, sizeof beside, "%s/refocus.%s", folder && *folder ? folder : "/tmp", ending);
    if (refocus_file_temporary(beside, path, &reason) != REFOCUS_OK)
        return report_failure(EXIT_FAILED, "temporary file", "%s", reason.text);
    return EXIT_DONE;
}

int serve_encode(const char *ending, const struct refocus_image *image,
                 const struct refocus_write_options *options, struct refocus_blob *bytes)
{
    struct refocus_write_options quick = *options;
    char *path = NULL;
    int status = serve_temporary(ending, &path);

    quick.unsynced = 1;
    if (status != EXIT_DONE)
        return status;
    return serve_take_back(output_write_image(path, image, &quick), path, bytes);
}

static int encode_depth(const struct serving *s, struct refocus_blob *bytes)
{
    const struct refocus_image *const photo = s->input.photo->image;
    char *path = NULL;
    int status = serve_temporary("png", &path);

    if (status != EXIT_DONE)
        return status;
    return serve_take_back(
        output_write_gray16(path, serve_disparity(s), photo->width, photo->height), path, bytes);
}

/* The depth that goes into the result: the one that was painted. */
static void take_painted(const struct serving *s, struct input *input)
{
    painted_begin(input, &s->base.depth);
    input->disparity = (uint16_t *)refocus_strokes_disparity(s->strokes);
    input->confidence = NULL;
}

#ifdef RF_HAVE_EDITABLE
static const bool can_edit = true;
#else
static const bool can_edit = false;
#endif

static int save_picture(struct serving *s, const struct shot_settings *settings, const char *name,
                        struct refocus_blob *bytes)
{
    const bool floats =
        s->input.photo->deep->plane[0] && s->input.photo->deep->format != REFOCUS_FORMAT_RGB16;
    const bool depth = s->has_depth || serve_is_painted(s);
    const bool jpeg = strcmp(name, "picture.jpg") == 0;
    const struct keep_settings keep = {.editable = can_edit && jpeg && depth && !floats,
                                       .no_editable = !can_edit || !depth};
    struct editable editable = {.options = output_keeps(NULL)};
    struct refocus_image picture = {0};
    struct engine engine;
    int status = serve_render(s, settings, keep_has_light(&keep, name), &engine, &picture);

    if (status == EXIT_DONE) {
        struct input input = s->input;

        if (serve_is_painted(s))
            take_painted(s, &input);
        status = keep_options(&keep, &input, &s->base.depth, name, true, &engine.params.render,
                              &editable);
        if (status == EXIT_DONE && engine.rendered.plane[0])
            editable.options.light = &engine.rendered;
        if (status == EXIT_DONE)
            status = serve_encode(jpeg ? "jpg" : "png", &picture, &editable.options, bytes);
    }
    engine_end(&engine);
    free(picture.plane[0]);
    return status;
}

static int save_settings(const struct shot_settings *settings, struct refocus_blob *bytes)
{
    char *const text = settings_dump(&page_settings, settings);

    if (!text)
        return report_failure(EXIT_FAILED, "settings", "not enough memory");
    *bytes = (struct refocus_blob){(uint8_t *)text, strlen(text)};
    return EXIT_DONE;
}

void serve_answer_save(struct serving *s, const struct rf_web_ask *ask, const char *bytes)
{
    enum { JPEG, PNG, SETTINGS, DEPTH };
    static const struct {
        const char *word, *type, *ending;
    } formats[] = {[JPEG] = {"jpeg", "image/jpeg", "refocused.jpg"},
                   [PNG] = {"png", "image/png", "refocused.png"},
                   [SETTINGS] = {"settings", "application/json", "settings.json"},
                   [DEPTH] = {"depth", "image/png", "depth.png"}};
    struct refocus_blob file = {0};
    struct shot_settings settings;
    int status, format = JPEG;

    if (!serve_has_settings(s, ask, bytes, &settings))
        return;
    while (format < DEPTH && strcmp(formats[format].word, ask->word) != 0)
        format++;
    if (format == SETTINGS)
        status = save_settings(&settings, &file);
    else if (format == DEPTH)
        status = encode_depth(s, &file);
    else if (s->feed)
        status = format == JPEG ? serve_live_still(s, &file)
                                : report_failure(EXIT_WRONG, s->work->name,
                                                 "what is captured is a JPEG; ask for that");
    else
        status = save_picture(s, &settings, format == JPEG ? "picture.jpg" : "picture.png", &file);
    if (status == EXIT_DONE)
        answer_bytes(s, formats[format].type, formats[format].ending, file.data, file.size);
    else
        answer_failure(s, status == EXIT_WRONG ? ANSWER_WRONG : ANSWER_FAILED);
}
