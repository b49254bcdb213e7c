/* load.c: a whole file is read into memory. It is not mapped, as a file that shrinks meanwhile
 * would end in SIGBUS. */
#include "load.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "reason.h"

enum { BEGINNING = 1 << 16 };

static int fail_large(struct refocus_reason *reason, uint64_t max_bytes)
{
    return rf_fail(reason, REFOCUS_ERR_SIZE, "it is larger than the limit of %llu bytes",
                   (unsigned long long)max_bytes);
}

/* A pipe may keep its reader waiting for ever, and a device goes on without an end. The room is one
 * byte more than the file's size, which shows its end without a second allocation; files of /proc
 * have no size. */
static int check_file(int file, uint64_t max_bytes, struct refocus_reason *reason, size_t *room)
{
    struct stat facts;

    if (fstat(file, &facts) != 0)
        return rf_fail_errno(reason, errno, "cannot read it");
    if (S_ISDIR(facts.st_mode))
        return rf_fail(reason, REFOCUS_ERR_IO, "it is a folder; give the name of a file");
    if (!S_ISREG(facts.st_mode)) {
        return rf_fail(reason, REFOCUS_ERR_IO,
                       "it is a pipe, socket or device; give the name of a file");
    }
    if (facts.st_size < 0 || (uint64_t)facts.st_size > max_bytes ||
        (uint64_t)facts.st_size >= SIZE_MAX)
        return fail_large(reason, max_bytes);
    *room = (size_t)facts.st_size + 1;
    return REFOCUS_OK;
}

static int read_all(FILE *stream, size_t whole, uint64_t max_bytes,
                    bool (*is_known)(struct rf_bytes), struct refocus_reason *reason,
                    struct refocus_blob *blob)
{
    size_t room = whole > BEGINNING && !is_known ? whole : BEGINNING;

    for (;;) {
        uint8_t *const grown = realloc(blob->data, room);
        if (!grown)
            return rf_fail_memory(reason);
        blob->data = grown;
        errno = 0;
        blob->size += fread(blob->data + blob->size, 1, room - blob->size, stream);
        if (ferror(stream))
            return rf_fail_errno(reason, errno ? errno : EIO, "cannot read it");
        if (blob->size > max_bytes)
            return fail_large(reason, max_bytes);
        if (blob->size < room || (is_known && !is_known((struct rf_bytes){blob->data, blob->size})))
            return REFOCUS_OK;
        if (room > SIZE_MAX / 2)
            return rf_fail_memory(reason);
        room = whole > room ? whole : 2 * room;
    }
}

/* O_NONBLOCK: a pipe without a writer is opened all the same, and refused. */
int rf_load(const char *path, uint64_t max_bytes, bool (*is_known)(struct rf_bytes beginning),
            struct refocus_reason *reason, struct refocus_blob *blob)
{
    const int file = open(path, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    FILE *stream = NULL;
    size_t room = 0;
    int status;

    blob->data = NULL;
    blob->size = 0;
    if (file < 0)
        return rf_fail_errno(reason, errno, "cannot open it");
    status = check_file(file, max_bytes, reason, &room);
    if (status == REFOCUS_OK) {
        stream = fdopen(file, "rb");
        status = stream ? read_all(stream, room, max_bytes, is_known, reason, blob)
                        : rf_fail_errno(reason, errno, "cannot open it");
    }
    if (stream)
        fclose(stream);
    else
        close(file);
    if (status != REFOCUS_OK) {
        free(blob->data);
        blob->data = NULL;
        blob->size = 0;
    }
    return status;
}

int refocus_file_read(const char *path, uint64_t max_bytes, struct refocus_blob *blob,
                      struct refocus_reason *reason)
{
    struct refocus_reason unused;

    reason = reason ? reason : &unused;
    reason->text[0] = '\0';
    if (!path || !blob)
        return rf_fail(reason, REFOCUS_ERR_ARGUMENT, "there is no name or no place for it");
    return rf_load(path, max_bytes, NULL, reason, blob);
}
