/* render_one.h: one photo is rendered and written as `refocus render` is asked to. */
#ifndef RF_CLI_RENDER_ONE_H
#define RF_CLI_RENDER_ONE_H

#include "outputs/editable.h"
#include "outputs/result.h"
#include "shot/shot.h"

struct render_settings {
    struct shot_settings shot;
    const char *output;
    double region[4], parallax, jobs;
    int view;
    struct keep_settings keep;
    struct result_settings result;
};

/* These return exit codes and print why it is not EXIT_DONE. */

/* Check what is read and written before the work. alone: it is the only photo. */
int render_check_files(const struct render_settings *settings, const char *photo, bool alone);

/* Render the photo, write it, and print the report that is asked for. */
int render_one(const struct render_settings *settings, const char *photo);

#endif
