/* parse.c: a text becomes JSON, or a line that says where it is none. */
#include "settings/settings.h"

#include "line/report.h"

json_t *settings_parse(const char *file, const char *bytes, size_t size)
{
    json_error_t error;
    json_t *const root = json_loadb(bytes, size, JSON_REJECT_DUPLICATES, &error);

    if (!root)
        report_failure(EXIT_FAILED, file, "is not JSON: line %d, column %d: %s", error.line,
                       error.column, error.text);
    return root;
}
