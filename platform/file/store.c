/* store.c: files appear whole or not at all. They are written under a temporary name in the same
 * folder, brought to the disk, then renamed, which replaces an older file in one step. A file
 * that is replaced passes its owner and mode on; symbolic links stay and are followed. */
#include "store.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "reason.h"

/* Length of the folder's part of a path, its slash included. */
static size_t folder_of(const char *path)
{
    const char *const slash = strrchr(path, '/');

    return slash ? (size_t)(slash + 1 - path) : 0;
}

/* Links in its folders are followed by the system. */
char *refocus_file_place(const char *path)
{
    enum { MOST = 40 }; /* as Linux; a longer chain goes round in a circle */
    const size_t size = path ? strlen(path) + 1 : 0;
    char *place = path ? malloc(size) : NULL, target[PATH_MAX];

    if (place)
        memcpy(place, path, size);

    for (int i = 0; i < MOST && place; i++) {
        const ssize_t length = readlink(place, target, sizeof target);
        const size_t folder = folder_of(place);
        char *next;

        if (length <= 0 || length == sizeof target)
            break;
        next = malloc(folder + (size_t)length + 1);
        if (next) {
            const size_t kept = target[0] == '/' ? 0 : folder;

            memcpy(next, place, kept);
            memcpy(next + kept, target, (size_t)length);
            next[kept + (size_t)length] = '\0';
        }
        free(place);
        place = next;
    }
    return place;
}

/* It uses open() with O_EXCL rather than mkstemp(), so that the umask decides the permissions of
 * new files. A file that replaces another is nobody else's before it has that one's mode. */
