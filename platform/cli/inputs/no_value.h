/* no_value.h: what the least and the greatest sample of a map of disparities may stand for. */
#ifndef RF_CLI_NO_VALUE_H
#define RF_CLI_NO_VALUE_H

#include <stdbool.h>
#include <refocus/refocus.h>

enum { ENDS_LINE = 240 };

/* Writes a line where an end of the samples looks like a code for no value, unless such codes are
 * given, or where whole numbers use less than a tenth of the range of their type. */
bool ends_are_doubtful(const struct refocus_depth_map *map, bool codes_given, char line[ENDS_LINE]);

#endif
