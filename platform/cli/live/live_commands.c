/* live_commands.c: commands, a line each, are taken from standard input and from a socket that
 * programs connect to. */
#include <errno.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>
#include "line/interrupt.h"
#include "line/report.h"
#include "live/live_commands.h"
#include "live/live_lines.h"
#include "live/live_stack.h"

enum { MOST_CLIENTS = 8, WAKE = 0, LISTENER, FIRST, MOST_FDS = FIRST + 1 + MOST_CLIENTS };

/* Someone who gives commands: standard input, or one end of a connection. */
struct client {
    struct live *live;
    int fd; /* -1: nobody */
    bool is_socket;
    struct live_lines lines;
};

static void answer(const struct client *client, const char *text)
{
    /* A program that does not read answers does without them. */
    if (client->is_socket && send(client->fd, text, strlen(text), MSG_DONTWAIT | MSG_NOSIGNAL) < 0)
        return;
}

static void obey(void *user, char *line)
{
    struct client *client = user;
    struct live *live = client->live;
    char why[200] = "", reply[256];
    bool quit = false;

    live->commands++;
    if (strcmp(line, "stack") == 0
            ? live_stack_ask(live, why, sizeof why)
            : live_focus_command(&live->focus, line, &quit, why, sizeof why)) {
        answer(client, "ok\n");
    } else {
        live->commands_refused++;
        snprintf(reply, sizeof reply, "refused: %s\n", why);
        answer(client, reply);
        if (!client->is_socket)
            report_failure(EXIT_FAILED, line, "%s", why); /* printed, and live goes on */
    }
    if (quit)
        live_stop(live);
}

/* False when no more will come. */
static bool read_commands(struct client *client)
{
    char bytes[512];
    const ssize_t got = read(client->fd, bytes, sizeof bytes);

    if (got < 0)
        return errno == EINTR || errno == EAGAIN;
    live_lines_take(&client->lines, bytes, (size_t)got, obey, client);
    return got > 0;
}

enum { FIRST_MS = 250, FIRST_READS = 4096 };

/* Reads at the beginning what stands on standard input: a file whole, and of a pipe what whoever
 * fills it has written, for which it is given a moment. Nothing is read from a terminal. */
static void read_waiting(struct client *client)
{
    struct pollfd fd = {.fd = client->fd, .events = POLLIN};

    if (client->fd < 0 || isatty(client->fd))
        return;
    for (int i = 0; i < FIRST_READS && poll(&fd, 1, i == 0 ? FIRST_MS : 0) > 0; i++)
        if (!read_commands(client)) {
            client->fd = -1;
            break;
        }
}

/* A connection becomes a client, where there is room for one. */
static void welcome(struct live *live, struct client *clients)
{
    const int fd = accept(live->command_fd, NULL, NULL);

    if (fd < 0)
        return;
    for (int i = 1; i <= MOST_CLIENTS; i++)
        if (clients[i].fd < 0) {
            clients[i] = (struct client){.live = live, .fd = fd, .is_socket = true};
            return;
        }
    answer(&(struct client){.fd = fd, .is_socket = true},
           "refused: too many programs are connected; close one\n");
    close(fd);
}

void *live_command_thread(void *argument)
{
    struct live *live = argument;
    struct client clients[1 + MOST_CLIENTS];

    for (int i = 0; i <= MOST_CLIENTS; i++)
        clients[i] = (struct client){.live = live, .fd = -1};
    if (!live->settings->no_commands)
        clients[0].fd = STDIN_FILENO;
    if (live->settings->offline)
        read_waiting(&clients[0]);
    sem_post(&live->first_commands);
    while (!live_is_over(live) && (clients[0].fd >= 0 || live->command_fd >= 0)) {
        struct pollfd fds[MOST_FDS] = {[WAKE] = {.fd = live->wake_fd, .events = POLLIN},
                                       [LISTENER] = {.fd = live->command_fd, .events = POLLIN}};

        for (int i = 0; i <= MOST_CLIENTS; i++) /* poll() leaves out what is -1 */
            fds[FIRST + i] = (struct pollfd){.fd = clients[i].fd, .events = POLLIN};
        if ((poll(fds, MOST_FDS, -1) < 0 && errno != EINTR) || fds[WAKE].revents)
            break;
        for (int i = 0; i <= MOST_CLIENTS; i++)
            if (clients[i].fd >= 0 && fds[FIRST + i].revents && !read_commands(&clients[i])) {
                if (clients[i].is_socket)
                    close(clients[i].fd);
                clients[i].fd = -1;
            }
        if (fds[LISTENER].revents)
            welcome(live, clients);
    }
    for (int i = 1; i <= MOST_CLIENTS; i++)
        if (clients[i].fd >= 0)
            close(clients[i].fd);
    return NULL;
}

/* A socket that nobody listens to any more was left by a program that was killed. */
static bool is_left_over(const struct sockaddr_un *address)
{
    struct stat file;
    const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    bool dead = false;

    if (fd >= 0 && lstat(address->sun_path, &file) == 0 && S_ISSOCK(file.st_mode))
        dead = connect(fd, (const struct sockaddr *)address, sizeof *address) != 0 &&
               errno == ECONNREFUSED;
    if (fd >= 0)
        close(fd);
    return dead;
}

static void remove_socket(void *live)
{
    unlink(((struct live *)live)->settings->socket);
}

int live_commands_open(struct live *live)
{
    const char *path = live->settings->socket;
    struct sockaddr_un address = {.sun_family = AF_UNIX};
    mode_t before;
    int error;

    if (!path)
        return EXIT_DONE;
    if (!*path || strlen(path) >= sizeof address.sun_path)
        return report_failure(EXIT_WRONG, "--socket", "give a name of 1 to %zu bytes",
                              sizeof address.sun_path - 1);
    memcpy(address.sun_path, path, strlen(path) + 1);
    live->command_fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (live->command_fd < 0)
        return report_failure(EXIT_FAILED, path, "%s", strerror(errno));
    if (is_left_over(&address))
        unlink(path);
    before = umask(0077); /* the socket is for this user alone; no other thread runs yet */
    error =
        bind(live->command_fd, (const struct sockaddr *)&address, sizeof address) != 0 ? errno : 0;
    umask(before);
    live->socket_is_ours = error == 0;
    if (live->socket_is_ours)
        interrupt_clean_up(remove_socket, live);
    if (error == 0 && listen(live->command_fd, MOST_CLIENTS) != 0)
        error = errno;
    if (error == EADDRINUSE)
        return report_failure(EXIT_FAILED, path,
                              "it is there already; end the program that "
                              "listens to it, or give another name");
    return error ? report_failure(EXIT_FAILED, path, "%s", strerror(error)) : EXIT_DONE;
}

void live_commands_close(struct live *live)
{
    interrupt_clean_up(NULL, NULL);
    if (live->socket_is_ours)
        remove_socket(live);
    if (live->command_fd >= 0)
        close(live->command_fd);
}
