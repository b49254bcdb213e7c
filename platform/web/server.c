/* server.c: one thread sees to all connections and processes. It is asleep while nothing comes. */
#include <arpa/inet.h>
#include <errno.h>
#include <math.h>
#include <netdb.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>
#include "check.h"
#include "server.h"

enum { TICK_MS = 250, MOST_FILES = 2 + MOST_SESSIONS + MOST_THUMBNAILS };

double server_now_ms(void)
{
    struct timespec now;

    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec / 1e6;
}

bool server_random(char digits[RF_WEB_SESSION + 1])
{
    unsigned char bytes[RF_WEB_SESSION / 2];

    if (getrandom(bytes, sizeof bytes, 0) != (ssize_t)sizeof bytes)
        return false;
    for (size_t i = 0; i < sizeof bytes; i++)
        snprintf(digits + 2 * i, 3, "%02x", bytes[i]);
    return true;
}

static void note_connection(void *of, struct MHD_Connection *connection, void **context,
                            enum MHD_ConnectionNotificationCode code)
{
    struct server *const server = of;
    const union MHD_ConnectionInfo *info;
    struct line *line = *context;

    if (code == MHD_CONNECTION_NOTIFY_STARTED) {
        info = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD);
        line = info ? calloc(1, sizeof *line) : NULL;
        if (!line)
            return;
        line->fd = info->connect_fd;
        line->deadline_ms = server_now_ms() + 1e3 * SECONDS_HEADERS;
        line->next = server->lines;
        server->lines = line;
        *context = line;
    } else if (line) {
        struct line **link = &server->lines;

        while (*link != line)
            link = &(*link)->next;
        *link = line->next;
        free(line);
        *context = NULL;
    }
}

/* End connections that are past their deadlines: the library then finds them closed. */
static void end_slow(const struct server *server)
{
    const double now = server_now_ms();

    for (struct line *line = server->lines; line; line = line->next)
        if (now > line->deadline_ms) {
            shutdown(line->fd, SHUT_RDWR);
            line->deadline_ms = INFINITY;
        }
}

static bool read_address(const char *text, int port, struct sockaddr_storage *address)
{
    struct sockaddr_in *const v4 = (struct sockaddr_in *)address;
    struct sockaddr_in6 *const v6 = (struct sockaddr_in6 *)address;

    memset(address, 0, sizeof *address);
    if (inet_pton(AF_INET, text, &v4->sin_addr) == 1) {
        v4->sin_family = AF_INET;
        v4->sin_port = htons((uint16_t)port);
        return true;
    }
    if (inet_pton(AF_INET6, text, &v6->sin6_addr) != 1)
        return false;
    v6->sin6_family = AF_INET6;
    v6->sin6_port = htons((uint16_t)port);
    return true;
}

static bool start(struct server *server, char *reason)
{
    const struct rf_web_setup *const setup = server->setup;
    const union MHD_DaemonInfo *info;
    struct sockaddr_storage address;
    unsigned flags = MHD_USE_EPOLL | MHD_ALLOW_SUSPEND_RESUME;

    if (!read_address(setup->address, setup->port, &address)) {
        snprintf(reason, 256, "%.100s is no address in numbers", setup->address);
        return false;
    }
    if (address.ss_family == AF_INET6)
        flags |= MHD_USE_IPv6;
    errno = 0;
    server->daemon = MHD_start_daemon(
        flags, 0, NULL, NULL, request_handle, server, MHD_OPTION_SOCK_ADDR,
        (struct sockaddr *)&address, MHD_OPTION_NOTIFY_COMPLETED, request_completed, server,
        MHD_OPTION_NOTIFY_CONNECTION, note_connection, server, MHD_OPTION_CONNECTION_LIMIT,
        (unsigned)MOST_CONNECTIONS, MHD_OPTION_PER_IP_CONNECTION_LIMIT,
        (unsigned)MOST_CONNECTIONS_EACH, MHD_OPTION_CONNECTION_MEMORY_LIMIT, (size_t)(32 << 10),
        MHD_OPTION_CONNECTION_TIMEOUT, (unsigned)SECONDS_IDLE, MHD_OPTION_STRICT_FOR_CLIENT, 1,
        MHD_OPTION_END);
    if (!server->daemon) {
        snprintf(reason, 256, "port %d of %.100s cannot be had: %s", setup->port, setup->address,
                 errno ? strerror(errno) : "not enough memory");
        return false;
    }
    info = MHD_get_daemon_info(server->daemon, MHD_DAEMON_INFO_BIND_PORT);
    server->port = info ? info->port : setup->port;
    return true;
}

