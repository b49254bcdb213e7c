/* process.c: the processes that work for a session, or on a thumbnail: asked, read and ended. One
 * that is busy, hangs or dies of a damaged photo is felt by its own session alone. */
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>
#include "server.h"

enum { LOOK_MS = 100 }; /* time between two looks at the memory of processes */

static const char no_memory[] = "not enough memory; close other photos";

static void settle(struct server *server, struct request *request, int status, const char *why)
{
    answer_error(request, status, why);
    answer_resume(server, request);
}

void process_end(struct server *server, struct process *process, int status, const char *why)
{
    struct process **link = &server->processes;

    while (*link != process)
        link = &(*link)->next;
    *link = process->next;
    kill(process->pid, SIGKILL);
    while (waitpid(process->pid, NULL, 0) < 0 && errno == EINTR)
        ;
    close(process->socket);
    close(process->control);
    process_remove_folder(process);
    if (process->running)
        settle(server, process->running, status, why);
    while (process->waiting) {
        struct request *const request = process->waiting;

        process->waiting = request->next;
        settle(server, request, status, why);
    }
    server->held -= process->held;
    free(process->body);
    free(process);
}

static bool send_all(int fd, const void *bytes, size_t size)
{
    const char *at = bytes;

    while (size > 0) {
        const ssize_t sent = send(fd, at, size, MSG_NOSIGNAL);

        if (sent < 0 && errno == EINTR)
            continue;
        if (sent <= 0)
            return false;
        at += sent;
        size -= (size_t)sent;
    }
    return true;
}

/* Hand over the next request, if the process is free and there is one. */
static void go_on(struct server *server, struct process *process)
{
    struct request *const request = process->waiting;

    if (process->running || !request)
        return;
    process->waiting = request->next;
    process->waiting_count--;
    request->next = NULL;
    process->running = request;
    request->ask.number = ++process->number;
    process->used_ms = server_now_ms();
    process->until_ms = process->used_ms + 1e3 * SECONDS_WORK;
    if (!send_all(process->socket, &request->ask, sizeof request->ask) ||
        !send_all(process->socket, request->body, request->ask.bytes))
        process_end(server, process, MHD_HTTP_BAD_GATEWAY,
                    "its process has failed; open the photo again");
}

static void queue(struct process *process, struct request *request)
{
    struct request **link = &process->waiting;

    while (*link)
        link = &(*link)->next;
    *link = request;
    request->next = NULL;
    process->waiting_count++;
}

/* Pictures that something newer makes out of date. */
static void replace_pictures(struct server *server, struct process *process)
{
    struct request **link = &process->waiting;

    while (*link) {
        struct request *const request = *link;

        if (request->ask.what == RF_WEB_PICTURE) {
            *link = request->next;
            process->waiting_count--;
            settle(server, request, MHD_HTTP_CONFLICT, "a newer request has replaced it");
        } else {
            link = &request->next;
        }
    }
    if (process->running && process->running->ask.what == RF_WEB_PICTURE)
        send_all(process->control, &process->number, sizeof process->number);
}

static bool replaces_pictures(uint32_t what)
{
    return what == RF_WEB_PICTURE || what == RF_WEB_FOCUS || what == RF_WEB_DRAFT ||
           what == RF_WEB_STROKE || what == RF_WEB_UNDO || what == RF_WEB_REDO;
}

/* Hand a request to its process, when that is free. */
static void process_queue(struct server *server, struct request *request)
{
    struct process *const process = request->process;

    if (process->waiting_count >= MOST_WAITING) {
        answer_error(request, MHD_HTTP_SERVICE_UNAVAILABLE, "too much is asked at once");
        return;
    }
    queue(process, request);
    go_on(server, process);
}

void process_ask(struct server *server, struct request *request)
{
    struct process *const process = request->process;

    if (!process->open) {
        answer_error(request, MHD_HTTP_CONFLICT, "the photo is still being opened");
        return;
    }
    if (replaces_pictures(request->ask.what))
        replace_pictures(server, process);
    process_queue(server, request);
}

struct process *process_find(const struct server *server, const char *id)
{
    struct process *process = server->processes;

