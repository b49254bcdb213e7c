/* Files appear whole or not at all: written under a temporary name in the same folder,
 * then renamed, which replaces what was there in one step. */
#include "internal.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

/* open() with O_EXCL rather than mkstemp(): the umask decides the permissions. */
static int open_temporary(struct rf_store *store, size_t folder)
{
    const unsigned process = (unsigned)getpid();

    for (int attempt = 0; attempt < 100; attempt++) {
        struct timespec now;
        int file;

        clock_gettime(CLOCK_MONOTONIC, &now);
        snprintf(store->temporary + folder, 64, ".refocus-%u-%lx%x.tmp", process,
                 (unsigned long)now.tv_nsec ^ ((unsigned long)(uintptr_t)store << 4),
                 (unsigned)attempt);
        file = open(store->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file >= 0 || errno != EEXIST) {
            return file;
        }
    }
    return -1;
}

int rf_store_open(struct rf_store *store, const char *path,
                  struct refocus_reason *reason)
{
    const char *const slash = strrchr(path, '/');
    const size_t folder = slash ? (size_t)(slash + 1 - path) : 0;
    const size_t length = strlen(path);
    int file, error;

    memset(store, 0, sizeof *store);
    store->path = malloc(length + 1);
    store->temporary = malloc(folder + 64);
    if (!store->path || !store->temporary) {
        free(store->path);
        free(store->temporary);
        return rf_fail_memory(reason);
    }
    memcpy(store->path, path, length + 1);
    memcpy(store->temporary, path, folder);
    file = open_temporary(store, folder);
    error = errno;
    if (file >= 0) {
        store->stream = fdopen(file, "wb");
        error = errno;
        if (!store->stream) {
            close(file);
            unlink(store->temporary);
        }
    }
    if (!store->stream) {
        free(store->path);
        free(store->temporary);
        return rf_fail_errno(reason, error, "cannot write in its folder");
    }
    return REFOCUS_OK;
}

void rf_store_write(struct rf_store *store, const void *bytes, size_t size)
{
    if (store->error == 0 && size > 0) {
        errno = 0;
        if (fwrite(bytes, 1, size, store->stream) != size) {
            store->error = errno ? errno : EIO;
        }
    }
}

int rf_store_close(struct rf_store *store, int status, struct refocus_reason *reason)
{
    errno = 0;
    if (fclose(store->stream) != 0 && store->error == 0) {
        store->error = errno ? errno : EIO;
    }
    if (status == REFOCUS_OK && store->error == 0 &&
        rename(store->temporary, store->path) != 0) {
        store->error = errno;
    }
    if (status != REFOCUS_OK || store->error != 0) {
        unlink(store->temporary);
    }
    if (status == REFOCUS_OK && store->error != 0) {
        status = rf_fail_errno(reason, store->error, "cannot write it");
    }
    free(store->temporary);
    free(store->path);
    return status;
}

int refocus_file_write(const char *path, const void *bytes, size_t size,
                       struct refocus_reason *reason)
{
    struct refocus_reason unused;
    struct rf_store store;
    int status;

    reason = reason ? reason : &unused;
    reason->text[0] = '\0';
    if (!path || !bytes) {
        return rf_fail(reason, REFOCUS_ERR_ARGUMENT, "there is no name or nothing to "
                                                     "write");
    }
    status = rf_store_open(&store, path, reason);
    if (status != REFOCUS_OK) {
        return status;
    }
    rf_store_write(&store, bytes, size);
    return rf_store_close(&store, REFOCUS_OK, reason);
}
