/* stack_frames.h: the frames of a focus stack: where they are focused, or how wide their apertures
 * are.
 */
#ifndef RF_CLI_STACK_FRAMES_H
#define RF_CLI_STACK_FRAMES_H

#include <stdbool.h>
#include <stdint.h>
#include <refocus/stack.h>
#include "inputs/input.h"

/* Choices of --in-focus. */
enum in_focus {
    IN_FOCUS_AUTO, /* frames differ in focus, unless their EXIF tells of apertures */
    IN_FOCUS_NEAREST,
    IN_FOCUS_FARTHEST
};

struct stack_frames {
    const char *const *file;
    const char *called;   /* name of all of them in reports; NULL: their files */
    int count, reference; /* the latter from 0 on */
    uint32_t kind;        /* enum refocus_stack_kind */
    double position[REFOCUS_STACK_MOST_FRAMES]; /* see refocus_stack_add() */
    bool no_unit;                               /* positions are not dioptres */
    bool of_files;                              /* positions are distances of EXIF, or f-numbers */
    bool bits_told; /* a frame has more than 8 bits, and a line says so */
};

/* Sets all but `reference`, `called` and `bits_told` of frames whose files are counted. `text` is
 * that of
 * --positions, or NULL. Returns an exit code and prints why. */
int stack_frames_read(struct stack_frames *frames, const char *text, int in_focus);

/* The frame that the photo is like, if none is asked for: that in the middle of the focus, as the
 * library counts, or that of the smallest aperture. */
int stack_frames_reference(const struct stack_frames *frames);

/* Read frame k, ended by input_free(), also after an error: what takes 8 bits of more is told once.
 * Returns an exit code and prints why. */
int stack_frames_photo(struct stack_frames *frames, int k, struct input *input);

/* Take what the file says whose geometry the result has, where that is another one than the photo
 * was read from. Returns an exit code and prints why. */
int stack_frames_settle(struct stack_frames *frames, struct input *input);

#endif