    while (process && !(process->session && strcmp(process->id, id) == 0))
        process = process->next;
    return process;
}

static int count(const struct server *server, bool sessions)
{
    int found = 0;

    for (const struct process *p = server->processes; p; p = p->next)
        found += p->session == sessions;
    return found;
}

/* The session that nobody has asked for longest, but for `keep`; NULL: all are at work. */
static struct process *idle(const struct server *server, const struct process *keep)
{
    struct process *oldest = NULL;

    for (struct process *p = server->processes; p; p = p->next)
        if (p->session && !p->running && p != keep && (!oldest || p->used_ms < oldest->used_ms))
            oldest = p;
    return oldest;
}

void process_open(struct server *server, struct request *request, int fd)
{
    if (count(server, true) >= MOST_SESSIONS && idle(server, NULL))
        process_end(server, idle(server, NULL), MHD_HTTP_GONE, "this session has ended");
    if (count(server, true) >= MOST_SESSIONS) {
        close(fd);
        answer_error(request, MHD_HTTP_SERVICE_UNAVAILABLE, "too many photos are open");
        return;
    }
    request->ask.what = RF_WEB_OPEN;
    request->ask.bytes = 0;
    request->process = process_start(server, request->name, true, fd);
    if (!request->process) {
        answer_error(request, MHD_HTTP_SERVICE_UNAVAILABLE, no_memory);
        return;
    }
    queue(request->process, request);
    go_on(server, request->process);
}

void process_live(struct server *server, struct request *request)
{
    struct process *process = server->processes;

    while (process && !process->live)
        process = process->next;
    if (!process)
        process = process_start(server, "live", true, -1);
    if (!process) {
        answer_error(request, MHD_HTTP_SERVICE_UNAVAILABLE, no_memory);
        return;
    }
    request->ask.what = RF_WEB_OPEN;
    request->ask.bytes = 0;
    request->process = process;
    process_queue(server, request);
}

/* Make thumbnails that wait for a process. */
static void begin_thumbnails(struct server *server)
{
    while (server->thumbnails && count(server, false) < MOST_THUMBNAILS) {
        struct request *const request = server->thumbnails;
        const int fd = folder_photo_open(&server->folder, request->name);

        server->thumbnails = request->next;
        server->thumbnail_count--;
        request->process = fd >= 0 ? process_start(server, request->name, false, fd) : NULL;
        if (request->process) {
            queue(request->process, request);
            go_on(server, request->process);
        } else if (fd < 0) {
            settle(server, request, MHD_HTTP_NOT_FOUND, "there is no such photo");
        } else {
            settle(server, request, MHD_HTTP_SERVICE_UNAVAILABLE, no_memory);
        }
    }
}

void process_thumbnail(struct server *server, struct request *request)
{
    struct request **link = &server->thumbnails;

    if (server->thumbnail_count >= MOST_THUMBNAILS_WAITING) {
        answer_error(request, MHD_HTTP_SERVICE_UNAVAILABLE, "too much is asked at once");
        return;
    }
    while (*link)
        link = &(*link)->next;
    *link = request;
    request->next = NULL;
    server->thumbnail_count++; /* the next process_tick() begins it */
}

/* The whole reply is here. */
static void finish(struct server *server, struct process *process)
{
    struct request *const request = process->running;
    struct rf_web_reply *const reply = &process->reply;

    process->running = NULL;
    process->have = 0;
    process->used_ms = server_now_ms();
    reply->type[sizeof reply->type - 1] = reply->ending[sizeof reply->ending - 1] = '\0';
    request->depth = reply->depth > 0 ? 1 : reply->depth < 0 ? -1 : 0;
    request->frame = reply->frame;
    if (reply->depth >= 0 && request->action != ACTION_UPLOAD && !process->live)
        folder_note_depth(&server->folder, process->name, request->depth);
    if (reply->status == MHD_HTTP_OK) {
        answer_text(request, process->body, (size_t)reply->bytes, reply->type);
        request->held = process->held;
        process->held = 0;
        snprintf(request->ending, sizeof request->ending, "%s", reply->ending);
    } else {
        process->body[reply->bytes] = '\0';
        answer_error(request, reply->status >= 400 && reply->status < 600 ? reply->status : 500,
                     process->body);
        free(process->body);
        server->held -= process->held;
        process->held = 0;
    }
    process->body = NULL;
    process->open = process->open || reply->status == MHD_HTTP_OK;
    answer_resume(server, request);
    if (!process->session || !process->open)
        process_end(server, process, 0, NULL);
    else
        go_on(server, process);
}

