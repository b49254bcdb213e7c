/* result.h: the size, the quality and the place of a picture that is written. */
#ifndef RF_CLI_RESULT_H
#define RF_CLI_RESULT_H

#include <math.h>
#include <stdbool.h>
#include <refocus/image.h>
#include <refocus/platform/file.h>
#include "line/option.h"

struct result_settings {
    const char *resize; /* or NULL */
    double quality;     /* NAN: the default */
    int format;         /* index of result_format(); 0: by the name */
    bool standard;      /* the picture goes to standard output */
};

#define RESULT_SETTINGS_NONE                                                                       \
    {                                                                                              \
        .quality = NAN                                                                             \
    }

/* "auto", and the endings of pictures without their dots; NULL behind the last. */
const char *result_format(uint32_t index);

/* The options of struct result_settings. */
extern const struct option result_options[];

/* These return exit codes and print why it is not EXIT_DONE. */

/* Check the options before the work; `output` is the name that is written. alone: the picture is
 * no one of several, of which some may be no JPEG. */
int result_check(const struct result_settings *settings, const char *output, bool alone);

/* Give a packed picture the size that is asked for; its pixels are freed and made anew. */
int result_resize(const struct result_settings *settings, struct refocus_image *picture);

/* Write the picture as output_write_image() does, or to standard output in the format that the name
 * says. */
int result_write(const struct result_settings *settings, const char *output,
                 const struct refocus_image *picture, struct refocus_write_options options);

#endif
