/* test_pipes.c: sinks whose reader goes, and sources that wait for a writer. */
#include "check.h"

#include <fcntl.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>
#include <refocus/platform/sink.h>

enum { WIDTH = 37, HEIGHT = 22 };

/* The reader of a pipe goes: a status, and no signal ends this program. */
TEST(a_closed_pipe_is_a_status)
{
    static uint8_t pixels[WIDTH * HEIGHT * 3];
    struct refocus_sink *sink = NULL;
    const struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, WIDTH, HEIGHT, WIDTH * 3);
    char name[64];
    int ends[2];

    assert_int_equal(pipe(ends), 0);
    snprintf(name, sizeof name, "raw:/proc/self/fd/%d", ends[1]);
    assert_status(refocus_sink_open(&sink, name, NULL), REFOCUS_OK);
    assert_status(refocus_sink_start(sink, WIDTH, HEIGHT, 25, NULL), REFOCUS_OK);
    assert_status(refocus_sink_write(sink, &image, NULL), REFOCUS_OK);
    close(ends[0]);
    assert_status(refocus_sink_write(sink, &image, NULL), REFOCUS_ERR_GONE);
    assert_status(refocus_sink_close(&sink, NULL), REFOCUS_OK);
    close(ends[1]);
}

/* Closes the end that is read once something has been written. */
static void *leave(void *end)
{
    const struct timespec pause = {0, 1000000};
    const int fd = *(const int *)end;
    int waiting = 0;

    while (ioctl(fd, FIONREAD, &waiting) == 0 && waiting == 0)
        nanosleep(&pause, NULL);
    nanosleep(&pause, NULL);
    close(fd);
    return NULL;
}

/* The reader goes while a frame is half written, which is more than a pipe holds. */
TEST(a_pipe_closed_within_a_frame_is_a_status)
{
    enum { SIDE = 1024 };
    uint8_t *const pixels = calloc(SIDE * SIDE, 3);
    struct refocus_sink *sink = NULL;
    const struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, SIDE, SIDE, SIDE * 3);
    char name[64];
    pthread_t thread;
    int ends[2];

    assert_non_null(pixels);
    assert_int_equal(pipe(ends), 0);
    snprintf(name, sizeof name, "raw:/proc/self/fd/%d", ends[1]);
    assert_status(refocus_sink_open(&sink, name, NULL), REFOCUS_OK);
    assert_status(refocus_sink_start(sink, SIDE, SIDE, 25, NULL), REFOCUS_OK);
    assert_int_equal(pthread_create(&thread, NULL, leave, &ends[0]), 0);
    assert_status(refocus_sink_write(sink, &image, NULL), REFOCUS_ERR_GONE);
    pthread_join(thread, NULL);
    assert_status(refocus_sink_close(&sink, NULL), REFOCUS_OK);
    close(ends[1]);
    free(pixels);
}

static atomic_bool interrupted;

/* A start forgets what came before it. */
static void *interrupt(void *source)
{
    const struct timespec pause = {0, 1000000};

    for (; !atomic_load(&interrupted); nanosleep(&pause, NULL))
        refocus_source_interrupt(source);
    return NULL;
}

/* Starts the source, or waits for a frame, while another thread interrupts it. */
static int interrupted_call(struct refocus_source *source, bool start)
{
    const struct refocus_frame *frame;
    pthread_t thread;
    int status;

    atomic_store(&interrupted, false);
    assert_int_equal(pthread_create(&thread, NULL, interrupt, source), 0);
    status = start ? refocus_source_start(source, NULL, NULL, NULL)
                   : refocus_source_wait(source, 1000, &frame, NULL);
    atomic_store(&interrupted, true);
    pthread_join(thread, NULL);
    return status;
}

/* Nobody writes, then somebody who stops within a frame: another thread ends either wait. */
TEST(a_silent_pipe_is_no_hang)
{
    const char text[] = "YUV4MPEG2 W4 H4\nFRAME\nabcdefghijklmnopqrstuvwxFRAME\nabc";
    struct refocus_source_mode mode = refocus_source_mode_default();
    struct refocus_source *source = NULL;
    const struct refocus_frame *frame;
    int writer;

    unlink("silent.y4m");
    assert_int_equal(mkfifo("silent.y4m", 0600), 0);
    assert_status(refocus_source_open(&source, "y4m:silent.y4m", NULL), REFOCUS_OK);
    assert_status(interrupted_call(source, true), REFOCUS_ERR_CANCELLED);
    writer = open("silent.y4m", O_WRONLY);
    assert_int_equal(write(writer, text, sizeof text - 1), sizeof text - 1);
    assert_status(refocus_source_start(source, NULL, &mode, NULL), REFOCUS_OK);
    assert_int_equal(mode.width, 4);
    assert_status(refocus_source_wait(source, 1000, &frame, NULL), REFOCUS_OK);
    assert_memory_equal(frame->plane[0], "abcdefghijklmnop", 16);
    refocus_source_release(source, frame);
    assert_status(interrupted_call(source, false), REFOCUS_ERR_CANCELLED);
    refocus_source_close(&source);
    close(writer);
}
