/* pattern.h: numbered names of files, such as frames-%04d.png. */
#ifndef RF_CAPTURE_PATTERN_H
#define RF_CAPTURE_PATTERN_H

#include <stdbool.h>
#include <stddef.h>

/* Number of conversions in the pattern, 0 or 1; -1 when it has others than one %d, %Nd or %0Nd. */
int rf_pattern_check(const char *pattern);
/* The name of picture number n; false when it does not fit. */
bool rf_pattern_name(char *name, size_t size, const char *pattern, int n);
/* Calls with each file that is there of a pattern of one number, and that number, in any order;
 * false when there is no memory. */
bool rf_pattern_each(const char *pattern, void (*each)(void *user, const char *path, int n),
                     void *user);

#endif
