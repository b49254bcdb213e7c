/* unit.h: what the samples of a depth file may mean that does not say it. */
#ifndef RF_CLI_UNIT_H
#define RF_CLI_UNIT_H

#include <stdbool.h>
#include <refocus/platform/file.h>
#include "inputs/no_value.h"
#include "inputs/input.h"

enum { UNIT_LINE = ENDS_LINE };

/* Writes a line of up to UNIT_LINE bytes where samples of a depth file that are taken for
 * disparities look like distances or the inverse, as no unit is given, have an end that looks like
 * a code for no value, as none is given, or use little of the range of their type. Of a map that
 * will be turned, top and bottom are not known. */
bool unit_is_doubtful(const struct refocus_photo *photo, const struct depth_settings *settings,
                      bool turned, char line[UNIT_LINE]);

#endif
