/* compare_report.h: the scores of `refocus compare`. */
#ifndef RF_CLI_COMPARE_REPORT_H
#define RF_CLI_COMPARE_REPORT_H

#include "compare/compare_picture.h"

/* Prints a row for each picture but the reference, which is the first. Returns an exit code and
 * prints why it is not EXIT_DONE. */
int compare_report(const struct comparison *comparison, const struct engine *engine,
                   const char *photo, const char *reference, int border, bool as_json);

#endif
