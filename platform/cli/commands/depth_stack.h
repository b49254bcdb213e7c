/* depth_stack.h: depth and an all-in-focus photo are made of a focus stack. */
#ifndef RF_CLI_DEPTH_STACK_H
#define RF_CLI_DEPTH_STACK_H

#include <refocus/stack.h>
#include "commands/stack_frames.h"
#include "inputs/read_input.h"
#include "outputs/outputs.h"

/* How --focal-stack is read. */
struct stack_settings {
    bool on;
    const char *positions; /* dioptres with commas, or a file of JSON; NULL: not known */
    double reference;      /* frame whose geometry the result has, from 1 on; NAN: the middle one */
    int align;             /* enum refocus_stack_align */
    int order;             /* enum refocus_stack_order */
    int in_focus;          /* enum in_focus */
    const char *photo;     /* receives the photo as well, or NULL */
    uint32_t light;        /* format in which a file gets the light of the photo, or 0: none does */
    const char *called;    /* name of all frames in reports and errors; NULL: their files */
};
#define STACK_SETTINGS_NONE                                                                        \
    {                                                                                              \
        false, NULL, NAN, 0, REFOCUS_STACK_ORDER_EITHER, IN_FOCUS_AUTO, NULL, 0, NULL              \
    }

/* The options of struct stack_settings. */
extern const struct option stack_options[];

/* Words of --align, --order and --in-focus. */
extern const struct option_word stack_align_words[], stack_order_words[], stack_in_focus_words[];

/* Read the frames, one after the other, and make the input of them: its photo is in focus
 * everywhere. The list of files ends with NULL. Returns an exit code and prints why. */
int input_read_stack(struct input *input, const char *const *files,
                     const struct stack_settings *how, const struct depth_settings *settings);

/* Judge what a stack is worth: an exit code, with a line, where its frames show no depth, and a
 * warning where they are out of order. */
int stack_judge(const struct refocus_stack_result *result, const char *name);

/* Write the photo of a stack as a picture, or to a temporary file beside the place of a path, whose
 * name free() ends. These return exit codes and print why. */
int stacked_write_photo(const struct input *input, const char *path);
int stacked_write_temporary(const struct input *input, const char *path, char **temporary);

#endif
