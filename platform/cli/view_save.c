#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "outputs.h"
#include "report.h"
#include "view_save.h"

bool view_make_names(struct view_names *names, const char *output, const char *photo)
{
    const char *const slash = output ? NULL : strrchr(photo, '/');
    const char *const base = output ? output : slash ? slash + 1 : photo;
    const char *const folder = strrchr(base, '/');
    const char *const dot = strrchr(folder ? folder : base, '.');
    const int stem = dot && dot != base ? (int)(dot - base) : (int)strlen(base);

    if (stem > 900 || strlen(base) > 1000)
        return false;
    if (output)
        snprintf(names->picture, sizeof names->picture, "%s", output);
    else
        snprintf(names->picture, sizeof names->picture, "%.*s-refocused.jpg", stem, base);
    snprintf(names->settings, sizeof names->settings, "%.*s-settings.json", stem, base);
    snprintf(names->depth, sizeof names->depth, "%.*s-depth.png", stem, base);
    snprintf(names->strokes, sizeof names->strokes, "%.*s-strokes.json", stem, base);
    return true;
}

/* Beside its place under another name, then moved there. */
static int write_text(const char *name, const char *text, size_t size)
{
    char beside[1100];
    FILE *file;
    int failed;

    snprintf(beside, sizeof beside, "%s.%ld.part", name, (long)getpid());
    file = fopen(beside, "wb");
    failed = !file || fwrite(text, 1, size, file) != size;
    if (file)
        failed |= fclose(file) != 0;
    if (!failed)
        failed = rename(beside, name) != 0;
    if (!failed)
        return EXIT_DONE;
    failed = errno;
    remove(beside);
    return report_failure(EXIT_FAILED, name, "%s", strerror(failed));
}

/* In the words of the options of `render`. */
static int save_settings(const struct view_saving *saving, const struct refocus_render_params *lens)
{
    json_t *const json = json_pack(
        "{s:o, s:s, s:f, s:f, s:i}", "photo", report_text_json(saving->input->photo_name),
        "method", refocus_method_name(lens->method), "focus", (double)lens->focus_disparity,
        "blur", (double)lens->max_blur_radius, "rays", (int)lens->rays);
    char *const text = json ? json_dumps(json, JSON_INDENT(2) | JSON_REAL_PRECISION(9)) : NULL;
    const int status = text ? write_text(saving->names.settings, text, strlen(text))
                            : report_failure(EXIT_FAILED, saving->names.settings,
                                             "not enough memory");

    free(text);
    json_decref(json);
    return status;
}

static int save_strokes(const struct view_saving *saving, const struct refocus_strokes *strokes)
{
    char *text;
    size_t size;
    int status = refocus_strokes_save(strokes, &text, &size);

    if (status != REFOCUS_OK)
        return report_failure(EXIT_FAILED, saving->names.strokes, "%s",
                              refocus_strerror(status));
    status = write_text(saving->names.strokes, text, size);
    free(text);
    return status;
}

static void count(struct view_saving *saving, int status, const char *name)
{
    if (status != EXIT_DONE) {
        saving->failed++;
        return;
    }
    saving->saved++;
    if (!saving->quiet) {
        printf("saved    %s\n", name);
        fflush(stdout);
    }
}

void view_save(void *user, const struct rf_view_result *result)
{
    struct view_saving *const saving = user;
    const struct view_names *const names = &saving->names;
    const struct refocus_image *const picture = result->picture;

    if (result->what & RF_SAVE_PICTURE)
        count(saving, output_write_image(names->picture, picture, saving->input->photo),
              names->picture);
    if (result->what & RF_SAVE_SETTINGS)
        count(saving, save_settings(saving, result->params), names->settings);
    if (result->what & RF_SAVE_DEPTH) {
        count(saving, output_write_gray16(names->depth, result->disparity, picture->width,
                                          picture->height), names->depth);
        if (refocus_strokes_count(result->strokes) > 0)
            count(saving, save_strokes(saving, result->strokes), names->strokes);
    }
}
