/* quiet_report.c: line/report.h where nothing is printed, and outputs/outputs.h where nothing is
 * saved. */
#include "line/report.h"
#include "outputs/outputs.h"

#include <string.h>

int report_failure(int exit_code, const char *what, const char *format, ...)
{
    (void)what;
    (void)format;
    return exit_code;
}

int output_write_file(const char *path, const void *bytes, size_t size)
{
    (void)path;
    (void)bytes;
    (void)size;
    return EXIT_DONE;
}

int report_end_output(void)
{
    return EXIT_DONE;
}

void report_clean(char *clean, size_t size, const char *text)
{
    strncpy(clean, text, size - 1);
    clean[size - 1] = '\0';
}