static int open_temporary(struct rf_store *store, size_t folder, const char *ending)
{
    const unsigned process = (unsigned)getpid();
    struct stat old;
    const mode_t mode = stat(store->path, &old) == 0 ? 0600 : 0666;

    for (int attempt = 0; attempt < 100; attempt++) {
        struct timespec now;
        int file;

        clock_gettime(CLOCK_MONOTONIC, &now);
        snprintf(store->temporary + folder, 64, ".refocus-%u-%lx%x.tmp%.8s", process,
                 (unsigned long)now.tv_nsec ^ ((unsigned long)(uintptr_t)store << 4),
                 (unsigned)attempt, ending);
        file = open(store->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
        if (file >= 0 || errno != EEXIST)
            return file;
    }
    return -1;
}

/* Only files are replaced: a pipe or device would be a file afterwards, and a link that goes round
 * in a circle none. */
static int check_place(const char *place, struct refocus_reason *reason)
{
    struct stat old;

    if (stat(place, &old) != 0) {
        return errno == ENOENT ? REFOCUS_OK
                               : rf_fail_errno(reason, errno, "cannot write in its folder");
    }
    if (S_ISDIR(old.st_mode))
        return rf_fail(reason, REFOCUS_ERR_IO, "it is a folder; give the name of a file");
    if (!S_ISREG(old.st_mode)) {
        return rf_fail(reason, REFOCUS_ERR_IO,
                       "it is a pipe, socket or device; give the name of a file");
    }
    return REFOCUS_OK;
}

/* Take the owner, group and mode of the file that is replaced. Only root may give files away.
 * Others keep the group where they are in it, and else take from the group what everybody does
 * not have, as it is another one. Where a file system has no owners and modes there is nothing
 * to keep. */
static int take_over(int file, const char *path, struct refocus_reason *reason)
{
    struct stat old, new;
    mode_t mode;

    if (stat(path, &old) != 0) {
        return errno == ENOENT ? REFOCUS_OK
                               : rf_fail_errno(reason, errno, "cannot see whose it is");
    }
    if (fstat(file, &new) != 0)
        return rf_fail_errno(reason, errno, "cannot write in its folder");
    mode = old.st_mode & 0777;
    if (new.st_uid != old.st_uid && fchown(file, old.st_uid, (gid_t)-1) != 0) {
        return rf_fail(reason, REFOCUS_ERR_IO,
                       "it belongs to another user, which replacing it would change; remove it "
                       "first or give another name");
    }
    if (new.st_gid != old.st_gid && fchown(file, (uid_t)-1, old.st_gid) != 0)
        mode &= (mode & 07) << 3 | 0707;
    if ((new.st_mode & 0777) != mode && fchmod(file, mode) != 0)
        return rf_fail_errno(reason, errno, "cannot keep its mode");
    return REFOCUS_OK;
}

/* Returns 0 or errno. A file that cannot be synced, such as a pipe, is not on a disk. */
static int sync_file(int file)
{
    while (fsync(file) != 0)
        if (errno != EINTR)
            return errno == EINVAL || errno == EROFS || errno == ENOTSUP ? 0 : errno;
    return 0;
}

/* Bring the new name to the disk, too. An error comes too late: the file is whole and in
 * its place, whatever becomes of it. */
static void sync_folder(char *path)
{
    const size_t folder = folder_of(path);
    const char kept = path[folder];
    int file;

    path[folder] = '\0';
    file = open(folder > 0 ? path : ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    path[folder] = kept;
    if (file >= 0) {
        sync_file(file);
        close(file);
    }
}

/* Make the temporary file, with the owner and mode that it is to have. */
static int begin(struct rf_store *store, const char *path, const char *ending, int *made,
                 struct refocus_reason *reason)
{
    size_t folder;
    int file = -1, status;

    memset(store, 0, sizeof *store);
    store->path = refocus_file_place(path);
    if (!store->path)
        return rf_fail_memory(reason);
    status = check_place(store->path, reason);
    folder = folder_of(store->path);
    if (status == REFOCUS_OK) {
        store->temporary = malloc(folder + 64);
        status = store->temporary ? REFOCUS_OK : rf_fail_memory(reason);
    }
    if (status == REFOCUS_OK) {
        memcpy(store->temporary, store->path, folder);
        file = open_temporary(store, folder, ending);
        status =
            file >= 0 ? REFOCUS_OK : rf_fail_errno(reason, errno, "cannot write in its folder");
    }
    if (status == REFOCUS_OK)
        status = take_over(file, store->path, reason);
    if (status != REFOCUS_OK) {
        if (file >= 0) {
            close(file);
            unlink(store->temporary);
        }
        free(store->path);
        free(store->temporary);
    }
    *made = file;
    return status;
}

int rf_store_open(struct rf_store *store, const char *path, struct refocus_reason *reason)
{
    int file, status = begin(store, path, "", &file, reason);

    if (status == REFOCUS_OK && !(store->stream = fdopen(file, "wb"))) {
        status = rf_fail_errno(reason, errno, "cannot write in its folder");
        close(file);
        unlink(store->temporary);
        free(store->path);
        free(store->temporary);
    }
    return status;
}

bool rf_store_goes_on(struct rf_store *store)
{
    if (store->error == 0 && store->cancelled && store->cancelled(store->user) != 0)
        store->error = ECANCELED;
    return store->error == 0;
}

void rf_store_write(struct rf_store *store, const void *bytes, size_t size)
{
    if (size > 0 && rf_store_goes_on(store)) {
        errno = 0;
        if (fwrite(bytes, 1, size, store->stream) != size)
            store->error = errno ? errno : EIO;
        store->written += size;
    }
}

int rf_store_open_memory(struct rf_store *store, struct refocus_reason *reason)
{
    memset(store, 0, sizeof *store);
    store->stream = open_memstream(&store->bytes, &store->size);
    return store->stream ? REFOCUS_OK : rf_fail_memory(reason);
}

int rf_store_close_memory(struct rf_store *store, int status, struct refocus_blob *blob,
                          struct refocus_reason *reason)
{
    if ((fclose(store->stream) != 0 || store->error) && status == REFOCUS_OK)
        status = rf_fail_memory(reason);
    if (status != REFOCUS_OK) {
        free(store->bytes);
        store->bytes = NULL;
        store->size = 0;
    }
    blob->data = (uint8_t *)store->bytes;
    blob->size = store->size;
    return status;
}

int rf_store_close(struct rf_store *store, int status, struct refocus_reason *reason)
{
    const bool good = status == REFOCUS_OK;
    int kept;

    errno = 0;
    if (good && rf_store_goes_on(store) && fflush(store->stream) != 0)
        store->error = errno ? errno : EIO;
    if (good && store->error == 0 && !store->unsynced)
        store->error = sync_file(fileno(store->stream));
    /* Until it has its name it is among the open files, where a process that is to end finds it. */
    kept = fcntl(fileno(store->stream), F_DUPFD_CLOEXEC, 0);
    errno = 0;
    if (fclose(store->stream) != 0 && store->error == 0)
        store->error = errno ? errno : EIO;
    if (good && store->error == 0 && rename(store->temporary, store->path) != 0)
        store->error = errno;
    if (!good || store->error != 0)
        unlink(store->temporary);
    else if (!store->unsynced)
        sync_folder(store->path);
    if (kept >= 0)
        close(kept);
    if (good && store->error == ECANCELED)
        status = rf_fail(reason, REFOCUS_ERR_CANCELLED, "cancelled");
    else if (good && store->error != 0)
        status = rf_fail_errno(reason, store->error, "cannot write it");
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
    if (!path || !bytes)
        return rf_fail(reason, REFOCUS_ERR_ARGUMENT, "there is no name or nothing to write");
    status = rf_store_open(&store, path, reason);
    if (status != REFOCUS_OK)
        return status;
    rf_store_write(&store, bytes, size);
    return rf_store_close(&store, REFOCUS_OK, reason);
}

int refocus_file_temporary(const char *path, char **temporary, struct refocus_reason *reason)
{
    struct refocus_reason unused;
    struct rf_store store;
    const char *dot;
    int file, status;

    reason = reason ? reason : &unused;
    reason->text[0] = '\0';
    if (!path || !*path || !temporary)
        return rf_fail(reason, REFOCUS_ERR_ARGUMENT, "there is no name or no place for one");
    *temporary = NULL;
    dot = strrchr(path + folder_of(path), '.');
    status = begin(&store, path, dot ? dot : "", &file, reason);
    if (status == REFOCUS_OK) {
        close(file);
        free(store.path);
        *temporary = store.temporary;
    }
    return status;
}

int refocus_file_move(const char *temporary, const char *path, struct refocus_reason *reason)
{
    struct refocus_reason unused;
    char *place;
    int file, status, error = 0;

    reason = reason ? reason : &unused;
    reason->text[0] = '\0';
    if (!temporary || !path)
        return rf_fail(reason, REFOCUS_ERR_ARGUMENT, "there is no name");
    place = refocus_file_place(path);
    if (!place)
        return rf_fail_memory(reason);
    status = check_place(place, reason);
    file = status == REFOCUS_OK ? open(temporary, O_RDONLY | O_CLOEXEC) : -1;
    if (file >= 0) {
        status = take_over(file, place, reason);
        error = status == REFOCUS_OK ? sync_file(file) : 0;
        close(file);
    } else if (status == REFOCUS_OK) {
        error = errno;
    }
    if (status == REFOCUS_OK && error == 0 && rename(temporary, place) != 0)
        error = errno;
    if (error != 0)
        status = rf_fail_errno(reason, error, "cannot write it");
    if (status == REFOCUS_OK)
        sync_folder(place);
    free(place);
    return status;
}
