/* view_save.c: pictures, settings, depth and strokes of `refocus view` are saved. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "outputs/outputs.h"
#include "line/report.h"
#include "commands/view_save.h"

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

static int save_strokes(const struct view_saving *saving, const struct refocus_strokes *strokes)
{
    char *text;
    size_t size;
    int status = refocus_strokes_save(strokes, &text, &size);

    if (status != REFOCUS_OK)
        return report_failure(EXIT_FAILED, saving->names.strokes, "%s", refocus_strerror(status));
    status = output_write_file(saving->names.strokes, text, size);
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
    const struct refocus_write_options keeps = output_keeps(saving->input->photo);

    if (result->what & RF_SAVE_PICTURE)
        count(saving, output_write_image(names->picture, picture, &keeps), names->picture);
    if (result->what & RF_SAVE_SETTINGS)
        count(saving, saving->settings(saving->of, result, names->settings), names->settings);
    if (result->what & RF_SAVE_DEPTH) {
        count(saving,
              output_write_gray16(names->depth, result->disparity, picture->width, picture->height),
              names->depth);
        if (refocus_strokes_count(result->strokes) > 0)
            count(saving, save_strokes(saving, result->strokes), names->strokes);
    }
}
