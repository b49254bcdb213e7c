/* reason.c: errors and evidence are put into words. */
#include "reason.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void rf_clean_text(char *text)
{
    for (; *text; text++)
        if (*text < 0x20 || *text > 0x7e)
            *text = '?';
}

static void write_line(char *line, size_t size, const char *format, va_list arguments)
{
    vsnprintf(line, size, format, arguments);
    rf_clean_text(line);
}

int rf_fail(struct refocus_reason *reason, int status, const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    write_line(reason->text, sizeof reason->text, format, arguments);
    va_end(arguments);
    return status;
}

int rf_fail_memory(struct refocus_reason *reason)
{
    return rf_fail(reason, REFOCUS_ERR_MEMORY,
                   "not enough memory; use a smaller picture or free some memory");
}

int rf_fail_errno(struct refocus_reason *reason, int error, const char *what)
{
    char words[128];

    if (error == ENOMEM)
        return rf_fail_memory(reason);
    if (strerror_r(error, words, sizeof words) != 0)
        snprintf(words, sizeof words, "error %d", error);
    return rf_fail(reason, REFOCUS_ERR_IO, "%s: %s", what, words);
}

int rf_fail_absent(struct refocus_reason *reason, const char *format, const char *library)
{
    return rf_fail(reason, REFOCUS_ERR_UNSUPPORTED, "this build has no %s; build it with %s",
                   format, library);
}

void rf_note(struct refocus_photo_info *info, const char *format, ...)
{
    va_list arguments;

    if (info->evidence_count >= REFOCUS_INFO_LINES)
        return;
    va_start(arguments, format);
    write_line(info->evidence[info->evidence_count++], REFOCUS_INFO_LENGTH, format, arguments);
    va_end(arguments);
}

void rf_leave_out(struct refocus_reason *reason, const char *format, ...)
{
    size_t used = strlen(reason->text);
    va_list list;

    used += (size_t)snprintf(reason->text + used, sizeof reason->text - used, "%s",
                             used > 0 && used < sizeof reason->text - 2 ? "; " : "");
    va_start(list, format);
    vsnprintf(reason->text + used, sizeof reason->text - used, format, list);
    va_end(list);
}

void rf_note_view(struct refocus_photo_info *info, const char *container, int number)
{
    info->views++;
    rf_note(info, "%s: image %d is another view, for stereo; no depth is made of it unasked",
            container, number);
}
