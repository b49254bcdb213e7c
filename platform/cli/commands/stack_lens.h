/* stack_lens.h: the lens of a camera is moved to the positions of a focus stack. */
#ifndef RF_CLI_STACK_LENS_H
#define RF_CLI_STACK_LENS_H

#include <stdbool.h>
#include <refocus/platform/source.h>
#include <refocus/stack.h>

/* How a stack is photographed. */
struct shots_settings {
    const char *camera;
    const char *option; /* the option that has steps and range; NULL: --steps and --range */
    double steps;       /* positions of the lens */
    double range[2];    /* the farthest and the nearest; NAN: those of the lens */
    double average;     /* frames at each position */
    double settle;      /* milliseconds that a lens needs to come to rest */
    double size[2];     /* width and height, or NAN */
};

struct shots {
    const struct shots_settings *settings;
    struct refocus_source *source;
    struct refocus_source_lens lens;
    int count;
    double asked[REFOCUS_STACK_MOST_FRAMES];    /* positions, the farthest first */
    double reported[REFOCUS_STACK_MOST_FRAMES]; /* as the lens says; those that were asked for
                                                   where it says nothing */
    bool ends_quietly; /* an interrupted wait is EXIT_FAILED without a line */
};

/* How far two positions lie apart. */
double shots_step(const struct shots *shots);

/* These return exit codes and print why it is not EXIT_DONE. */

/* Say why a function of the source failed. */
int shots_fail(const struct shots *shots, int status, const struct refocus_reason *reason);
/* Take the next frame that is whole. */
int shots_next_frame(struct shots *shots, const struct refocus_frame **frame);
/* Let frames pass for so long. */
int shots_pass_time(struct shots *shots, double ms);
/* Ask for a position, without waiting for the lens. */
int shots_focus(struct shots *shots, double position);
/* Move the lens to position k. It may be off, but has to be nearer than the one before. */
int shots_move_lens(struct shots *shots, int k);
/* Move the lens to position k, whatever the others are, and wait until it is there. */
int shots_rest(struct shots *shots, int k);

#endif
