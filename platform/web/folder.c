/* folder.c: the photos that a server may open. Names come from the network: they are opened in the
 * folder that was opened at the start, and neither a path nor a link leads out of it. */
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include "check.h"
#include "folder.h"

static bool is_file(int fd)
{
    struct stat about;

    return fstat(fd, &about) == 0 && S_ISREG(about.st_mode);
}

static bool add(struct folder *folder, const char *name, int64_t changed, int64_t bytes, int depth)
{
    struct folder_photo *const more =
        realloc(folder->photos, (size_t)(folder->count + 1) * sizeof *more);

    if (!more)
        return false;
    folder->photos = more;
    more[folder->count] = (struct folder_photo){.changed = changed, .bytes = bytes, .depth = depth};
    more[folder->count].name = strdup(name);
    if (!more[folder->count].name)
        return false;
    folder->count++;
    return true;
}

static void forget(struct folder_photo *photos, int count)
{
    for (int i = 0; i < count; i++)
        free(photos[i].name);
    free(photos);
}

bool folder_open(struct folder *folder, const char *path, char *why)
{
    const char *const slash = path ? strrchr(path, '/') : NULL;
    const char *const name = slash ? slash + 1 : path;
    struct stat about;
    int fd;

    *folder = (struct folder){.fd = -1, .file = -1};
    if (!path)
        return true;
    /* Not to wait for a pipe that nobody writes to. */
    fd = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0 || fstat(fd, &about) != 0) {
        snprintf(why, 256, "%s", strerror(errno));
    } else if (S_ISDIR(about.st_mode)) {
        folder->fd = fd;
        return true;
    } else if (!S_ISREG(about.st_mode)) {
        snprintf(why, 256, "it is neither a photo nor a folder");
    } else if (!rf_check_photo_ending(name)) {
        snprintf(why, 256, "its name does not end as a photo's does, such as in .jpg");
    } else if (!rf_check_name(name, strlen(name))) {
        snprintf(why, 256, "its name is hidden or not UTF-8; give it another");
    } else if (!add(folder, name, 0, 0, -1)) {
        snprintf(why, 256, "not enough memory");
    } else {
        folder->file = fd;
        return true;
    }
    if (fd >= 0)
        close(fd);
    return false;
}

void folder_close(struct folder *folder)
{
    forget(folder->photos, folder->count);
    if (folder->fd >= 0)
        close(folder->fd);
    if (folder->file >= 0)
        close(folder->file);
}

static int by_name(const void *a, const void *b)
{
    const struct folder_photo *x = a, *y = b;

    return strcmp(x->name, y->name);
}

static const struct folder_photo *find(const struct folder *folder, const char *name)
{
    for (int i = 0; i < folder->count; i++)
        if (strcmp(folder->photos[i].name, name) == 0)
            return &folder->photos[i];
    return NULL;
}

/* The depth that was known of a file, which holds as long as it has not changed. */
static int known_depth(const struct folder *old, const char *name, int64_t changed, int64_t bytes)
{
    const struct folder_photo key = {.name = (char *)name};
    const struct folder_photo *const photo =
        old->count > 0 ? bsearch(&key, old->photos, (size_t)old->count, sizeof key, by_name) : NULL;

    return photo && photo->changed == changed && photo->bytes == bytes ? photo->depth : -1;
}

static bool read_names(struct folder *folder, const struct folder *old, DIR *stream)
{
    const struct dirent *entry;

    while (folder->count < FOLDER_MOST && (entry = readdir(stream)) != NULL) {
        const char *const name = entry->d_name;
        struct stat about;

        if (name[0] == '.' || !rf_check_photo_ending(name) ||
            fstatat(folder->fd, name, &about, AT_SYMLINK_NOFOLLOW) != 0 || !S_ISREG(about.st_mode))
            continue;
        if (!rf_check_name(name, strlen(name)))
            folder->unnamed++;
        else if (!add(folder, name, about.st_mtime, about.st_size,
                      known_depth(old, name, about.st_mtime, about.st_size)))
            return false;
    }
    return true;
}

bool folder_read(struct folder *folder)
{
    struct folder fresh = {.fd = folder->fd, .file = -1};
    DIR *stream;
    int fd;

    if (folder->fd < 0)
        return true;
    /* An open description of its own, which is read from the beginning. */
    fd = openat(folder->fd, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    stream = fd >= 0 ? fdopendir(fd) : NULL;
    if (!stream) {
        if (fd >= 0)
            close(fd);
        return false;
    }
    if (!read_names(&fresh, folder, stream)) {
        closedir(stream);
        forget(fresh.photos, fresh.count);
        return false;
    }
    closedir(stream);
    if (fresh.count > 0)
        qsort(fresh.photos, (size_t)fresh.count, sizeof *fresh.photos, by_name);
    forget(folder->photos, folder->count);
    *folder = fresh;
    return true;
}

int folder_photo_open(const struct folder *folder, const char *name)
{
    int fd;

    if (!rf_check_name(name, strlen(name)))
        return -1;
    if (folder->file >= 0)
        return find(folder, name) ? fcntl(folder->file, F_DUPFD_CLOEXEC, 3) : -1;
    if (folder->fd < 0 || !rf_check_photo_ending(name))
        return -1;
    fd = openat(folder->fd, name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (fd >= 0 && !is_file(fd)) {
        close(fd);
        fd = -1;
    }
    return fd;
}

void folder_note_depth(struct folder *folder, const char *name, int depth)
{
    for (int i = 0; i < folder->count; i++)
        if (strcmp(folder->photos[i].name, name) == 0)
            folder->photos[i].depth = depth;
}
