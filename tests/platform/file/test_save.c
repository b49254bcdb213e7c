/* test_save.c: saving is watched on its way to the disk, as is the file that is replaced:
 * fsync() and rename() are counted on their way to the system. */
#include "check.h"

#include <errno.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

int __real_fsync(int file);
int __wrap_fsync(int file);
int __real_rename(const char *from, const char *to);
int __wrap_rename(const char *from, const char *to);

static char steps[16]; /* f: a file is synced, d: a folder, r: renamed */
static size_t count;
static off_t synced; /* bytes that the file had by then */
static int error;    /* errno that fsync() fails with, once */

static void note(char step)
{
    assert_true(count + 1 < sizeof steps);
    steps[count++] = step;
    steps[count] = '\0';
}

int __wrap_fsync(int file)
{
    struct stat facts;

    assert_int_equal(fstat(file, &facts), 0);
    note(S_ISDIR(facts.st_mode) ? 'd' : 'f');
    if (S_ISREG(facts.st_mode))
        synced = facts.st_size;
    if (error) {
        errno = error;
        error = 0;
        return -1;
    }
    return __real_fsync(file);
}

int __wrap_rename(const char *from, const char *to)
{
    note('r');
    return __real_rename(from, to);
}

static char before[4096], folder[64];

static int make_folder(void **state)
{
    (void)state;
    strcpy(folder, "/tmp/refocus-test-XXXXXX");
    count = 0;
    steps[0] = '\0';
    return getcwd(before, sizeof before) && mkdtemp(folder) ? chdir(folder) : -1;
}

static int remove_folder(void **state)
{
    static const char *const names[] = {"a.ppm",    "b.ppm",    "link.ppm", "sub/a.ppm",
                                        "jpeg.jpg", "grey.pgm", "text",     "tmp"};

    (void)state;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        unlink(names[i]);
    rmdir("sub");
    return chdir(before) || rmdir(folder); /* nothing else is left */
}

static const uint8_t pixels[12] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};

static int save(const char *path, const struct refocus_write_options *options)
{
    const struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, (uint8_t *)(uintptr_t)pixels, 2, 2, 6);

    return refocus_image_write(path, &image, options, NULL);
}

static struct stat facts_of(const char *path)
{
    struct stat facts;

    assert_int_equal(lstat(path, &facts), 0);
    return facts;
}

static void took(const char *expected)
{
    assert_string_equal(steps, expected);
    count = 0;
    steps[0] = '\0';
}

/* The whole file before it has its name, its folder after that. */
TEST_BETWEEN(all_writers_wait_for_the_disk, make_folder, remove_folder)
{
    const uint16_t grey[4] = {0};

    assert_int_equal(save("a.ppm", NULL), REFOCUS_OK);
    took("frd");
    assert_int_equal(synced, facts_of("a.ppm").st_size);
    assert_int_equal(mkdir("sub", 0700), 0);
    assert_int_equal(save("sub/a.ppm", NULL), REFOCUS_OK);
    took("frd");
    assert_int_equal(refocus_gray16_write("grey.pgm", grey, 2, 2, 4, NULL), REFOCUS_OK);
    took("frd");
    assert_int_equal(synced, facts_of("grey.pgm").st_size);
    assert_int_equal(refocus_file_write("text", "words", 5, NULL), REFOCUS_OK);
    took("frd");
    assert_int_equal(synced, 5);
    assert_int_equal(refocus_file_write("tmp", "words", 5, NULL), REFOCUS_OK);
    took("frd");
    assert_int_equal(refocus_file_move("tmp", "text", NULL), REFOCUS_OK);
    took("frd");
    assert_int_equal(access("tmp", F_OK), -1);
    assert_int_equal(save("a.ppm",
                          &(struct refocus_write_options){
                              .struct_size = sizeof(struct refocus_write_options), .unsynced = 1}),
                     REFOCUS_OK);
    took("r");
}

