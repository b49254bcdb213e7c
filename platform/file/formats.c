/* formats.c: a picture format is looked up by the content of a file or by the end of its name. */
#include "formats.h"

#include <stdio.h>
#include <string.h>

#include <refocus/platform/file.h>
#include "letters.h"

#define RF_FORMAT_POINTER(name) &rf_format_##name,
static const struct rf_format *const formats[] = {RF_FORMAT_LIST(RF_FORMAT_POINTER)};
enum { FORMATS = sizeof formats / sizeof *formats };

const struct rf_format *rf_format_of_content(struct rf_bytes file)
{
    for (int i = 0; i < FORMATS; i++)
        if (formats[i]->recognise(file))
            return formats[i];
    return NULL;
}

bool rf_format_is_known(struct rf_bytes file)
{
    return rf_format_of_content(file) != NULL;
}

const struct rf_format *rf_format_of_name(const char *path)
{
    const char *const dot = strrchr(path, '.');

    for (int i = 0; dot && i < FORMATS; i++) {
        for (const char *const *ending = formats[i]->endings; *ending; ending++)
            if (rf_same_word(dot, *ending))
                return formats[i];
    }
    return NULL;
}

const char *refocus_file_ending(int depth, int index)
{
    if (index < 0)
        return NULL;
    for (int i = 0; i < FORMATS; i++) {
        const bool fits = depth ? formats[i]->writes_depth : formats[i]->writes_pictures;

        for (const char *const *ending = formats[i]->endings; fits && *ending; ending++)
            if (index-- == 0)
                return *ending;
    }
    return NULL;
}

void rf_list_endings(char *text, size_t size, bool depth)
{
    size_t used = 0;

    for (int i = 0; refocus_file_ending(depth, i) && used < size; i++) {
        const char *const before = i == 0 ? "" : refocus_file_ending(depth, i + 1) ? ", " : " or ";

        used += (size_t)snprintf(text + used, size - used, "%s%s", before,
                                 refocus_file_ending(depth, i));
    }
}
