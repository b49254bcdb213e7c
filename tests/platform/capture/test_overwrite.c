/* test_overwrite.c: a sink that would write over what a source reads is seen by the files, not by
 * their names. */
#include "check.h"

#include <sys/stat.h>
#include <unistd.h>
#include <refocus/platform/sink.h>

#include "failing.h"

static void write_text(const char *path, const char *text)
{
    FILE *const file = fopen(path, "wb");

    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

static const char *const files[] = {"v.y4m",       "w,NV12",      "w,NV12,4x4", "d-2.png",
                                    "s[1]-01.png", "s[1]-02.png", "s1-01.png",  "t 1.png",
                                    "a-1/x.png",   "d-12x.png"};
enum { FILES = sizeof files / sizeof *files };

static int make_files(void **state)
{
    (void)state;
    if (mkdir("overwrite", 0777) != 0 || chdir("overwrite") != 0 || mkdir("a-1", 0777) != 0)
        return -1;
    for (int i = 0; i < FILES; i++)
        write_text(files[i], "");
    write_text("script", "jpeg v.y4m\n");
    write_text("stack", "stack s[1]-%02d.png 2\n");
    return symlink("v.y4m", "link.y4m") != 0 || link("v.y4m", "other.y4m") != 0 ||
           mkfifo("pipe", 0666) != 0;
}

static int take_files(void **state)
{
    static const char *const others[] = {"script", "stack", "link.y4m", "other.y4m", "pipe"};

    (void)state;
    for (int i = 0; i < FILES; i++)
        unlink(files[i]);
    for (int i = 0; i < 5; i++)
        unlink(others[i]);
    rmdir("a-1");
    return chdir("..") != 0 || rmdir("overwrite") != 0;
}

static const struct {
    const char *sink, *input;
    int answer;
} pairs[] = {
    {"y4m:v.y4m", "y4m:v.y4m", 1},
    {"y4m:v.y4m", "y4m:./v.y4m", 1},
    {"y4m:v.y4m", "v.y4m", 1},
    {"y4m:link.y4m", "y4m:v.y4m", 1},
    {"y4m:v.y4m", "raw:other.y4m,NV12,4x4,30", 1},
    {"raw:v.y4m", "y4m:v.y4m", 1},
    {"raw:v.y4m,NV12", "y4m:v.y4m", 1},
    {"raw:w,NV12,NV12", "raw:w,NV12,NV12,4x4", 1},
    {"raw:w,NV12,NV12", "raw:w,NV12,RGB24,4x4,30", 1},
    {"d-%d.png", "d-2.png", 1},
    {"d-%d.png", "file:d-2.png", 1},
    {"./d-%d.png", "file:d-%d.png", 1},
    {"s[1]-%02d.png", "file:s[1]-%02d.png", 1},
    {"t%2d.png", "t 1.png", 1},
    {"a-%d/x.png", "file:a-1/x.png", 1},
    {"y4m:v.y4m", "replay:script", 1},
    {"y4m:script", "replay:script", 1},
    {"y4m:v.y4m", "replay::frames 2;from y4m:v.y4m", 1},
    {"s[1]-%02d.png", "replay:stack", 1},
    /* Here one is not there, is no file, or is another one. */
    {"y4m:new.y4m", "y4m:v.y4m", 0},
    {"y4m:v.y4m", "y4m:new.y4m", 0},
    {"y4m:pipe", "y4m:pipe", 0},
    {"y4m:v.y4m", "replay:pipe", 0},
    {"y4m:-", "y4m:-", 0},
    {"null", "y4m:v.y4m", 0},
    {"window", "y4m:v.y4m", 0},
    {"v4l2:d-%d.png", "d-2.png", 0},
    {"pipewire:d-%d.png", "d-2.png", 0},
    {"d-%02d.png", "d-2.png", 0},
    {"d-%d.png", "d-12x.png", 0},
    {"s[1]-%02d.png", "s1-01.png", 0},
    {"t-%02d.png", "file:s[1]-%02d.png", 0},
    {"y4m:v.y4m", "v4l2:v.y4m", 0},
    {"y4m:v.y4m", "replay::size 64x48", 0},
};
enum { PAIRS = sizeof pairs / sizeof *pairs };

TEST(pairs_of_names)
{
    for (int i = 0; i < PAIRS; i++)
        if (refocus_sink_overwrites(pairs[i].sink, pairs[i].input) != pairs[i].answer)
            fail_msg("'%s' and '%s': not %d", pairs[i].sink, pairs[i].input, pairs[i].answer);
}

/* Without memory it says so, or knows already. */
TEST(every_allocation)
{
    for (int i = 0; i < PAIRS; i++) {
        long calls;

        failing.fail_at = failing.calls = 0;
        refocus_sink_overwrites(pairs[i].sink, pairs[i].input);
        calls = failing.calls;
        for (long at = 1; at <= calls; at++) {
            const long live = failing.live;

            failing.calls = 0;
            failing.fail_at = at;
            const int answer = refocus_sink_overwrites(pairs[i].sink, pairs[i].input);
            failing.fail_at = 0;
            assert_true(answer == REFOCUS_ERR_MEMORY || (answer == 1 && pairs[i].answer == 1));
            assert_int_equal(failing.live, live);
        }
    }
}

int main(void)
{
    return unit_test_run(make_files, take_files);
}
