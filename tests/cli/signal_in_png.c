/* signal_in_png.c: a library for LD_PRELOAD with which the tenth row of a PNG ends the process by
 * SIGTERM, and each row behind it takes a millisecond and adds a byte to the file "rows": how much
 * is written after a signal does not depend on how fast the machine is. */
#define _GNU_SOURCE

#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <stdatomic.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

typedef void write_row(void *png, const unsigned char *row);

void png_write_row(void *png, const unsigned char *row);

void png_write_row(void *png, const unsigned char *row)
{
    static atomic_int count;
    void *const found = dlsym(RTLD_NEXT, "png_write_row");
    write_row *real;
    const struct timespec pause = {0, 1000000};
    const int rows = ++count;

    if (rows == 10)
        kill(getpid(), SIGTERM);
    if (rows >= 10) {
        const int file = open("rows", O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);

        if (file >= 0 && write(file, ".", 1) == 1)
            nanosleep(&pause, NULL);
        close(file);
    }
    memcpy(&real, &found, sizeof real); /* ISO C converts no object's address to a function's */
    real(png, row);
}
