/* check.c: what the tests of sources and sinks share. */
#include "check.h"

#include <dirent.h>

int count_entries(const char *folder)
{
    char path[64];
    DIR *dir;
    int n = 0;

    snprintf(path, sizeof path, "/proc/self/%s", folder);
    dir = opendir(path);
    assert_non_null(dir);
    while (readdir(dir))
        n++;
    closedir(dir);
    return n;
}

int count_mappings(void)
{
    FILE *file = fopen("/proc/self/maps", "r");
    int n = 0, c;

    assert_non_null(file);
    while ((c = getc(file)) != EOF)
        n += c == '\n';
    fclose(file);
    return n;
}

struct refocus_source *started(const char *name, uint32_t flags)
{
    struct refocus_source_config config = refocus_source_config_default();
    struct refocus_reason reason = {""};
    struct refocus_source *source = NULL;
    int status = refocus_source_open(&source, name, &reason);

    if (status != REFOCUS_OK)
        fail_msg("%s: %d %s", name, status, reason.text);
    config.flags = flags;
    status = refocus_source_start(source, &config, NULL, &reason);
    if (status != REFOCUS_OK)
        fail_msg("%s: start: %d %s", name, status, reason.text);
    return source;
}
