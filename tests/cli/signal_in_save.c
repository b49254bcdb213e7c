/* signal_in_save.c: a library for LD_PRELOAD in which a call of the work sends the signal
 * REFOCUS_SIGNAL to its process and does not return, as that of a library with a large picture or
 * of a slow disk: what the process does about it does not depend on how fast the machine is.
 * REFOCUS_STALL says which: "encode" (of a JPEG), "fsync" or "rename". */
#define _GNU_SOURCE

#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <unistd.h>

typedef int compress(void *jpeg, const unsigned char *pixels, int width, int pitch, int height,
                     int format, unsigned char **bytes, unsigned long *size, int sampling,
                     int quality, int flags);
compress tjCompress2;

static void stall_at(const char *call)
{
    const char *const at = getenv("REFOCUS_STALL"), *const number = getenv("REFOCUS_SIGNAL");

    if (!at || !number || strcmp(at, call) != 0)
        return;
    kill(getpid(), (int)strtol(number, NULL, 10));
    for (;;)
        pause();
}

int tjCompress2(void *jpeg, const unsigned char *pixels, int width, int pitch, int height,
                int format, unsigned char **bytes, unsigned long *size, int sampling, int quality,
                int flags)
{
    void *const found = dlsym(RTLD_NEXT, "tjCompress2");
    compress *real;

    stall_at("encode");
    memcpy(&real, &found, sizeof real); /* ISO C converts no object's address to a function's */
    return real(jpeg, pixels, width, pitch, height, format, bytes, size, sampling, quality, flags);
}

int fsync(int file)
{
    stall_at("fsync");
    return (int)syscall(SYS_fsync, file);
}

int rename(const char *from, const char *to)
{
    stall_at("rename");
    return (int)syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0);
}
