/* request.c: requests are checked and sent on their ways. */
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "check.h"
#include "page_files.h"
#include "server.h"
#include "upload.h"

/* An endpoint. */
static const struct way {
    const char *name, *method;
    int action;
    enum rf_web_what what;
} ways[] = {
    {"photos", "GET", ACTION_PHOTOS, RF_WEB_NOTHING},
    {"thumbnail", "GET", ACTION_THUMBNAIL, RF_WEB_THUMBNAIL},
    {"open", "POST", ACTION_OPEN, RF_WEB_OPEN},
    {"live", "POST", ACTION_LIVE, RF_WEB_OPEN},
    {"frame", "POST", ACTION_ASK, RF_WEB_FRAME},
    {"upload", "POST", ACTION_UPLOAD, RF_WEB_OPEN},
    {"focus", "POST", ACTION_ASK, RF_WEB_FOCUS},
    {"picture", "POST", ACTION_ASK, RF_WEB_PICTURE},
    {"overlay", "POST", ACTION_ASK, RF_WEB_OVERLAY},
    {"draft", "POST", ACTION_ASK, RF_WEB_DRAFT},
    {"stroke", "POST", ACTION_ASK, RF_WEB_STROKE},
    {"undo", "POST", ACTION_ASK, RF_WEB_UNDO},
    {"redo", "POST", ACTION_ASK, RF_WEB_REDO},
    {"strokes", "GET", ACTION_ASK, RF_WEB_STROKES},
    {"save", "POST", ACTION_ASK, RF_WEB_SAVE},
    {"pull", "POST", ACTION_ASK, RF_WEB_PULL},
    {"close", "POST", ACTION_CLOSE, RF_WEB_NOTHING},
};

static const char *header(const struct request *request, const char *name)
{
    return MHD_lookup_connection_value(request->connection, MHD_HEADER_KIND, name);
}

/* The most bytes of a body, which is refused before it is sent where it says more. */
static void check_length(const struct server *server, struct request *request)
{
    const bool upload = request->action == ACTION_UPLOAD;
    const uint64_t most = upload ? server->setup->most_upload : RF_WEB_MOST_BODY;
    const char *const length = header(request, MHD_HTTP_HEADER_CONTENT_LENGTH);

    if (length && (strlen(length) > 15 || strtoull(length, NULL, 10) > most))
        answer_error(request, MHD_HTTP_CONTENT_TOO_LARGE,
                     upload ? "the photo is larger than this server takes" : "too much is asked");
}

static void find_file(struct request *request, const char *name)
{
    for (const struct page_file *file = page_files; file->name; file++)
        if (strcmp(file->name, name) == 0) {
            request->file = file;
            request->size = file->size;
            request->status = MHD_HTTP_OK;
            snprintf(request->type, sizeof request->type, "%s", file->type);
        }
}

static const struct way *find_way(const char *name)
{
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++)
        if (strcmp(ways[i].name, name) == 0)
            return &ways[i];
    return NULL;
}

/* The headers are here: what is wrong with them is answered before there is a body. */
static void check(struct server *server, struct request *request, const char *url,
                  const char *method)
{
    const char *const host = header(request, MHD_HTTP_HEADER_HOST);
    const char *const site = header(request, "Sec-Fetch-Site");
    const char *const origin = server->setup->origin;
    const char *const name = rf_check_path(url, server->token);
    const struct way *way;

    if (strcmp(method, MHD_HTTP_METHOD_HEAD) == 0)
        method = MHD_HTTP_METHOD_GET; /* the library leaves the body out */
    if (!name || !rf_check_host(host, server->port, origin)) {
        answer_error(request, MHD_HTTP_NOT_FOUND, NULL);
        return;
    }
    /* The page itself may be come to by a link from anywhere. */
    if (!rf_check_origin(header(request, MHD_HTTP_HEADER_ORIGIN), host, origin) ||
        (site && name[0] && strcmp(site, "same-origin") != 0 && strcmp(site, "none") != 0)) {
        answer_error(request, MHD_HTTP_FORBIDDEN, NULL);
        return;
    }
    find_file(request, name);
    way = find_way(name);
    if (!way && request->status == 0) {
        answer_error(request, MHD_HTTP_NOT_FOUND, "there is nothing of this name");
    } else if (strcmp(method, way ? way->method : MHD_HTTP_METHOD_GET) != 0) {
        request->file = NULL;
        answer_error(request, MHD_HTTP_METHOD_NOT_ALLOWED, "another method is meant");
    } else if (way) {
        request->action = way->action;
        request->ask.what = way->what;
        request_take_arguments(server, request);
        if (request->status == 0)
            check_length(server, request);
    }
}

