/* formats.c: a picture format is looked up by the content of a file or by the end of its name. */
#include "formats.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

#define RF_FORMAT_POINTER(name) &rf_format_##name,
static const struct rf_format *const formats[] = {RF_FORMAT_LIST(RF_FORMAT_POINTER)};
enum { FORMATS = sizeof formats / sizeof *formats };

const struct rf_format *rf_format_of_content(struct rf_bytes file)
{
    for (int i = 0; i < FORMATS; i++) {
        if (formats[i]->recognise(file)) {
            return formats[i];
        }
    }
    return NULL;
}

const struct rf_format *rf_format_of_name(const char *path)
{
    const char *const dot = strrchr(path, '.');

    for (int i = 0; dot && i < FORMATS; i++) {
        for (const char *const *ending = formats[i]->endings; *ending; ending++) {
            if (strcasecmp(dot, *ending) == 0) {
                return formats[i];
            }
        }
    }
    return NULL;
}

void rf_list_endings(char *text, size_t size, bool depth)
{
    const char *known[3 * FORMATS];
    size_t used = 0;
    int count = 0;

    for (int i = 0; i < FORMATS; i++) {
        for (const char *const *ending = formats[i]->endings; *ending; ending++) {
            if (depth ? formats[i]->writes_depth : formats[i]->writes_pictures) {
                known[count++] = *ending;
            }
        }
    }
    for (int i = 0; i < count && used < size; i++) {
        const char *const before = i == 0 ? "" : i + 1 < count ? ", " : " or ";

        used += (size_t)snprintf(text + used, size - used, "%s%s", before, known[i]);
    }
}
