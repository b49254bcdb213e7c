/* failure.c: errors of sources and sinks are put into words. */
#define _GNU_SOURCE /* strerror_r */
#include "failure.h"
#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

int rf_capture_fail(struct refocus_reason *reason, int status, const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    vsnprintf(reason->text, sizeof reason->text, format, arguments);
    va_end(arguments);
    for (char *c = reason->text; *c; c++)
        if ((unsigned char)*c < 32 || *c == 127)
            *c = '?';
    return status;
}

int rf_capture_fail_memory(struct refocus_reason *reason)
{
    return rf_capture_fail(reason, REFOCUS_ERR_MEMORY,
                           "not enough memory; use a smaller size or fewer buffers");
}

int rf_capture_fail_errno(struct refocus_reason *reason, int error, const char *what)
{
    char words[128]; /* the GNU strerror_r may use it, and returns what to print */

    switch (error) {
    case ENOENT:
    case ENXIO:
    case ENODEV:
        return rf_capture_fail(reason, REFOCUS_ERR_GONE,
                               "%s: it is not there; give another name, or plug the camera in",
                               what);
    case EBUSY:
        return rf_capture_fail(reason, REFOCUS_ERR_BUSY,
                               "%s: used by another program; end that one first", what);
    case EACCES:
    case EPERM:
        return rf_capture_fail(
            reason, REFOCUS_ERR_PERMISSION,
            "%s: access is refused; for a camera become a member of the group 'video'", what);
    case ENOMEM:
        return rf_capture_fail_memory(reason);
    case EPIPE:
        return rf_capture_fail(reason, REFOCUS_ERR_GONE,
                               "%s: the reader closed it; keep it open as long as wanted", what);
    default:
        return rf_capture_fail(reason, REFOCUS_ERR_IO, "%s: %s", what,
                               strerror_r(error, words, sizeof words));
    }
}
