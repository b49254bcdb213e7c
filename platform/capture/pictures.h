/* Names of picture sequences: "frames-%04d.png". */
#ifndef RF_CAPTURE_PICTURES_H
#define RF_CAPTURE_PICTURES_H

#include <stdbool.h>
#include <stddef.h>

/* Conversions in the pattern: 0 or 1; -1 when there are others than one %d, %Nd or
 * %0Nd. */
int rf_pattern_check(const char *pattern);
/* The name of picture number n; false when it does not fit. */
bool rf_pattern_name(char *name, size_t size, const char *pattern, int n);

#endif