#if defined(RF_HAVE_JPEG) && defined(RF_HAVE_PNG)
TEST_BETWEEN(depth_in_a_photo_waits_too, make_folder, remove_folder)
{
    struct refocus_depth_write depth = refocus_depth_write_default();
    struct bytes jpeg = make_jpeg(16, 16, false, false);
    const uint16_t disparity[4] = {0, 1, 2, 3};

    assert_int_equal(refocus_file_write("jpeg.jpg", jpeg.data, jpeg.size, NULL), REFOCUS_OK);
    took("frd");
    assert_int_equal(chmod("jpeg.jpg", 0604), 0);
    depth.disparity = disparity;
    depth.width = depth.height = 2;
    depth.stride = 4;
    assert_int_equal(refocus_photo_write_depth("jpeg.jpg", "jpeg.jpg", &depth, NULL), REFOCUS_OK);
    took("frd");
    assert_true((size_t)synced > jpeg.size && synced == facts_of("jpeg.jpg").st_size);
    assert_int_equal(facts_of("jpeg.jpg").st_mode & 07777, 0604);
    bytes_free(&jpeg);
}
#endif

/* A disk that fails: the old file stays. One that cannot sync: nothing is lost. */
TEST_BETWEEN(errors_of_the_disk, make_folder, remove_folder)
{
    assert_int_equal(refocus_file_write("a.ppm", "old", 3, NULL), REFOCUS_OK);
    took("frd");
    error = EIO;
    assert_int_equal(save("a.ppm", NULL), REFOCUS_ERR_IO);
    took("f");
    assert_int_equal(facts_of("a.ppm").st_size, 3);
    assert_int_equal(refocus_file_write("tmp", "new", 3, NULL), REFOCUS_OK);
    took("frd");
    error = ENOSPC;
    assert_int_equal(refocus_file_move("tmp", "a.ppm", NULL), REFOCUS_ERR_IO);
    took("f");
    assert_int_equal(access("tmp", F_OK), 0);
    error = EINVAL;
    assert_int_equal(save("a.ppm", NULL), REFOCUS_OK);
    took("frd");
    error = EINTR;
    assert_int_equal(save("a.ppm", NULL), REFOCUS_OK);
    took("ffrd");
}

/* New files have what the umask leaves; others keep what they had, and the bytes are never
 * for more eyes on their way. */
TEST_BETWEEN(mode_is_kept, make_folder, remove_folder)
{
    static const mode_t modes[] = {0640, 0600, 0444, 0666, 0755};
    const mode_t mask = umask(022);

    assert_int_equal(save("a.ppm", NULL), REFOCUS_OK);
    assert_int_equal(facts_of("a.ppm").st_mode & 07777, 0644);
    for (size_t i = 0; i < sizeof modes / sizeof *modes; i++) {
        assert_int_equal(chmod("a.ppm", modes[i]), 0);
        count = 0;
        assert_int_equal(save("a.ppm", NULL), REFOCUS_OK);
        assert_int_equal(facts_of("a.ppm").st_mode & 07777, modes[i]);
        assert_int_equal(refocus_file_write("tmp", "new", 3, NULL), REFOCUS_OK);
        count = 0;
        assert_int_equal(refocus_file_move("tmp", "a.ppm", NULL), REFOCUS_OK);
        assert_int_equal(facts_of("a.ppm").st_mode & 07777, modes[i]);
        count = 0;
    }
    umask(mask);
}

TEST_BETWEEN(owner_is_kept, make_folder, remove_folder)
{
    enum { OWNER = 4711, GROUP = 4712 };

    if (geteuid() != 0) {
        print_message("not root: owners cannot be kept\n");
        skip();
    }
    for (int move = 0; move < 2; move++) {
        struct stat facts;

        count = 0;
        assert_int_equal(refocus_file_write(move ? "tmp" : "text", "old", 3, NULL), REFOCUS_OK);
        count = 0;
        assert_int_equal(save("a.ppm", NULL), REFOCUS_OK);
        assert_int_equal(chown("a.ppm", OWNER, GROUP), 0);
        assert_int_equal(chmod("a.ppm", 0640), 0);
        count = 0;
        assert_int_equal(move ? refocus_file_move("tmp", "a.ppm", NULL) : save("a.ppm", NULL),
                         REFOCUS_OK);
        facts = facts_of("a.ppm");
        assert_int_equal(facts.st_uid, OWNER);
        assert_int_equal(facts.st_gid, GROUP);
        assert_int_equal(facts.st_mode & 07777, 0640);
    }
}

