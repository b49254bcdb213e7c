/* info_text.h: what the command `refocus info` has found, as text or JSON. */
#ifndef RF_CLI_INFO_TEXT_H
#define RF_CLI_INFO_TEXT_H

#include <jansson.h>
#include "commands/depth_of_field.h"
#include "inputs/read_input.h"
#include "inputs/unit.h"

/* Findings from the pictures of a file, beside those that the input has. */
struct info_findings {
    struct depth_of_field field;
    bool unit_is_doubtful;
    char unit_line[UNIT_LINE]; /* says so */
};

void info_print(const struct input *input, const struct info_findings *found);
/* NULL: there is no memory. */
json_t *info_json(const struct input *input, const struct info_findings *found);

#endif
