/* settings.h: one way to render, as named on the command line:
 *
 *     LABEL:key=value,key=value      e.g. paper:method=search,iterations=1,rays=full
 */
#ifndef QUALITY_SETTINGS_H
#define QUALITY_SETTINGS_H

#include <stdio.h>
#include <refocus/refocus.h>

struct quality_settings {
    char label[64];
    char against[64]; /* score against that run's picture; empty: the reference */
    int input;        /* method=input: the untouched photo, the floor */
    int32_t threads;
    int32_t cpu;
    int32_t format;  /* a format of Y, U, V to prepare and render in; 0: R, G, B */
    int32_t through; /* a format to convert to and from only, rendered in R, G, B */
    struct refocus_settings render;
};

/* Returns 0, or -1 after a line on standard error. */
int quality_settings_parse(struct quality_settings *settings, const char *text);

/* The keys, one a line. */
void quality_settings_help(FILE *file);

#endif
