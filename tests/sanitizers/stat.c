/* stat.c: fstat64(), stat64() and lstat64() for programs under clang's memory sanitizer, whose run
 * time does not know that glibc 2.33 and later fill their structs in functions of these names.
 *
 * A library for LD_PRELOAD. Programs without the sanitizer, such as env, may meet it, too. */
#define _GNU_SOURCE
#include <fcntl.h>
#include <stddef.h>
#include <sys/stat.h>

__attribute__((weak)) void __msan_unpoison(const volatile void *memory, size_t size);

static int look(int folder, const char *path, struct stat64 *facts, int flags)
{
    const int status = fstatat64(folder, path, facts, flags);

    if (status == 0 && __msan_unpoison)
        __msan_unpoison(facts, sizeof *facts);
    return status;
}

int fstat64(int file, struct stat64 *facts)
{
    return look(file, "", facts, AT_EMPTY_PATH);
}

int stat64(const char *path, struct stat64 *facts)
{
    return look(AT_FDCWD, path, facts, 0);
}

int lstat64(const char *path, struct stat64 *facts)
{
    return look(AT_FDCWD, path, facts, AT_SYMLINK_NOFOLLOW);
}