static void assert_unchanged(const struct stat *was)
{
    const struct stat facts = facts_of("a.ppm");

    assert_int_equal(facts.st_ino, was->st_ino);
    assert_int_equal(facts.st_uid, was->st_uid);
    assert_int_equal(facts.st_gid, was->st_gid);
    assert_int_equal(facts.st_mode, was->st_mode);
}

/* A user who may write in the folder but does not own the file is refused, and nothing is left
 * beside it. */
TEST_BETWEEN(owner_that_cannot_be_kept, make_folder, remove_folder)
{
    struct stat was;
    int saved, moved, files;

    if (geteuid() != 0) {
        print_message("not root: nobody else to be\n");
        skip();
    }
    assert_int_equal(save("a.ppm", NULL), REFOCUS_OK);
    count = 0;
    assert_int_equal(refocus_file_write("tmp", "new", 3, NULL), REFOCUS_OK);
    assert_int_equal(chown("tmp", 4714, 4713), 0);
    assert_int_equal(chown("a.ppm", 4711, 4712), 0);
    assert_int_equal(chmod("a.ppm", 0664), 0);
    assert_int_equal(chmod(".", 0777), 0);
    was = facts_of("a.ppm");
    files = entries(".");
    assert_int_equal(setegid(4713), 0);
    assert_int_equal(seteuid(4714), 0);
    saved = save("a.ppm", NULL);
    moved = refocus_file_move("tmp", "a.ppm", NULL);
    assert_int_equal(seteuid(0), 0);
    assert_int_equal(setegid(0), 0);
    assert_int_equal(saved, REFOCUS_ERR_IO);
    assert_int_equal(moved, REFOCUS_ERR_IO);
    assert_unchanged(&was);
    assert_int_equal(entries("."), files);
}

/* The owner stays but is not in the file's group any more: it is another group's file, which gets
 * no more than everybody had. */
TEST_BETWEEN(group_that_cannot_be_kept, make_folder, remove_folder)
{
    struct stat facts;

    if (geteuid() != 0) {
        print_message("not root: nobody else to be\n");
        skip();
    }
    assert_int_equal(save("a.ppm", NULL), REFOCUS_OK);
    assert_int_equal(chown("a.ppm", 4714, 4712), 0);
    assert_int_equal(chmod("a.ppm", 0664), 0);
    assert_int_equal(chmod(".", 0777), 0);
    assert_int_equal(setegid(4713), 0);
    assert_int_equal(seteuid(4714), 0);
    count = 0;
    assert_int_equal(save("a.ppm", NULL), REFOCUS_OK);
    facts = facts_of("a.ppm");
    assert_int_equal(seteuid(0), 0);
    assert_int_equal(setegid(0), 0);
    assert_int_equal(facts.st_uid, 4714);
    assert_int_equal(facts.st_gid, 4713);
    assert_int_equal(facts.st_mode & 07777, 0644);
}

/* A pipe is no file, and neither are folders, devices and links that go round in a circle. */
TEST_BETWEEN(only_files_are_replaced, make_folder, remove_folder)
{
    static const char *const names[] = {"pipe.ppm", "folder.ppm", "null.ppm", "circle.ppm"};
    int files;

    assert_int_equal(mkfifo("pipe.ppm", 0600), 0);
    assert_int_equal(mkdir("folder.ppm", 0700), 0);
    assert_int_equal(symlink("/dev/null", "null.ppm"), 0);
    assert_int_equal(symlink("circle.ppm", "circle.ppm"), 0);
    assert_int_equal(refocus_file_write("tmp", "new", 3, NULL), REFOCUS_OK);
    files = entries(".");
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        struct refocus_reason reason;
        const mode_t was = facts_of(names[i]).st_mode;

        assert_int_equal(save(names[i], NULL), REFOCUS_ERR_IO);
        assert_int_equal(refocus_file_move("tmp", names[i], &reason), REFOCUS_ERR_IO);
        assert_string_not_equal(reason.text, "");
        assert_int_equal(facts_of(names[i]).st_mode, was);
    }
    assert_int_equal(entries("."), files);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        assert_int_equal(remove(names[i]), 0);
}

