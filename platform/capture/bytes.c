/* bytes.c: a file or pipe is read in a way that another thread can end. */
#include "bytes.h"
#include <errno.h>
#include <poll.h>
#include <string.h>
#include <unistd.h>

int rf_read_bytes(const struct refocus_source *source, int fd, void *bytes, size_t size,
                  size_t *got, struct refocus_reason *reason)
{
    for (*got = 0; *got < size;) {
        const int status = rf_source_poll(source, fd, POLLIN, INT64_MAX, NULL);
        ssize_t n;

        if (status != REFOCUS_OK)
            return rf_capture_fail(reason, status, "interrupted");
        n = read(fd, (uint8_t *)bytes + *got, size - *got);
        if (n == 0)
            break;
        if (n < 0 && errno != EINTR && errno != EAGAIN)
            return rf_capture_fail_errno(reason, errno, source->name);
        *got += n > 0 ? (size_t)n : 0;
    }
    return REFOCUS_OK;
}

/* A line of a file, in one go: what was read beyond it is read again. */
static int read_line_at(const struct refocus_source *source, int fd, off_t at, char *line,
                        size_t size, struct refocus_reason *reason)
{
    size_t got;
    char *end;
    const int status = rf_read_bytes(source, fd, line, size - 1, &got, reason);

    if (status != REFOCUS_OK)
        return status;
    end = got > 0 ? memchr(line, '\n', got) : NULL;
    if (!end)
        return got == 0 ? REFOCUS_ERR_END : REFOCUS_ERR_FORMAT;
    *end = '\0';
    return lseek(fd, at + (end - line) + 1, SEEK_SET) >= 0
               ? REFOCUS_OK
               : rf_capture_fail_errno(reason, errno, source->name);
}

int rf_read_line(const struct refocus_source *source, int fd, char *line, size_t size,
                 struct refocus_reason *reason)
{
    const off_t at = lseek(fd, 0, SEEK_CUR);

    if (at >= 0)
        return read_line_at(source, fd, at, line, size, reason);
    for (size_t n = 0; n + 1 < size; n++) { /* the pipe keeps what is beyond it */
        size_t got;
        const int status = rf_read_bytes(source, fd, line + n, 1, &got, reason);

        if (status != REFOCUS_OK)
            return status;
        if (got == 0)
            return n == 0 ? REFOCUS_ERR_END : REFOCUS_ERR_FORMAT;
        if (line[n] == '\n') {
            line[n] = '\0';
            return REFOCUS_OK;
        }
    }
    return REFOCUS_ERR_FORMAT;
}
