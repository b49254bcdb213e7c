/* Commands on standard input, a line each. */
#include <errno.h>
#include <poll.h>
#include <string.h>
#include <unistd.h>
#include "live.h"

enum { LONGEST_LINE = 256 };

static void obey(struct live *live, char *line)
{
    char why[200] = "";
    bool quit = false;

    line[strcspn(line, "\r")] = '\0';
    live->commands++;
    if (!live_focus_command(&live->focus, line, &quit, why, sizeof why)) {
        live->commands_refused++;
        report_failure(EXIT_FAILED, line, "%s", why); /* says it, and goes on */
    }
    if (quit)
        live_end(live);
}

void *live_command_thread(void *argument)
{
    struct live *live = argument;
    char text[LONGEST_LINE];
    size_t n = 0;

    while (!live_is_over(live)) {
        struct pollfd fds[2] = {{.fd = live->wake_fd, .events = POLLIN},
                                {.fd = STDIN_FILENO, .events = POLLIN}};
        char *end;
        ssize_t got;

        if (poll(fds, 2, -1) < 0 && errno != EINTR)
            break;
        if (fds[0].revents)
            break;
        if (!fds[1].revents)
            continue;
        got = read(STDIN_FILENO, text + n, sizeof text - 1 - n);
        if (got <= 0)
            break;
        n += (size_t)got;
        text[n] = '\0';
        while ((end = strchr(text, '\n'))) {
            *end = '\0';
            obey(live, text);
            n -= (size_t)(end + 1 - text);
            memmove(text, end + 1, n + 1);
        }
        if (n == sizeof text - 1)
            n = 0; /* no line is that long */
    }
    return NULL;
}
