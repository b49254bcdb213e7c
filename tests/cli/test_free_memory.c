/* test_free_memory.c: how much memory is free by what Linux tells of the machine and of the
 * process's group of control, in files that are made up here. */
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>
#include "unit_test.h"
#include "line/memory.h"

/* The files of the present test; what is not among them is not there. */
static const struct made_up {
    const char *path, *text;
} * made_up;

FILE *__wrap_fopen64(const char *path, const char *mode);
FILE *__wrap_fopen64(const char *path, const char *mode)
{
    for (const struct made_up *m = made_up; m->path; m++)
        if (strcmp(m->path, path) == 0)
            return fmemopen((void *)(uintptr_t)m->text, strlen(m->text), mode);
    return NULL;
}

static int64_t kib_of(const struct made_up *files)
{
    made_up = files;
    return memory_free_kib();
}

#define MACHINE                                                                                    \
    {                                                                                              \
        "/proc/meminfo", "MemTotal:  8000000 kB\nMemFree: 100000 kB\nMemAvailable:   3000000 kB\n" \
    }

TEST(machine)
{
    static const struct made_up plain[] = {MACHINE, {0}};
    static const struct made_up old[] = {{"/proc/meminfo", "MemTotal:  8000000 kB\n"}, {0}};
    static const struct made_up nothing[] = {{0}};
    const int64_t half = sysconf(_SC_PHYS_PAGES) * (int64_t)(sysconf(_SC_PAGESIZE) / 1024) / 2;

    assert_int_equal(kib_of(plain), 3000000);
    assert_int_equal(kib_of(old), half);
    assert_int_equal(kib_of(nothing), half);
}

TEST(groups)
{
    static const struct made_up root[] = {
        MACHINE,
        {"/proc/self/cgroup", "0::/\n"},
        {"/sys/fs/cgroup/memory.max", "1048576000\n"},
        {0},
    };
    static const struct made_up inner[] = {
        MACHINE,
        {"/proc/self/cgroup", "1:name=systemd:/old\n0::/outer/inner\n"},
        {"/sys/fs/cgroup/outer/inner/memory.max", "2048000000\n"},
        {"/sys/fs/cgroup/outer/memory.max", "512000000\n"},
        {0},
    };
    static const struct made_up boundless[] = {
        MACHINE,
        {"/proc/self/cgroup", "0::/outer\n"},
        {"/sys/fs/cgroup/outer/memory.max", "max\n"},
        {0},
    };
    static const struct made_up more_than_is_free[] = {
        MACHINE,
        {"/proc/self/cgroup", "0::/outer\n"},
        {"/sys/fs/cgroup/outer/memory.max", "4096000000\n"},
        {0},
    };

    assert_int_equal(kib_of(root), 1024000);
    assert_int_equal(kib_of(inner), 500000);
    assert_int_equal(kib_of(boundless), 3000000);
    assert_int_equal(kib_of(more_than_is_free), 3000000);
}
