/* stack_shots.h: a camera moves its lens and photographs a focus stack into a folder. */
#ifndef RF_CLI_STACK_SHOTS_H
#define RF_CLI_STACK_SHOTS_H

#include <stdbool.h>
#include <refocus/platform/source.h>
#include <refocus/stack.h>

/* How a stack is photographed. */
struct shots_settings {
    const char *camera;
    double steps;    /* positions of the lens */
    double range[2]; /* the farthest and the nearest; NAN: those of the lens */
    double average;  /* frames at each position */
    double settle;   /* milliseconds that a lens needs to come to rest */
    double size[2];  /* width and height, or NAN */
};

struct shots {
    const struct shots_settings *settings;
    struct refocus_source *source;
    struct refocus_source_lens lens;
    int count;
    double asked[REFOCUS_STACK_MOST_FRAMES];    /* positions, the farthest first */
    double reported[REFOCUS_STACK_MOST_FRAMES]; /* as the lens says; those that were asked for
                                                   where it says nothing */
};

/* These return exit codes and print why it is not EXIT_DONE. */

/* Open the camera and plan positions, evenly between the ends of the range. */
int shots_plan(struct shots *shots, const struct shots_settings *settings);
/* Photograph all into an empty folder, with names from shots_name() and stack.json, which holds the
 * positions. */
int shots_take(struct shots *shots, const char *folder, const char *ending);
/* NAN and NULL are fine. */
void shots_end(struct shots *shots);

enum { SHOTS_NAME = 4096 };
/* The file of frame k, or of the positions for k < 0; false where it is too long. */
bool shots_name(char name[SHOTS_NAME], const char *folder, int k, const char *ending);
/* Remove what shots_take() has made, and the folder. */
void shots_remove(const struct shots *shots, const char *folder, const char *ending);

#endif
