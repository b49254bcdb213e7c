/* backend.c: what all kinds of sources share: their rate, and a wait for a device that another
 * thread can end. */
#define _GNU_SOURCE /* ppoll */
#include "backend.h"
#include <errno.h>
#include <poll.h>
#include <time.h>

double rf_source_fps(const struct refocus_source *source, double own)
{
    const struct refocus_source_config *const config = &source->config;

    return config->fps > 0           ? config->fps
           : own > 0                 ? own
           : config->default_fps > 0 ? config->default_fps
                                     : 30;
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

int rf_source_sleep(const struct refocus_source *source, int64_t due, int64_t deadline_ns)
{
    int status;

    if (due <= rf_now_ns())
        return REFOCUS_OK;
    status = rf_source_poll(source, -1, 0, due < deadline_ns ? due : deadline_ns, NULL);
    return status == REFOCUS_ERR_TIMEOUT && due <= deadline_ns ? REFOCUS_OK : status;
}
