/* answer.c: answers with the headers that keep a page by itself. */
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "page_files.h"
#include "server.h"

void answer_text(struct request *request, char *text, size_t size, const char *type)
{
    request->status = MHD_HTTP_OK;
    request->text = text;
    request->size = size;
    snprintf(request->type, sizeof request->type, "%s", type);
}

static json_t *error_json(const char *why)
{
    json_t *object = json_pack("{s:s}", "error", why);
    char *plain;

    if (object || !(plain = strdup(why)))
        return object;
    /* Words of a file that are not UTF-8. */
    for (char *c = plain; *c; c++)
        if ((unsigned char)*c >= 128)
            *c = '?';
    object = json_pack("{s:s}", "error", plain);
    free(plain);
    return object;
}

void answer_error(struct request *request, int status, const char *why)
{
    json_t *const object = why ? error_json(why) : NULL;
    char *const text = object ? json_dumps(object, JSON_COMPACT) : NULL;

    free(request->text);
    answer_text(request, text, text ? strlen(text) : 0, "application/json");
    request->status = status;
    request->ending[0] = '\0';
    json_decref(object);
}

void answer_resume(struct server *server, struct request *request)
{
    /* Settled at once, it is no connection that waits. */
    if (!request->suspended)
        return;
    request->suspended = false;
    MHD_resume_connection(request->connection);
    server->resumed = true;
}

/* The name of a file for a header: what is not plain ASCII is written as %41. */
static void add_attachment(struct MHD_Response *response, const struct request *request)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.";
    const char *const dot = strrchr(request->name, '.');
    const size_t length = dot ? (size_t)(dot - request->name) : strlen(request->name);
    char value[64 + 3 * sizeof request->name] = "attachment; filename*=UTF-8''";
    size_t n = strlen(value);

    for (size_t i = 0; i < length; i++) {
        const unsigned char c = (unsigned char)request->name[i];

        n += (size_t)snprintf(value + n, sizeof value - n, strchr(plain, c) ? "%c" : "%%%02X", c);
    }
    snprintf(value + n, sizeof value - n, "-%s", request->ending);
    MHD_add_response_header(response, "Content-Disposition", value);
}

static void add_headers(struct MHD_Response *response, const struct request *request)
{
    static const char *const fixed[][2] = {
        {"Content-Security-Policy",
         "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; "
         "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
        {"X-Content-Type-Options", "nosniff"},
        {"Referrer-Policy", "no-referrer"},
        {"Cache-Control", "no-store"},
        {"Cross-Origin-Resource-Policy", "same-origin"},
        {"Cross-Origin-Opener-Policy", "same-origin"},
    };
    char frame[16];

    for (size_t i = 0; i < sizeof fixed / sizeof *fixed; i++)
        MHD_add_response_header(response, fixed[i][0], fixed[i][1]);
    if (request->type[0] && request->size > 0)
        MHD_add_response_header(response, "Content-Type", request->type);
    if (request->ending[0])
        add_attachment(response, request);
    if (request->action == ACTION_THUMBNAIL && request->depth >= 0)
        MHD_add_response_header(response, "Refocus-Depth", request->depth ? "yes" : "no");
    if (request->frame > 0) {
        snprintf(frame, sizeof frame, "%u", request->frame);
        MHD_add_response_header(response, "Refocus-Frame", frame);
    }
    if (request->status >= 400)
        MHD_add_response_header(response, "Connection", "close");
    if (request->status == MHD_HTTP_METHOD_NOT_ALLOWED)
        MHD_add_response_header(response, "Allow", "GET, HEAD, POST");
}

enum MHD_Result answer_queue(struct request *request)
{
    const bool file = request->file && request->status == MHD_HTTP_OK;
    void *const bytes = file ? (void *)request->file->bytes : request->text;
    struct MHD_Response *const response =
        MHD_create_response_from_buffer(request->size, bytes, MHD_RESPMEM_PERSISTENT);
    enum MHD_Result result;

    /* The bytes are the request's, until it is completed. */
    if (!response)
        return MHD_NO;
    add_headers(response, request);
    request->line->deadline_ms =
        server_now_ms() + 1e3 * SECONDS_ANSWER + 1e3 * (double)(request->size / (64 << 10));
    result = MHD_queue_response(request->connection, (unsigned)request->status, response);
    MHD_destroy_response(response);
    return result;
}
