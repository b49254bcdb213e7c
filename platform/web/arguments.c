/* arguments.c: arguments of requests are read and checked. */
#include <stdio.h>
#include <string.h>
#include "check.h"
#include "server.h"

/* An argument of the query, or "" where it is not given or holds a zero. */
static const char *argument(const struct request *request, const char *name, size_t *length)
{
    const char *value = NULL;
    size_t size = 0;

    if (MHD_lookup_connection_value_n(request->connection, MHD_GET_ARGUMENT_KIND, name,
                                      strlen(name), &value, &size) != MHD_YES ||
        !value || strlen(value) != size) {
        value = "";
        size = 0;
    }
    *length = size;
    return value;
}

static bool take_name(struct request *request, const char *of)
{
    size_t length;
    const char *const name = argument(request, of, &length);

    if (!rf_check_name(name, length))
        return false;
    memcpy(request->name, name, length + 1);
    return true;
}

void request_find_process(struct server *server, struct request *request)
{
    size_t length;
    const char *const id = argument(request, "session", &length);

    request->process = rf_check_session(id) ? process_find(server, id) : NULL;
    if (!request->process)
        answer_error(request, MHD_HTTP_GONE, "this session has ended; open the photo again");
    else
        memcpy(request->name, request->process->name, sizeof request->name);
}

/* The size and the number of a picture. */
static void take_picture(struct request *request)
{
    const bool picture = request->ask.what == RF_WEB_PICTURE;
    struct process *const process = request->process;
    long size, number = 0;
    size_t length;
    const char *word = argument(request, "size", &length);

    if (!rf_check_number(word, 0, RF_WEB_MOST_SIDE, &size)) {
        answer_error(request, MHD_HTTP_BAD_REQUEST, "size: give a whole number from 0 to 65535");
        return;
    }
    word = argument(request, "request", &length);
    if (picture && !rf_check_number(word, 1, 999999999, &number)) {
        answer_error(request, MHD_HTTP_BAD_REQUEST, "request: give a whole number that rises");
        return;
    }
    if (picture && number <= process->newest) {
        answer_error(request, MHD_HTTP_CONFLICT, "a newer request has come before");
        return;
    }
    if (picture)
        process->newest = number;
    word = argument(request, "after", &length);
    if (request->ask.what == RF_WEB_FRAME && !rf_check_number(word, 0, 999999999, &number)) {
        answer_error(request, MHD_HTTP_BAD_REQUEST, "after: give the number of the last frame");
        return;
    }
    request->ask.after = (uint32_t)number;
    request->ask.size = (int32_t)size;
    request->ask.quick = strcmp(argument(request, "quick", &length), "1") == 0;
}

/* The kind of a view, or the format of a file. */
static void take_word(struct request *request)
{
    static const struct {
        enum rf_web_what what;
        const char *of, *words[5], *why;
    } kinds[] = {
        {RF_WEB_OVERLAY, "kind", {"depth", "blur", "peaking"}, "kind: give depth, blur or peaking"},
        {RF_WEB_FRAME,
         "kind",
         {"picture", "depth", "blur", "peaking"},
         "kind: give picture, depth, blur or peaking"},
        {RF_WEB_SAVE,
         "as",
         {"jpeg", "png", "settings", "depth"},
         "as: give jpeg, png, settings or depth"},
        {RF_WEB_PULL, "as", {"apng", "gif", "mp4", "webm"}, "as: give apng, gif, mp4 or webm"},
    };
    size_t length;

    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        const char *const word = argument(request, kinds[k].of, &length);

        if (request->ask.what != kinds[k].what)
            continue;
        for (int i = 0; kinds[k].words[i]; i++)
            if (strcmp(word, kinds[k].words[i]) == 0)
                snprintf(request->ask.word, sizeof request->ask.word, "%s", word);
        if (!request->ask.word[0])
            answer_error(request, MHD_HTTP_BAD_REQUEST, kinds[k].why);
    }
}

void request_take_arguments(struct server *server, struct request *request)
{
    const enum rf_web_what what = request->ask.what;

    if (request->action == ACTION_ASK || request->action == ACTION_CLOSE)
        request_find_process(server, request);
    if (request->status == 0 && (what == RF_WEB_PICTURE || what == RF_WEB_OVERLAY ||
                                 what == RF_WEB_PULL || what == RF_WEB_FRAME))
        take_picture(request);
    if (request->status == 0)
        take_word(request);
    if (request->action == ACTION_UPLOAD && !take_name(request, "name"))
        answer_error(request, MHD_HTTP_BAD_REQUEST, "name: give the photo's name, without a path");
    if ((request->action == ACTION_OPEN || request->action == ACTION_THUMBNAIL) &&
        !take_name(request, "photo"))
        answer_error(request, MHD_HTTP_NOT_FOUND, "there is no such photo");
}
