/* standard_input.c: a photo is read from standard input. */
#include "inputs/standard_input.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include "inputs/limits.h"

enum { FIRST_BYTES = 1 << 16 };
static const uint64_t most_bytes = UINT64_C(1) << 30; /* as the library has it for files */

static struct refocus_blob taken; /* the bytes, until they are decoded */

bool standard_is(const char *name)
{
    return strcmp(name, "-") == 0;
}

static int fail(struct refocus_reason *reason, int status, const char *why)
{
    free(taken.data);
    taken.data = NULL;
    snprintf(reason->text, sizeof reason->text, "%s", why);
    return status;
}

static bool grow(size_t *room)
{
    const size_t more = *room ? 2 * *room : FIRST_BYTES;
    uint8_t *bytes = realloc(taken.data, more);

    if (!bytes)
        return false;
    taken.data = bytes;
    *room = more;
    return true;
}

static int take(struct refocus_reason *reason)
{
    const struct refocus_read_limits *limits = limits_taken();
    const uint64_t most =
        limits->max_memory && limits->max_memory < most_bytes ? limits->max_memory : most_bytes;
    size_t room = 0;

    if (taken.data)
        return REFOCUS_OK;
    if (isatty(STDIN_FILENO))
        return fail(reason, REFOCUS_ERR_IO, "standard input is a terminal; send it a photo");
    for (taken.size = 0;;) {
        ssize_t n;

        if (taken.size == room && !grow(&room))
            return fail(reason, REFOCUS_ERR_MEMORY, "not enough memory");
        n = read(STDIN_FILENO, taken.data + taken.size, room - taken.size);
        if (n == 0)
            return REFOCUS_OK;
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0)
            return fail(reason, REFOCUS_ERR_IO, strerror(errno));
        taken.size += (size_t)n;
        if (taken.size > most)
            return fail(reason, REFOCUS_ERR_SIZE, "standard input has more bytes than the limit");
    }
}

/* Other files may be read after standard input was looked at: its bytes stay then. */
static void let_go(const char *name)
{
    if (!standard_is(name))
        return;
    free(taken.data);
    taken.data = NULL;
}

int standard_look(struct refocus_photo **photo, const char *name, struct refocus_reason *reason)
{
    int status;

    if (!standard_is(name))
        return refocus_photo_read(photo, name, limits_taken(), reason);
    *photo = NULL;
    status = take(reason);
    return status == REFOCUS_OK
               ? refocus_photo_read_memory(photo, taken.data, taken.size, limits_taken(), reason)
               : status;
}

int standard_photo(struct refocus_photo **photo, const char *name, struct refocus_reason *reason)
{
    const int status = standard_look(photo, name, reason);

    let_go(name);
    return status;
}

static int read_map(struct refocus_photo **map, const char *name)
{
    if (standard_is(name))
        return refocus_depth_read_memory(map, taken.data, taken.size, NULL, 0, 0, limits_taken(),
                                         NULL);
    return refocus_depth_read(map, name, NULL, 0, 0, limits_taken(), NULL);
}

int standard_photo_or_map(struct refocus_photo **photo, const char *name,
                          struct refocus_reason *reason)
{
    struct refocus_photo *map = NULL;
    int status = standard_look(photo, name, reason);

    if (status == REFOCUS_OK ? !(*photo)->depth->samples
                             : status == REFOCUS_ERR_FORMAT || status == REFOCUS_ERR_UNSUPPORTED)
        if (read_map(&map, name) == REFOCUS_OK) {
            refocus_photo_free(photo);
            *photo = map;
            status = REFOCUS_OK;
        }
    let_go(name);
    return status;
}

const char *standard_ending(const char *name)
{
    static const struct {
        const char *begin, *ending;
    } formats[] = {{"\x89PNG", "png"}, {"P6", "ppm"}, {"PF", "pfm"}};
    char bytes[4] = {0};
    struct refocus_reason reason;
    struct stat about;
    FILE *file;

    if (standard_is(name)) {
        if (take(&reason) == REFOCUS_OK)
            memcpy(bytes, taken.data, taken.size < sizeof bytes ? taken.size : sizeof bytes);
    } else if (stat(name, &about) == 0 && S_ISREG(about.st_mode) &&
               (file = fopen(name, "rb")) != NULL) {
        if (fread(bytes, 1, sizeof bytes, file) == 0)
            bytes[0] = '\0';
        fclose(file);
    }
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++)
        if (memcmp(bytes, formats[i].begin, strlen(formats[i].begin)) == 0)
            return formats[i].ending;
    return "jpg";
}