/* The address by which others find a server that listens on all of this machine's: the one that
 * packets to elsewhere would have. None is sent. */
static void find_address(const char *elsewhere, char *text, size_t size)
{
    struct sockaddr_storage address;
    socklen_t length = sizeof address;
    int fd;

    read_address(elsewhere, 9, &address);
    fd = socket(address.ss_family, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (fd < 0)
        return;
    if (connect(fd, (struct sockaddr *)&address, length) == 0 &&
        getsockname(fd, (struct sockaddr *)&address, &length) == 0)
        getnameinfo((struct sockaddr *)&address, length, text, (socklen_t)size, NULL, 0,
                    NI_NUMERICHOST);
    close(fd);
}

static void tell_link(const struct server *server)
{
    const bool v6 = strchr(server->setup->address, ':') != NULL;
    char address[INET6_ADDRSTRLEN + 32], link[512];

    if (server->setup->origin) {
        snprintf(link, sizeof link, "%s/%s/", server->setup->origin, server->token);
        server->setup->ready(server->setup->of, link);
        return;
    }
    snprintf(address, sizeof address, "%s", server->setup->address);
    if (strcmp(address, "0.0.0.0") == 0)
        find_address("192.0.2.1", address, sizeof address);
    else if (strcmp(address, "::") == 0)
        find_address("2001:db8::1", address, sizeof address);

    snprintf(link, sizeof link, "http://%s%s%s:%d/%s/", v6 ? "[" : "", address, v6 ? "]" : "",
             server->port, server->token);
    server->setup->ready(server->setup->of, link);
}

/* See to connections until those that were resumed have been seen to, too. */
static void run_connections(struct server *server)
{
    do {
        server->resumed = false;
        MHD_run(server->daemon);
    } while (server->resumed);
}

/* Milliseconds to sleep at most; -1: until something comes. */
static int patience(struct server *server)
{
    const bool busy = server->lines || server->processes || server->thumbnails;
    MHD_UNSIGNED_LONG_LONG timeout;
    int most = busy ? TICK_MS : -1;

    if (MHD_get_timeout(server->daemon, &timeout) == MHD_YES && (most < 0 || timeout < TICK_MS))
        most = timeout < TICK_MS ? (int)timeout : TICK_MS;
    return server->thumbnails ? (most > 20 ? 20 : most) : most;
}

static void serve(struct server *server)
{
    const union MHD_DaemonInfo *const info =
        MHD_get_daemon_info(server->daemon, MHD_DAEMON_INFO_EPOLL_FD);
    struct pollfd files[MOST_FILES];
    struct process *of[MOST_FILES];

    for (;;) {
        nfds_t count = 2;

        files[0] = (struct pollfd){.fd = info->epoll_fd, .events = POLLIN};
        files[1] = (struct pollfd){.fd = server->setup->signals, .events = POLLIN};
        for (struct process *p = server->processes; p && count < MOST_FILES; p = p->next) {
            of[count] = p;
            files[count++] = (struct pollfd){.fd = p->socket, .events = POLLIN};
        }
        if (poll(files, count, patience(server)) < 0 && errno != EINTR)
            return;
        if (files[1].revents)
            return;
        for (nfds_t i = 2; i < count; i++)
            if (files[i].revents)
                process_read(server, of[i]); /* ends no other one */
        run_connections(server);
        process_tick(server);
        end_slow(server);
        run_connections(server);
    }
}

/* No connection may wait when the library ends. */
static void end(struct server *server)
{
    while (server->processes)
        process_end(server, server->processes, MHD_HTTP_SERVICE_UNAVAILABLE,
                    "the server has ended");
    while (server->thumbnails) {
        struct request *const request = server->thumbnails;

        server->thumbnails = request->next;
        answer_error(request, MHD_HTTP_SERVICE_UNAVAILABLE, "the server has ended");
        answer_resume(server, request);
    }
    run_connections(server);
    MHD_stop_daemon(server->daemon);
}

int rf_web_run(const struct rf_web_setup *setup, char *reason)
{
    struct server server = {.setup = setup};
    int result = -1;

    if (setup->origin && !rf_check_public(setup->origin)) {
        snprintf(reason, 256, "%.100s is no origin such as https://photos.example.org",
                 setup->origin);
        return -1;
    }
    if (!folder_open(&server.folder, setup->path, reason))
        return -1;
    if (!server_random(server.token)) {
        snprintf(reason, 256, "this system has no random numbers");
    } else if (start(&server, reason)) {
        tell_link(&server);
        serve(&server);
        end(&server);
        result = 0;
    }
    folder_close(&server.folder);
    return result;
}
