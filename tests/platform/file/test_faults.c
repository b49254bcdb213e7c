/* test_faults.c: the system fails once, at each of its calls in turn, while a file is saved, moved
 * or read: the new file is whole, or the old one is as it was and words say why. Nothing is left
 * beside it, and no file stays open. */
#include "check.h"

#include <errno.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

static int calls, fail_at, failure; /* the call that fails, from 1 on, and its errno */
static int short_read;              /* a read has failed: its stream says so */

static int fails(void)
{
    if (++calls != fail_at)
        return 0;
    errno = failure;
    return 1;
}

/* Calls that are not made when they fail; files are those of 64-bit sizes everywhere. */
#define WRAP(type, none, name, parameters, ...)                                                    \
    type __real_##name parameters;                                                                 \
    type __wrap_##name parameters;                                                                 \
    type __wrap_##name parameters                                                                  \
    {                                                                                              \
        return fails() ? (none) : __real_##name(__VA_ARGS__);                                      \
    }
WRAP(FILE *, NULL, fopen64, (const char *path, const char *mode), path, mode)
WRAP(FILE *, NULL, fdopen, (int file, const char *mode), file, mode)
WRAP(int, -1, fsync, (int file), file)
WRAP(int, -1, rename, (const char *from, const char *to), from, to)
WRAP(int, -1, stat64, (const char *path, struct stat *facts), path, facts)
WRAP(int, -1, fstat64, (int file, struct stat *facts), file, facts)
WRAP(int, -1, fchmod, (int file, mode_t mode), file, mode)
WRAP(ssize_t, -1, readlink, (const char *path, char *to, size_t size), path, to, size)

int __real_open64(const char *path, int flags, mode_t mode);
int __wrap_open64(const char *path, int flags, mode_t mode);
size_t __real_fread(void *to, size_t size, size_t n, FILE *stream);
size_t __wrap_fread(void *to, size_t size, size_t n, FILE *stream);
size_t __real_fwrite(const void *from, size_t size, size_t n, FILE *stream);
size_t __wrap_fwrite(const void *from, size_t size, size_t n, FILE *stream);
int __real_ferror(FILE *stream);
int __wrap_ferror(FILE *stream);
int __real_fflush(FILE *stream);
int __wrap_fflush(FILE *stream);
int __real_fclose(FILE *stream);
int __wrap_fclose(FILE *stream);

int __wrap_open64(const char *path, int flags, mode_t mode)
{
    return fails() ? -1 : __real_open64(path, flags, mode);
}

/* Half of it comes or goes. */
size_t __wrap_fread(void *to, size_t size, size_t n, FILE *stream)
{
    short_read = fails();
    n = __real_fread(to, size, short_read ? n / 2 : n, stream);
    if (short_read)
        errno = failure;
    return n;
}

int __wrap_ferror(FILE *stream)
{
    return short_read || __real_ferror(stream);
}

size_t __wrap_fwrite(const void *from, size_t size, size_t n, FILE *stream)
{
    const int fault = fails();

    n = __real_fwrite(from, size, fault ? n / 2 : n, stream);
    if (fault)
        errno = failure;
    return n;
}

int __wrap_fflush(FILE *stream)
{
    return fails() ? EOF : __real_fflush(stream);
}

/* The stream is closed all the same. */
int __wrap_fclose(FILE *stream)
{
    const int fault = fails(), status = __real_fclose(stream);

    if (fault)
        errno = failure;
    return fault ? EOF : status;
}

static char before[4096], folder[64];

static int make_folder(void **state)
{
    (void)state;
    strcpy(folder, "/tmp/refocus-test-XXXXXX");
    return getcwd(before, sizeof before) && mkdtemp(folder) ? chdir(folder) : -1;
}

static int remove_folder(void **state)
{
    (void)state;
    unlink("a.ppm");
    unlink("tmp");
    return chdir(before) || rmdir(folder); /* nothing else is left */
}

static const uint8_t pixels[12] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
static const uint8_t old[3] = "old";