/* The request may make the next process fail, too: it is told apart from the end of a session. */
static void fail(struct server *server, struct process *process)
{
    const bool opens = process->running && process->running->ask.what == RF_WEB_OPEN;

    process_end(server, process,
                !process->session || opens ? MHD_HTTP_UNPROCESSABLE_CONTENT : MHD_HTTP_BAD_GATEWAY,
                "its process has failed, perhaps for want of memory; open the photo again");
}

/* Room for the body of a reply, whose head is here. */
static bool begin_body(struct server *server, struct process *process)
{
    const uint64_t bytes = process->reply.bytes, most = (uint64_t)MOST_HELD << 20;

    if (bytes > most || server->held > most - bytes || bytes > SIZE_MAX - 1)
        return false;
    process->body = malloc((size_t)bytes + 1);
    if (!process->body)
        return false;
    process->held = bytes;
    server->held += bytes;
    return true;
}

void process_read(struct server *server, struct process *process)
{
    const size_t head = sizeof process->reply;

    for (;;) {
        char *const to = process->have < head ? (char *)&process->reply + process->have
                                              : process->body + (process->have - head);
        const size_t room = process->have < head
                                ? head - process->have
                                : (size_t)process->reply.bytes - (process->have - head);
        const ssize_t got = recv(process->socket, to, room, MSG_DONTWAIT);

        if (got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR))
            return;
        /* Nobody has asked it, or it has gone. */
        if (got <= 0 || !process->running) {
            fail(server, process);
            return;
        }
        process->have += (size_t)got;
        if (process->have == head && !begin_body(server, process)) {
            process_end(server, process, MHD_HTTP_SERVICE_UNAVAILABLE, no_memory);
            return;
        }
        if (process->have >= head && process->have - head == process->reply.bytes) {
            finish(server, process);
            return;
        }
    }
}

/* Memory that a process holds. */
static int64_t held_kib(pid_t pid)
{
    char path[40];
    long pages = 0, all;
    FILE *file;

    snprintf(path, sizeof path, "/proc/%ld/statm", (long)pid);
    file = fopen(path, "r");
    if (!file || fscanf(file, "%ld %ld", &all, &pages) != 2)
        pages = 0;
    if (file)
        fclose(file);
    return (int64_t)pages * (sysconf(_SC_PAGESIZE) / 1024);
}

/* Drop sessions while they hold more than they may together: idle ones first, else the largest. */
static void trim(struct server *server)
{
    for (;;) {
        struct process *largest = NULL, *victim;
        int64_t all = 0;

        for (struct process *p = server->processes; p; p = p->next) {
            p->kib = held_kib(p->pid);
            all += p->kib;
            if (!largest || p->kib > largest->kib)
                largest = p;
        }
        if (!largest || (uint64_t)all <= server->setup->most_memory / 1024)
            return;
        victim = idle(server, NULL);
        if (!victim)
            victim = largest;
        process_end(server, victim, MHD_HTTP_SERVICE_UNAVAILABLE,
                    "it needs more memory than this server may take");
    }
}

void process_tick(struct server *server)
{
    const double now = server_now_ms();
    struct process *next;

    for (struct process *p = server->processes; p; p = next) {
        next = p->next;
        if (p->running && now > p->until_ms)
            process_end(server, p, MHD_HTTP_SERVICE_UNAVAILABLE, "it takes too long");
        else if (!p->running && now > p->used_ms + 1e3 * (p->live ? SECONDS_LIVE : SECONDS_SESSION))
            process_end(server, p, MHD_HTTP_GONE, "this session has ended");
    }
    if (now > server->looked_ms + LOOK_MS) {
        server->looked_ms = now;
        trim(server);
    }
    begin_thumbnails(server);
}
