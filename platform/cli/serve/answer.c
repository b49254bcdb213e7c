/* answer.c: replies of a process to the server. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>
#include "serve/serving.h"

static int depth_told = -1;
static uint32_t frame_told;

void answer_frame(uint32_t number)
{
    frame_told = number;
}

void answer_depth(int depth)
{
    depth_told = depth;
}

/* The server is gone when it takes nothing. */
static void send_all(int socket, const void *bytes, size_t size)
{
    const char *at = bytes;

    while (size > 0) {
        const ssize_t sent = send(socket, at, size, MSG_NOSIGNAL);

        if (sent < 0 && errno == EINTR)
            continue;
        if (sent <= 0)
            _exit(EXIT_FAILED);
        at += sent;
        size -= (size_t)sent;
    }
}

static void send_reply(const struct serving *s, int status, const char *type, const char *ending,
                       const void *bytes, size_t size)
{
    struct rf_web_reply reply = {
        .status = status, .depth = depth_told, .frame = frame_told, .bytes = size};

    snprintf(reply.type, sizeof reply.type, "%s", type);
    snprintf(reply.ending, sizeof reply.ending, "%s", ending);
    depth_told = -1;
    frame_told = 0;
    send_all(s->work->socket, &reply, sizeof reply);
    send_all(s->work->socket, bytes, size);
}

void answer_bytes(struct serving *s, const char *type, const char *ending, void *bytes, size_t size)
{
    send_reply(s, ANSWER_DONE, type, ending, bytes, size);
    free(bytes);
}

void answer_json(struct serving *s, json_t *object)
{
    char *const text = object ? json_dumps(object, JSON_COMPACT | JSON_REAL_PRECISION(9)) : NULL;

    json_decref(object);
    if (text) {
        answer_bytes(s, "application/json", "", text, strlen(text));
    } else {
        report_failure(EXIT_FAILED, s->work->name, "not enough memory");
        answer_failure(s, ANSWER_FAILED);
    }
}

/* Add that many bytes of a text, as far as they fit. */
static void append(char *text, size_t size, const char *part, size_t length)
{
    const size_t used = strlen(text);

    snprintf(text + used, size - used, "%.*s", (int)length, part);
}

/* Failures name the path that the photo is opened by; people know its name. */
void answer_failure(struct serving *s, int status)
{
    const char *const path = s->work->photo ? s->work->photo : s->work->name;
    const char *at = s->why, *found;
    char text[2048] = "";

    while ((found = strstr(at, path)) != NULL) {
        append(text, sizeof text, at, (size_t)(found - at));
        append(text, sizeof text, s->work->name, strlen(s->work->name));
        at = found + strlen(path);
    }
    append(text, sizeof text, at, strlen(at));
    send_reply(s, status, "", "", text, strlen(text));
    s->why[0] = '\0';
}
