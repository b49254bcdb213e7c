/* pattern.c: numbered names of files, such as frames-%04d.png. */
#include <glob.h>
#include <limits.h>
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

/* Whether the name is one that the pattern makes, and its number. */
static bool is_of_pattern(const char *name, const char *pattern, long *n)
{
    char made[PATH_MAX];

    *n = strtol(name + (strchr(pattern, '%') - pattern), NULL, 10);
    return *n >= 0 && *n <= INT_MAX && rf_pattern_name(made, sizeof made, pattern, (int)*n) &&
           strcmp(made, name) == 0;
}

/* The pattern as glob() wants it: a star in place of the number, and the rest as it is. */
static void write_glob(char *to, const char *pattern)
{
    for (; *pattern; pattern++) {
        if (*pattern == '%') {
            pattern += strcspn(pattern, "d");
            *to++ = '*';
            continue;
        }
        if (strchr("*?[]\\", *pattern))
            *to++ = '\\';
        *to++ = *pattern;
    }
    *to = '\0';
}

bool rf_pattern_each(const char *pattern, void (*each)(void *user, const char *path, int n),
                     void *user)
{
    char *const text = malloc(2 * strlen(pattern) + 1);
    glob_t found;
    int status = GLOB_NOSPACE;
    long n;

    if (text) {
        write_glob(text, pattern);
        status = glob(text, GLOB_NOSORT, NULL, &found);
    }
    for (size_t i = 0; status == 0 && i < found.gl_pathc; i++)
        if (is_of_pattern(found.gl_pathv[i], pattern, &n))
            each(user, found.gl_pathv[i], (int)n);
    if (status == 0)
        globfree(&found);
    free(text);
    return status != GLOB_NOSPACE;
}