static int save(struct refocus_reason *reason)
{
    const struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, (uint8_t *)(uintptr_t)pixels, 2, 2, 6);

    return refocus_image_write("a.ppm", &image, NULL, reason);
}

static int move(struct refocus_reason *reason)
{
    return refocus_file_move("tmp", "a.ppm", reason);
}

/* The bytes of a file are these. */
static void holds(const char *path, const void *bytes, size_t size)
{
    struct refocus_blob blob;

    assert_int_equal(refocus_file_read(path, 1000, &blob, NULL), REFOCUS_OK);
    assert_int_equal(blob.size, size);
    assert_memory_equal(blob.data, bytes, size);
    free(blob.data);
}

/* Does it with a failure at each call; returns how many calls it makes. */
static int each_call(int (*act)(struct refocus_reason *reason), bool moves, int error)
{
    const int files = entries("/proc/self/fd");
    struct refocus_blob good;

    fail_at = 0;
    failure = error;
    assert_int_equal(save(NULL), REFOCUS_OK);
    assert_int_equal(refocus_file_read("a.ppm", 1000, &good, NULL), REFOCUS_OK);
    for (int at = 1;; at++) {
        struct refocus_reason reason = {.text = ""};
        struct stat facts;
        int status, made;

        fail_at = 0;
        assert_int_equal(refocus_file_write("a.ppm", old, sizeof old, NULL), REFOCUS_OK);
        assert_int_equal(chmod("a.ppm", 0604), 0);
        if (moves)
            assert_int_equal(refocus_file_write("tmp", good.data, good.size, NULL), REFOCUS_OK);
        calls = 0;
        fail_at = at;
        status = act(&reason);
        made = calls;
        fail_at = short_read = 0;
        assert_int_equal(__real_stat64("a.ppm", &facts), 0);
        assert_int_equal(facts.st_mode & 0777, 0604);
        if (status == REFOCUS_OK) {
            holds("a.ppm", good.data, good.size);
        } else {
            assert_int_equal(status, REFOCUS_ERR_IO);
            assert_string_not_equal(reason.text, "");
            holds("a.ppm", old, sizeof old);
        }
        assert_int_equal(entries("."), 3 + (moves && status != REFOCUS_OK));
        assert_int_equal(entries("/proc/self/fd"), files);
        if (made < at) {
            assert_int_equal(status, REFOCUS_OK);
            free(good.data);
            return made;
        }
    }
}

TEST_BETWEEN(saving, make_folder, remove_folder)
{
    static const int errors[] = {EIO, ENOSPC, EACCES, EROFS, EDQUOT};

    for (size_t i = 0; i < sizeof errors / sizeof *errors; i++) {
        assert_true(each_call(save, false, errors[i]) >= 10);
        assert_true(each_call(move, true, errors[i]) >= 6);
    }
}

TEST_BETWEEN(reading, make_folder, remove_folder)
{
    const int files = entries("/proc/self/fd");
    int made = 0;

    fail_at = 0;
    failure = EIO;
    assert_int_equal(save(NULL), REFOCUS_OK);
    for (int at = 1; made >= at - 1; at++) {
        struct refocus_photo *photo = (struct refocus_photo *)1;
        struct refocus_reason reason = {.text = ""};
        int status;

        calls = 0;
        fail_at = at;
        status = refocus_photo_read(&photo, "a.ppm", NULL, &reason);
        made = calls;
        fail_at = short_read = 0;
        if (status == REFOCUS_OK) {
            assert_non_null(photo);
        } else {
            assert_int_equal(status, REFOCUS_ERR_IO);
            assert_string_not_equal(reason.text, "");
            assert_null(photo);
        }
        assert_true(status == REFOCUS_OK || made >= at);
        refocus_photo_free(&photo);
        assert_int_equal(entries("/proc/self/fd"), files);
        assert_true(at < 100);
    }
    assert_true(made >= 4); /* it is opened, looked at, read and closed */
}
