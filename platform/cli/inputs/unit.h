/* unit.h: what the samples of a depth file may mean that does not say it. */
#ifndef RF_CLI_UNIT_H
#define RF_CLI_UNIT_H

#include <stdbool.h>
#include <refocus/platform/file.h>

enum { UNIT_LINE = 240 };

/* Writes a line of up to UNIT_LINE bytes where samples that are taken for disparities, as no unit
 * is known, look like distances or the inverse. Of a map that will be turned, upper and lower half
 * are not known. */
bool unit_is_doubtful(const struct refocus_photo *photo, bool turned, char line[UNIT_LINE]);

#endif
