/* pattern.c: numbered names of files, such as frames-%04d.png. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "pattern.h"

/* The text behind the conversion that begins at the percent sign, or NULL when the conversion is
 * not one of ours. */
static const char *conversion(const char *percent, int *width, bool *zeros)
{
    char *end;
    long n;

    *zeros = percent[1] == '0';
    if (percent[1] != 'd' && (percent[1] < '0' || percent[1] > '9'))
        return NULL;
    n = strtol(percent + 1, &end, 10);
    if (*end != 'd' || n > 20)
        return NULL;
    *width = (int)n;
    return end + 1;
}

int rf_pattern_check(const char *pattern)
{
    const char *percent = strchr(pattern, '%');
    int width;
    bool zeros;

    if (!percent)
        return 0;
    pattern = conversion(percent, &width, &zeros);
    return pattern && !strchr(pattern, '%') ? 1 : -1;
}

bool rf_pattern_name(char *name, size_t size, const char *pattern, int n)
{
    const char *percent = strchr(pattern, '%');
    const char *rest;
    int width, length;
    bool zeros;

    if (!percent)
        return (size_t)snprintf(name, size, "%s", pattern) < size;
    rest = conversion(percent, &width, &zeros);
    if (!rest)
        return false;
    length =
        zeros
            ? snprintf(name, size, "%.*s%0*d%s", (int)(percent - pattern), pattern, width, n, rest)
            : snprintf(name, size, "%.*s%*d%s", (int)(percent - pattern), pattern, width, n, rest);
    return length > 0 && (size_t)length < size;
}
