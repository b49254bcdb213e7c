/* depth_output.h: what the command `refocus depth` writes: disparities, a picture of them, or a
 * photo with the depth in it, and a report. */
#ifndef RF_CLI_DEPTH_OUTPUT_H
#define RF_CLI_DEPTH_OUTPUT_H

#include "commands/depth_stack.h"
#include "inputs/read_input.h"
#include "inputs/estimate.h"

enum depth_view { VIEW_NONE, VIEW_DISPARITY, VIEW_CONFIDENCE };

struct depth_command_settings {
    struct depth_settings depth;
    double focus_at[2], blur;
    const char *output, *model, *strokes;
    struct network_settings network;
    int view;
    struct stereo_settings stereo;
    struct stack_settings stack;
    bool side_by_side;
    bool json;
};

/* Write settings->output. Returns an exit code and prints why. */
int depth_output_write(const struct depth_command_settings *settings, const struct input *input);
/* Print the report, as text or JSON. Returns an exit code. */
int depth_output_report(const struct depth_command_settings *settings, const struct input *input);

#endif