/* The file that a link points at is replaced, there or not, and the link stays. */
TEST_BETWEEN(links_stay, make_folder, remove_folder)
{
    struct stat facts;
    char *place;

    assert_int_equal(mkdir("sub", 0700), 0);
    assert_int_equal(symlink("sub/a.ppm", "b.ppm"), 0);
    assert_int_equal(symlink("b.ppm", "link.ppm"), 0);
    for (int there = 0; there < 2; there++) {
        count = 0;
        assert_int_equal(save("link.ppm", NULL), REFOCUS_OK);
        assert_true(S_ISLNK(facts_of("link.ppm").st_mode));
        assert_true(S_ISLNK(facts_of("b.ppm").st_mode));
        facts = facts_of("sub/a.ppm");
        assert_true(S_ISREG(facts.st_mode));
        if (there)
            assert_int_equal(facts.st_mode & 07777, 0600);
        assert_int_equal(chmod("sub/a.ppm", 0600), 0);
    }
    place = refocus_file_place("link.ppm");
    assert_string_equal(place, "sub/a.ppm");
    free(place);
    /* A link is read from its folder on, unless it begins at the root. */
    assert_int_equal(symlink("a.ppm", "sub/beside.ppm"), 0);
    assert_int_equal(symlink("/none/a.ppm", "sub/root.ppm"), 0);
    place = refocus_file_place("sub/beside.ppm");
    assert_string_equal(place, "sub/a.ppm");
    free(place);
    place = refocus_file_place("sub/root.ppm");
    assert_string_equal(place, "/none/a.ppm");
    free(place);
    assert_int_equal(unlink("sub/beside.ppm"), 0);
    assert_int_equal(unlink("sub/root.ppm"), 0);
}

/* Temporary files for others to write: each is new, lies where a link points, is as open as the
 * file that it replaces, and never one that was there. */
TEST_BETWEEN(temporary_files, make_folder, remove_folder)
{
    char *first, *second, text[4];
    struct stat facts;

    assert_int_equal(refocus_file_temporary("a.tar.apng", &first, NULL), REFOCUS_OK);
    assert_int_equal(refocus_file_temporary("a.tar.apng", &second, NULL), REFOCUS_OK);
    assert_string_not_equal(first, second);
    assert_string_equal(first + strlen(first) - 9, ".tmp.apng");
    assert_int_equal(stat(first, &facts), 0);
    assert_true(S_ISREG(facts.st_mode) && facts.st_size == 0);
    assert_int_equal(unlink(first), 0);
    assert_int_equal(unlink(second), 0);
    free(first);
    free(second);

    assert_int_equal(mkdir("there", 0700), 0);
    assert_int_equal(symlink("there/b.mp4", "b.mp4"), 0);
    assert_int_equal(refocus_file_write("b.mp4", "old", 3, NULL), REFOCUS_OK);
    assert_int_equal(chmod("there/b.mp4", 0640), 0);
    assert_int_equal(refocus_file_temporary("b.mp4", &first, NULL), REFOCUS_OK);
    assert_int_equal(strncmp(first, "there/.refocus-", 15), 0);
    assert_int_equal(stat(first, &facts), 0);
    assert_int_equal(facts.st_mode & 0777, 0640);
    assert_int_equal(refocus_file_move(first, "b.mp4", NULL), REFOCUS_OK);
    assert_int_equal(readlink("b.mp4", text, sizeof text), sizeof text);
    assert_int_equal(stat("there/b.mp4", &facts), 0);
    assert_int_equal(facts.st_size, 0);
    free(first);
    assert_int_equal(unlink("there/b.mp4"), 0);
    assert_int_equal(unlink("b.mp4"), 0);
    assert_int_equal(rmdir("there"), 0);
    assert_int_equal(refocus_file_temporary("none/b.mp4", &first, NULL), REFOCUS_ERR_IO);
    assert_null(first);
}
