/* memory.c: how much memory there is for this command. */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "line/memory.h"

/* The number behind the name that a line of the file begins with; false: there is none. */
static bool read_number(const char *path, const char *name, int64_t *number)
{
    FILE *file = fopen(path, "re");
    const size_t length = strlen(name);
    char line[128], *end = line;

    while (file && end == line && fgets(line, sizeof line, file))
        if (strncmp(line, name, length) == 0) {
            *number = strtoll(line + length, &end, 10);
            end = end == line + length ? line : end;
        }
    if (file)
        fclose(file);
    return end != line;
}

/* The least limit of the process's group and of those that it is in. */
static int64_t least_limit_kib(int64_t kib)
{
    char group[512] = "", path[640];
    FILE *file = fopen("/proc/self/cgroup", "re");
    char *slash;
    int64_t bytes;

    while (file && strncmp(group, "0::/", 4) != 0)
        if (!fgets(group, sizeof group, file))
            break;
    if (file)
        fclose(file);
    if (strncmp(group, "0::/", 4) != 0)
        return kib;
    group[strcspn(group, "\n")] = '\0';
    do {
        snprintf(path, sizeof path, "/sys/fs/cgroup%s/memory.max", group + 3);
        if (read_number(path, "", &bytes) && bytes / 1024 < kib)
            kib = bytes / 1024;
        slash = strrchr(group, '/');
        if (slash)
            *slash = '\0';
    } while (slash);
    return kib;
}

int64_t memory_free_kib(void)
{
    int64_t kib;

    if (!read_number("/proc/meminfo", "MemAvailable:", &kib))
        kib = (int64_t)sysconf(_SC_PHYS_PAGES) * (sysconf(_SC_PAGESIZE) / 1024) / 2;
    return least_limit_kib(kib);
}
