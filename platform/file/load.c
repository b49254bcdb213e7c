/* load.c: a whole file is read into memory. It is not mapped, as a file that shrinks meanwhile
 * would end in SIGBUS. */
#include "load.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "reason.h"

/* Room for one byte more than the size shows the end without a second allocation. */
static size_t first_room(FILE *stream, uint64_t max_bytes)
{
    const size_t pipe_room = 1 << 16;
    struct stat facts;

    if (fstat(fileno(stream), &facts) == 0 && S_ISREG(facts.st_mode) && facts.st_size >= 0 &&
        (uint64_t)facts.st_size <= max_bytes && (uint64_t)facts.st_size < SIZE_MAX) {
        return (size_t)facts.st_size + 1;
    }
    return pipe_room;
}

static int read_all(FILE *stream, uint64_t max_bytes, struct refocus_reason *reason,
                    struct refocus_blob *blob)
{
    size_t room = first_room(stream, max_bytes);

    for (;;) {
        uint8_t *const grown = realloc(blob->data, room);
        if (!grown) {
            return rf_fail_memory(reason);
        }
        blob->data = grown;
        errno = 0;
        blob->size += fread(blob->data + blob->size, 1, room - blob->size, stream);
        if (ferror(stream)) {
            return rf_fail_errno(reason, errno ? errno : EIO, "cannot read it");
        }
        if (blob->size > max_bytes) {
            return rf_fail(reason, REFOCUS_ERR_SIZE, "it is larger than the limit of %llu bytes",
                           (unsigned long long)max_bytes);
        }
        if (blob->size < room) {
            return REFOCUS_OK;
        }
        if (room > SIZE_MAX / 2) {
            return rf_fail_memory(reason);
        }
        room *= 2;
    }
}

int rf_load(const char *path, uint64_t max_bytes, struct refocus_reason *reason,
            struct refocus_blob *blob)
{
    FILE *stream;
    int status;

    blob->data = NULL;
    blob->size = 0;
    errno = 0;
    stream = fopen(path, "rbe");
    if (!stream) {
        return rf_fail_errno(reason, errno ? errno : EIO, "cannot open it");
    }
    status = read_all(stream, max_bytes, reason, blob);
    fclose(stream);
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
    if (!path || !blob) {
        return rf_fail(reason, REFOCUS_ERR_ARGUMENT,
                       "there is no name or no place for "
                       "it");
    }
    return rf_load(path, max_bytes, reason, blob);
}