static void list_photos(struct server *server, struct request *request)
{
    struct folder *const folder = &server->folder;
    json_t *const list = json_array();
    json_t *object;
    char *text;

    if (!folder_read(folder)) {
        json_decref(list);
        answer_error(request, MHD_HTTP_INTERNAL_SERVER_ERROR, "the folder cannot be read");
        return;
    }
    for (int i = 0; i < folder->count; i++) {
        const struct folder_photo *const photo = &folder->photos[i];

        json_array_append_new(
            list, json_pack("{s:s, s:o}", "name", photo->name, "depth",
                            photo->depth < 0 ? json_null() : json_boolean(photo->depth)));
    }
    object = json_pack("{s:b, s:b, s:o, s:i, s:o, s:I}", "folder", folder->fd >= 0, "live",
                       server->setup->live, "photos", list, "unnamed", folder->unnamed, "open",
                       folder->file >= 0 ? json_string(folder->photos[0].name) : json_null(),
                       "upload_limit", (json_int_t)server->setup->most_upload);
    text = object ? json_dumps(object, JSON_COMPACT) : NULL;
    json_decref(object);
    if (text)
        answer_text(request, text, strlen(text), "application/json");
    else
        answer_error(request, MHD_HTTP_SERVICE_UNAVAILABLE, "not enough memory");
}

static void open_photo(struct server *server, struct request *request)
{
    const int fd = folder_photo_open(&server->folder, request->name);

    if (fd < 0)
        answer_error(request, MHD_HTTP_NOT_FOUND, "there is no such photo");
    else
        process_open(server, request, fd);
}

/* The whole request is here. */
static void dispatch(struct server *server, struct request *request)
{
    int fd;

    request->dispatched = true;
    switch (request->action) {
    case ACTION_PAGE:
        break;
    case ACTION_PHOTOS:
        list_photos(server, request);
        break;
    case ACTION_THUMBNAIL:
        process_thumbnail(server, request);
        break;
    case ACTION_OPEN:
        open_photo(server, request);
        break;
    case ACTION_LIVE:
        if (server->setup->live)
            process_live(server, request);
        else
            answer_error(request, MHD_HTTP_NOT_FOUND, "no camera is given; start it with --live");
        break;
    case ACTION_UPLOAD:
        fd = upload_end(server, request);
        if (fd >= 0)
            process_open(server, request, fd);
        break;
    case ACTION_ASK:
        /* It may have ended while the body came. */
        request_find_process(server, request);
        if (request->status == 0)
            process_ask(server, request);
        break;
    case ACTION_CLOSE:
        request_find_process(server, request);
        if (request->status == 0) {
            /* Others may look at the cameras, which end when nobody does. */
            if (!request->process->live)
                process_end(server, request->process, MHD_HTTP_GONE,
                            "this session has been closed");
            answer_text(request, strdup("{\"closed\":true}"), 15, "application/json");
        }
        break;
    }
}

static void take_body(struct server *server, struct request *request, const char *data, size_t size)
{
    char *more;

    if (request->status != 0)
        return;
    if (request->action == ACTION_UPLOAD) {
        upload_take(server, request, data, size);
        return;
    }
    if (size > RF_WEB_MOST_BODY - request->ask.bytes) {
        answer_error(request, MHD_HTTP_CONTENT_TOO_LARGE, "too much is asked");
        request->line->deadline_ms = server_now_ms() + 2000;
        return;
    }
    more = realloc(request->body, request->ask.bytes + size);
    if (!more) {
        answer_error(request, MHD_HTTP_SERVICE_UNAVAILABLE, "not enough memory");
        return;
    }
    memcpy(more + request->ask.bytes, data, size);
    request->body = more;
    request->ask.bytes += (uint32_t)size;
}

static struct request *begin(struct server *server, struct MHD_Connection *connection,
                             const char *url, const char *method)
{
    const union MHD_ConnectionInfo *const info =
        MHD_get_connection_info(connection, MHD_CONNECTION_INFO_SOCKET_CONTEXT);
    struct request *const request =
        info && info->socket_context ? calloc(1, sizeof *request) : NULL;

    if (!request)
        return NULL;
    request->connection = connection;
    request->line = info->socket_context;
    request->upload = -1;
    request->depth = -1;
    check(server, request, url, method);
    if (request->status == 0 && request->action == ACTION_UPLOAD)
        upload_begin(server, request);
    request->line->deadline_ms =
        server_now_ms() + 1e3 * (request->action == ACTION_UPLOAD ? SECONDS_UPLOAD : SECONDS_BODY);
    return request;
}

enum MHD_Result request_handle(void *of, struct MHD_Connection *connection, const char *url,
                               const char *method, const char *version, const char *data,
                               size_t *size, void **kept)
{
    struct server *const server = of;
    struct request *request = *kept;

    (void)version;
    if (!request) {
        request = begin(server, connection, url, method);
        *kept = request;
        if (!request)
            return MHD_NO;
        return request->status != 0 ? answer_queue(request) : MHD_YES;
    }
    if (*size > 0) {
        take_body(server, request, data, *size);
        *size = 0;
        return MHD_YES;
    }
    if (request->status == 0 && !request->dispatched) {
        dispatch(server, request);
        if (request->status == 0) {
            request->line->deadline_ms = INFINITY;
            request->suspended = true;
            MHD_suspend_connection(connection);
            return MHD_YES;
        }
    }
    return answer_queue(request);
}

void request_completed(void *of, struct MHD_Connection *connection, void **kept,
                       enum MHD_RequestTerminationCode code)
{
    struct server *const server = of;
    struct request *const request = *kept;

    (void)connection;
    (void)code;
    if (!request)
        return;
    server->held -= request->held;
    upload_drop(server, request);
    request->line->deadline_ms = server_now_ms() + 1e3 * SECONDS_IDLE;
    free(request->body);
    free(request->text);
    free(request);
    *kept = NULL;
}
