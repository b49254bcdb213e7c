/* upload.c: a photo that a client sends goes into a file without a name. */
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>
#include "upload.h"

/* A file that goes when it is closed. */
static int nameless_file(void)
{
    const char *const folder = getenv("TMPDIR");
    char path[4096];
    int fd;

    if (snprintf(path, sizeof path, "%s/refocus-XXXXXX", folder && *folder ? folder : "/tmp") >=
        (int)sizeof path)
        return -1;
    fd = mkstemp(path);
    if (fd >= 0) {
        unlink(path);
        fcntl(fd, F_SETFD, FD_CLOEXEC);
    }
    return fd;
}

void upload_begin(struct server *server, struct request *request)
{
    if (server->uploads >= MOST_UPLOADS) {
        answer_error(request, MHD_HTTP_SERVICE_UNAVAILABLE,
                     "other photos are being sent; try again in a while");
        return;
    }
    request->upload = nameless_file();
    if (request->upload < 0)
        answer_error(request, MHD_HTTP_SERVICE_UNAVAILABLE, "there is no room for another photo");
    else
        server->uploads++;
}

/* A photo that goes on by whole pieces is waited for, however long it takes. */
static void move_deadline(struct request *request, uint64_t before)
{
    if (request->uploaded / UPLOAD_PIECE > before / UPLOAD_PIECE)
        request->line->deadline_ms = server_now_ms() + 1e3 * SECONDS_UPLOAD;
}

void upload_take(struct server *server, struct request *request, const char *data, size_t size)
{
    const uint64_t before = request->uploaded;

    if (size > server->setup->most_upload - request->uploaded) {
        upload_drop(server, request);
        answer_error(request, MHD_HTTP_CONTENT_TOO_LARGE,
                     "the photo is larger than this server takes");
        request->line->deadline_ms = server_now_ms() + 2000;
        return;
    }
    while (size > 0) {
        const ssize_t written = write(request->upload, data, size);

        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0) {
            upload_drop(server, request);
            answer_error(request, MHD_HTTP_INSUFFICIENT_STORAGE, "there is no room for this photo");
            return;
        }
        data += written;
        size -= (size_t)written;
        request->uploaded += (uint64_t)written;
    }
    move_deadline(request, before);
}

int upload_end(struct server *server, struct request *request)
{
    const int fd = request->upload;

    if (request->uploaded == 0) {
        answer_error(request, MHD_HTTP_BAD_REQUEST, "no photo was sent");
        return -1;
    }
    request->upload = -1;
    server->uploads--;
    return fd;
}

void upload_drop(struct server *server, struct request *request)
{
    if (request->upload < 0)
        return;
    close(request->upload);
    request->upload = -1;
    server->uploads--;
}
