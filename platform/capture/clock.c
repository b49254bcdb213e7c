/* Waiting that another thread can end, and words for what went wrong. */
#define _GNU_SOURCE /* ppoll */
#include <errno.h>
#include <poll.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include "backend.h"

int64_t rf_now_ns(void)
{
    struct timespec now;

    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

int rf_source_poll(const struct refocus_source *source, int fd, short events, int64_t deadline_ns,
                   short *revents)
{
    struct pollfd fds[2] = {{.fd = source->wake_fd, .events = POLLIN},
                            {.fd = fd, .events = events}};

    for (;;) {
        int64_t left = deadline_ns - rf_now_ns();
        struct timespec timeout;
        int n;

        if (left < 0)
            left = 0;
        timeout.tv_sec = (time_t)(left / 1000000000);
        timeout.tv_nsec = (long)(left % 1000000000);
        n = ppoll(fds, fd >= 0 ? 2 : 1, &timeout, NULL);
        if (n < 0 && errno != EINTR)
            return REFOCUS_ERR_TIMEOUT;
        if (n > 0 && fds[0].revents)
            return REFOCUS_ERR_CANCELLED;
        if (n > 0 && fds[1].revents) {
            if (revents)
                *revents = fds[1].revents;
            return REFOCUS_OK;
        }
        if (n == 0 && left == 0)
            return REFOCUS_ERR_TIMEOUT;
    }
}

void rf_pace_start(struct rf_pace *pace, double fps, bool fast)
{
    pace->start_ns = fast ? 0 : rf_now_ns(); /* fast: the times of the stream itself */
    pace->period_ns = (int64_t)(1e9 / (fps > 0 ? fps : 30) + 0.5);
    pace->fast = fast;
}

int64_t rf_pace_due(const struct rf_pace *pace, int64_t frame)
{
    return pace->start_ns + frame * pace->period_ns;
}

int rf_capture_fail(struct refocus_reason *reason, int status, const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    vsnprintf(reason->text, sizeof reason->text, format, arguments);
    va_end(arguments);
    for (char *c = reason->text; *c; c++)
        if ((unsigned char)*c < 32 || *c == 127)
            *c = '?';
    return status;
}

int rf_capture_fail_memory(struct refocus_reason *reason)
{
    return rf_capture_fail(reason, REFOCUS_ERR_MEMORY,
                           "not enough memory; use a smaller size or fewer buffers");
}

int rf_capture_fail_errno(struct refocus_reason *reason, int error, const char *what)
{
    char words[128]; /* the GNU strerror_r may use it, and returns what to print */

    switch (error) {
    case ENOENT:
    case ENXIO:
    case ENODEV:
        return rf_capture_fail(reason, REFOCUS_ERR_GONE,
                               "%s: it is not there; plug it in or give another name", what);
    case EBUSY:
        return rf_capture_fail(reason, REFOCUS_ERR_BUSY,
                               "%s: used by another program; end that one first", what);
    case EACCES:
    case EPERM:
        return rf_capture_fail(reason, REFOCUS_ERR_PERMISSION,
                               "%s: access is refused; for a camera become a member of "
                               "the group 'video'",
                               what);
    case ENOMEM:
        return rf_capture_fail_memory(reason);
    case EPIPE:
        return rf_capture_fail(reason, REFOCUS_ERR_GONE,
                               "%s: the reader closed it; keep it open as long as "
                               "wanted",
                               what);
    default:
        return rf_capture_fail(reason, REFOCUS_ERR_IO, "%s: %s", what,
                               strerror_r(error, words, sizeof words));
    }
}
