/* view_save.c: pictures, settings and depth of `refocus view` are saved. */
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
    return true;
}

static void count(struct view_saving *saving, int status, const char *name, char *words)
{
    snprintf(words, RF_VIEW_WORDS, status == EXIT_DONE ? "saved %.200s" : "%.200s was not saved",
             name);
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

void view_save(void *user, const struct rf_view_result *result, char words[RF_VIEW_WORDS])
{
    struct view_saving *const saving = user;
    const struct view_names *const names = &saving->names;
    const struct refocus_image *const picture = result->picture;
    struct refocus_write_options keeps = output_keeps(saving->input->photo);

    keeps.light = result->light;
    if (result->what & RF_SAVE_PICTURE)
        count(saving, output_write_image(names->picture, picture, &keeps), names->picture, words);
    if (result->what & RF_SAVE_SETTINGS)
        count(saving, saving->settings(saving->of, result, names->settings), names->settings,
              words);
    if (result->what & RF_SAVE_DEPTH) {
        count(saving,
              output_write_gray16(names->depth, result->disparity, picture->width, picture->height),
              names->depth, words);
    }
}
