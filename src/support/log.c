/* log.c: writes the lines of log.h. */
#include "support/log.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { LINE = 256 };

static void say(const struct rf_log *log, const char *format, va_list arguments)
{
    char line[LINE];
    int begun;

    if (!log || !log->to.message)
        return;
    begun = snprintf(line, sizeof line, "%s: ", log->function);
    if (begun < 0 || begun >= LINE)
        return;
    vsnprintf(line + begun, sizeof line - (size_t)begun, format, arguments);
    log->to.message(log->to.user, line);
}

int rf_refuse(const struct rf_log *log, int status, const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    say(log, format, arguments);
    va_end(arguments);
    return status;
}

int rf_read_struct(const struct rf_log *log, const char *name, void *own, size_t known,
                   size_t first, const void *given)
{
    const int status = refocus_struct_read(own, known, first, given);
    uint32_t size;

    if (!status || !given)
        return status ? rf_refuse(log, status, "%s is NULL", name) : status;
    memcpy(&size, given, sizeof size);
    if (status == REFOCUS_ERR_UNSUPPORTED)
        return rf_refuse(
            log, status,
            "%s sets a field behind its first %zu bytes, which librefocus " REFOCUS_VERSION_STRING
            " does not know; 0 is its default",
            name, known);
    return rf_refuse(log, status, "the struct_size of %s is %u, may be %zu to %d", name,
                     (unsigned)size, first, REFOCUS_MAX_STRUCT_SIZE);
}
