/* spool.c: a picture that is rendered in strips is written to a temporary file, strip by strip, and
 * read when photo and disparities have been given back. */
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "line/report.h"
#include "shot/spool.h"

static const char *folder_of_spool(void)
{
    const char *folder = getenv("TMPDIR");

    return folder && *folder ? folder : "/var/tmp"; /* /tmp is often memory itself */
}

int spool_open(void)
{
    char name[4096];
    int file;

    if (snprintf(name, sizeof name, "%s/refocus-XXXXXX", folder_of_spool()) >= (int)sizeof name)
        return -1;
    file = mkstemp(name);
    if (file >= 0) {
        unlink(name);
        fcntl(file, F_SETFD, FD_CLOEXEC);
    }
    return file;
}

/* Writes a picture behind what the file holds, or reads one from its beginning. */
static bool transfer(int file, const struct refocus_image *picture, bool writes)
{
    const size_t size = (size_t)picture->stride[0] * (size_t)picture->height;
    size_t done = 0;

    errno = 0;
    while (done < size) {
        uint8_t *const at = picture->plane[0] + done;
        const ssize_t n =
            writes ? write(file, at, size - done) : pread(file, at, size - done, (off_t)done);

        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0)
            return false;
        done += (size_t)n;
    }
    return true;
}

int spool_put(int file, const char *photo, int height, const struct refocus_image *rows)
{
    if (transfer(file, rows, true))
        return EXIT_DONE;
    return report_failure(EXIT_FAILED, photo,
                          "its rows cannot wait in a file in '%s': %s; make room there, or set "
                          "TMPDIR to a folder with room for %.0f MB",
                          folder_of_spool(), strerror(errno ? errno : ENOSPC),
                          ceil((double)rows->stride[0] * height / 1e6));
}

int spool_get(int file, const char *photo, const struct refocus_image *picture)
{
    if (transfer(file, picture, false))
        return EXIT_DONE;
    return report_failure(EXIT_FAILED, photo,
                          "its rows cannot be read back from a file in '%s': %s; set TMPDIR to "
                          "another folder",
                          folder_of_spool(), strerror(errno ? errno : EIO));
}
