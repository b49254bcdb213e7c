/* test_replay.c: the scripted camera: every fault, and the promises that hold through all of
 * them. */
#include "check.h"
#include "../../clock.h"

#include <math.h>
#include <pthread.h>

static const struct refocus_frame *next(struct refocus_source *source)
{
    const struct refocus_frame *frame = NULL;
    struct refocus_reason reason;
    const int status = refocus_source_wait(source, 2000, &frame, &reason);

    if (status != REFOCUS_OK)
        fail_msg("no frame: %d %s", status, reason.text);
    return frame;
}

static struct refocus_source_counters counters(const struct refocus_source *source)
{
    struct refocus_source_counters c = refocus_source_counters_default();

    refocus_source_get_counters(source, &c);
    return c;
}

TEST(frames_come_at_their_pace)
{
    struct refocus_source *source = started("replay::size 64x48;fps 100;frames 20", 0);
    const struct refocus_frame *frame;
    const double begin = now_ms();

    for (uint32_t i = 0; i < 20; i++) {
        frame = next(source);
        assert_int_equal(frame->format, REFOCUS_FRAME_NV12);
        assert_int_equal(frame->width, 64);
        assert_true(frame->flags & REFOCUS_FRAME_MONOTONIC);
        refocus_source_release(source, frame);
    }
    assert_true(now_ms() - begin >= 180);
    assert_status(refocus_source_wait(source, 100, &frame, NULL), REFOCUS_ERR_END);
    assert_null(frame);
    refocus_source_close(&source);
    assert_null(source);
}

TEST(drops_and_flags_are_seen)
{
    struct refocus_source *source =
        started("replay::size 64x48;sequence 4294967290;frames 30;at 3 drop 2;at 8 corrupt;"
                "at 12 timestamp -500",
                REFOCUS_SOURCE_FAST);
    const struct refocus_frame *frame;
    int64_t before = INT64_MIN;
    int corrupt = 0, backwards = 0, n = 0;

    while (refocus_source_wait(source, 100, &frame, NULL) == REFOCUS_OK) {
        corrupt += (frame->flags & REFOCUS_FRAME_CORRUPT) != 0;
        backwards += frame->timestamp_ns < before;
        before = frame->timestamp_ns;
        n++;
        refocus_source_release(source, frame);
    }
    assert_int_equal(n, 28);
    assert_int_equal(corrupt, 1);
    assert_int_equal(backwards, 1);
    assert_int_equal(counters(source).dropped, 2);
    assert_int_equal(counters(source).corrupt, 1);
    refocus_source_close(&source);
}

TEST(formats_and_strides_change)
{
    struct refocus_source *source = started(
        "replay::size 64x48;frames 9;at 3 format YUYV,32x20;at 6 stride 77", REFOCUS_SOURCE_FAST);

    for (int i = 0; i < 9; i++) {
        const struct refocus_frame *frame = next(source);

        assert_int_equal(frame->format, i < 3 ? REFOCUS_FRAME_NV12 : REFOCUS_FRAME_YUYV);
        assert_int_equal(frame->width, i < 3 ? 64 : 32);
        assert_int_equal(frame->stride[0], i < 6 ? 64 : 77);
        assert_int_equal(!!(frame->flags & REFOCUS_FRAME_CHANGED), i == 3 || i == 6);
        refocus_source_release(source, frame);
    }
    refocus_source_close(&source);
}

TEST(a_device_returns_within_a_second)
{
    struct refocus_source *source = started("replay::size 64x48;fps 100;at 5 vanish 300", 0);
    const struct refocus_frame *frame;
    double gone, back;
    int status;

    for (int i = 0; i < 5; i++)
        refocus_source_release(source, next(source));
    assert_status(refocus_source_wait(source, 1000, &frame, NULL), REFOCUS_ERR_GONE);
    assert_null(frame);
    gone = now_ms();
    assert_status(refocus_source_restart(source, NULL, NULL), REFOCUS_ERR_GONE);
    assert_status(refocus_source_wait(source, 100, &frame, NULL), REFOCUS_ERR_STATE);
    while ((status = refocus_source_restart(source, NULL, NULL)) != REFOCUS_OK) {
        assert_status(status, REFOCUS_ERR_GONE);
        assert_true(now_ms() - gone < 2000);
        sleep_ms(20);
    }
    refocus_source_release(source, next(source));
    back = now_ms();
    assert_true(back - gone >= 290);
    assert_true(back - (gone + 300) < 1000);
    assert_int_equal(counters(source).restarts, 1);
    refocus_source_close(&source);
}

TEST(a_failed_stream_restarts)
{
    struct refocus_source *source =
        started("replay::size 64x48;frames 20;at 5 fail;at 9 memory", REFOCUS_SOURCE_FAST);
    const struct refocus_frame *frame;
    int n = 0, failed = 0, memory = 0, status;

    while ((status = refocus_source_wait(source, 100, &frame, NULL)) != REFOCUS_ERR_END) {
        if (status == REFOCUS_ERR_IO) {
            failed++;
            assert_status(refocus_source_wait(source, 100, &frame, NULL), REFOCUS_ERR_IO);
            assert_status(refocus_source_restart(source, NULL, NULL), REFOCUS_OK);
        } else if (status == REFOCUS_ERR_MEMORY) {
            memory++;
        } else {
            assert_status(status, REFOCUS_OK);
            n++;
            refocus_source_release(source, frame);
        }
    }
    assert_int_equal(failed, 1);
    assert_int_equal(memory, 1);
    assert_int_equal(n, 18);
    refocus_source_close(&source);
}

TEST(start_errors_pass)
{
    struct refocus_source *source = NULL;

    assert_status(refocus_source_open(&source, "replay::start-errors 2", NULL), REFOCUS_OK);
    assert_status(refocus_source_start(source, NULL, NULL, NULL), REFOCUS_ERR_IO);
    assert_status(refocus_source_restart(source, NULL, NULL), REFOCUS_ERR_IO);
    assert_status(refocus_source_restart(source, NULL, NULL), REFOCUS_OK);
    assert_status(refocus_source_start(source, NULL, NULL, NULL), REFOCUS_ERR_STATE);
    refocus_source_close(&source);
}

TEST(lost_buffers_are_counted)
{
    struct refocus_source *source =
        started("replay::size 64x48;at 2 queue-error;at 4 queue-error;at 6 queue-error",
                REFOCUS_SOURCE_FAST);
    const struct refocus_frame *frame;

    for (int i = 0; i < 7; i++)
        refocus_source_release(source, next(source));
    /* One of four is left: less than a stream needs. */
    assert_status(refocus_source_wait(source, 100, &frame, NULL), REFOCUS_ERR_IO);
    assert_int_equal(counters(source).lost, 3);
    assert_int_equal(counters(source).queued, 4);
    assert_status(refocus_source_restart(source, NULL, NULL), REFOCUS_OK);
    refocus_source_release(source, next(source));
    refocus_source_close(&source);
}

TEST(every_buffer_out_is_a_state)
{
    struct refocus_source *source = started("replay::size 64x48", REFOCUS_SOURCE_FAST);
    const struct refocus_frame *frame[5];

    for (int i = 0; i < 4; i++)
        frame[i] = next(source);
    assert_status(refocus_source_wait(source, 10, &frame[4], NULL), REFOCUS_ERR_STATE);
    refocus_source_release(source, frame[2]);
    refocus_source_release(source, frame[2]); /* twice is once */
    frame[2] = next(source);
    assert_status(refocus_source_wait(source, 10, &frame[4], NULL), REFOCUS_ERR_STATE);
    refocus_source_close(&source);
}

static void *interrupt(void *source)
{
    sleep_ms(50);
    refocus_source_interrupt(source);
    return NULL;
}

TEST(another_thread_stops_it)
{
    struct refocus_source *source = started("replay::size 64x48;fps 100;at 3 stall 60000", 0);
    const struct refocus_frame *frame;
    const double begin = now_ms();
    pthread_t thread;

    for (int i = 0; i < 4; i++)
        refocus_source_release(source, next(source));
    assert_int_equal(pthread_create(&thread, NULL, interrupt, source), 0);
    assert_status(refocus_source_wait(source, 30000, &frame, NULL), REFOCUS_ERR_CANCELLED);
    assert_true(now_ms() - begin < 5000);
    assert_status(refocus_source_wait(source, 30000, &frame, NULL), REFOCUS_ERR_CANCELLED);
    assert_status(refocus_source_restart(source, NULL, NULL), REFOCUS_ERR_CANCELLED);
    pthread_join(thread, NULL);
    assert_status(refocus_source_start(source, NULL, NULL, NULL), REFOCUS_OK);
    assert_status(refocus_source_wait(source, 20, &frame, NULL), REFOCUS_ERR_TIMEOUT);
    refocus_source_close(&source);
}

/* A number from the environment, for slow builds. */
static int number(const char *name, int usual)
{
    const char *text = getenv(name);

    return text && atoi(text) > 0 ? atoi(text) : usual;
}

TEST(opening_and_closing_leaks_nothing)
{
    const int cycles = number("REFOCUS_CYCLES", 10000);
    int fds = 0, threads = 0, mappings = 0;

    for (int i = 0; i < cycles; i++) {
        struct refocus_source *source = started("replay::size 16x8", REFOCUS_SOURCE_FAST);

        if (i & 1)
            refocus_source_release(source, next(source));
        else
            next(source); /* still out at the end */
        if (i & 2)
            refocus_source_stop(source);
        refocus_source_close(&source);
        if (i == 50) {
            fds = count_entries("fd");
            threads = count_entries("task");
            mappings = count_mappings();
        }
    }
    assert_int_equal(count_entries("fd"), fds);
    assert_int_equal(count_entries("task"), threads);
    assert_true(count_mappings() <= mappings + 2);
}

TEST(faults_lose_no_buffer)
{
    const int frames = number("REFOCUS_FRAMES", 200000);
    struct refocus_source *source;
    struct refocus_source_counters c;
    const struct refocus_frame *frame;
    uint64_t gone = 0, failed = 0, timeouts = 0;
    char name[128];
    int status, fds = 0, mappings = 0;

    snprintf(name, sizeof name, "replay::size 16x8;random 1;seed 7;frames %d", frames);
    source = started(name, REFOCUS_SOURCE_FAST);
    for (uint64_t n = 0;; n++) {
        status = refocus_source_wait(source, 1000, &frame, NULL);
        if (status == REFOCUS_ERR_END)
            break;
        if (status == REFOCUS_OK) {
            assert_true(frame->plane[0][frame->stride[0] * (frame->height - 1)] > 0);
            refocus_source_release(source, frame);
        } else if (status == REFOCUS_ERR_GONE || status == REFOCUS_ERR_IO) {
            gone += status == REFOCUS_ERR_GONE;
            failed += status == REFOCUS_ERR_IO;
            while (refocus_source_restart(source, NULL, NULL) == REFOCUS_ERR_GONE)
                sleep_ms(1);
        } else {
            assert_status(status, REFOCUS_ERR_TIMEOUT);
            timeouts++;
        }
        if (n == 1000) {
            fds = count_entries("fd");
            mappings = count_mappings();
        }
    }
    assert_int_equal(count_entries("fd"), fds);
    assert_true(count_mappings() <= mappings + 2);
    refocus_source_stop(source);
    c = counters(source);
    printf("%llu frames, %llu dropped, %llu corrupt, %llu gone, %llu failed, %llu restarts\n",
           (unsigned long long)c.frames, (unsigned long long)c.dropped,
           (unsigned long long)c.corrupt, (unsigned long long)gone, (unsigned long long)failed,
           (unsigned long long)c.restarts);
    assert_true(c.frames > (uint64_t)frames * 98 / 100);
    assert_int_equal(c.frames, c.released);
    assert_int_equal(c.frames, c.dequeued);
    assert_int_equal(c.dequeued, c.queued + c.lost);
    assert_int_equal(c.restarts, gone + failed);
    assert_true(c.dropped > 0 && c.corrupt > 0 && gone > 0 && failed > 0 && c.lost > 0);
    assert_true(c.lost < (uint64_t)frames / 400);
    assert_int_equal(timeouts, 0);
    refocus_source_close(&source);
}

/* Pictures lens-0.ppm to lens-2.ppm, each of one colour. */
static void write_stack(void)
{
    for (int k = 0; k < 3; k++) {
        char name[16];
        FILE *file;

        snprintf(name, sizeof name, "lens-%d.ppm", k);
        file = fopen(name, "wb");
        assert_non_null(file);
        fprintf(file, "P6\n16 16\n255\n");
        for (int i = 0; i < 3 * 16 * 16; i++)
            fputc(100 * k, file);
        assert_int_equal(fclose(file), 0);
    }
}

/* Takes a frame; returns the number of its picture. */
static int look(struct refocus_source *source, double *position)
{
    struct refocus_source_lens lens = refocus_source_lens_default();
    const struct refocus_frame *frame = next(source);
    const int picture = frame->plane[0][0] / 100;
    const double reported = (double)frame->lens_dioptres;

    refocus_source_release(source, frame);
    assert_status(refocus_source_get_lens(source, &lens, NULL), REFOCUS_OK);
    assert_true(fabs(lens.position - reported) < 1e-6);
    *position = lens.position;
    return picture;
}

#define LENS_SCRIPT "replay::stack lens-%d.ppm 3;lens 0 4;"

TEST(a_lens_is_slow_sticks_and_errs)
{
    struct refocus_source_lens lens = refocus_source_lens_default();
    struct refocus_reason reason;
    struct refocus_source *source;
    double position;

    write_stack();
    source =
        started(LENS_SCRIPT "lens-speed 0.5;lens-stop 2.5;lens-error 0.25", REFOCUS_SOURCE_FAST);
    assert_status(refocus_source_get_lens(source, &lens, &reason), REFOCUS_OK);
    assert_int_equal(lens.modes, 15);
    assert_true(lens.dioptres && lens.least == 0 && lens.greatest == 4 && isnan(lens.position));
    assert_int_equal(look(source, &position), 0);
    assert_true(position == 0.25);
    assert_status(refocus_source_set_focus(source, REFOCUS_SOURCE_FOCUS_FIXED, 4, &reason),
                  REFOCUS_OK);
    for (int i = 1; i <= 8; i++) {
        const double at = 0.5 * (i < 5 ? i : 5);

        assert_int_equal(look(source, &position), at < 1 ? 0 : at < 3 ? 1 : 2);
        assert_true(position == at + 0.25);
    }
    refocus_source_stop(source);
    assert_status(refocus_source_start(source, NULL, NULL, &reason), REFOCUS_OK);
    assert_int_equal(look(source, &position), 1);
    for (int i = 0; i < 2; i++)
        assert_status(refocus_source_set_focus(source, REFOCUS_SOURCE_FOCUS_FIXED,
                                               (double[]){4.01, (double)NAN}[i], &reason),
                      REFOCUS_ERR_ARGUMENT);
    assert_status(refocus_source_set_focus(source, REFOCUS_SOURCE_FOCUS_COUNT, 1, &reason),
                  REFOCUS_ERR_ARGUMENT);
    assert_status(refocus_source_set_focus(source, REFOCUS_SOURCE_FOCUS_ONCE, 9, &reason),
                  REFOCUS_OK);
    for (int i = 0; i < 8; i++)
        look(source, &position);
    assert_true(position == 2 + 0.25); /* the middle is the subject */
    assert_status(refocus_source_set_focus(source, REFOCUS_SOURCE_FOCUS_FIXED, 0, &reason),
                  REFOCUS_OK);
    look(source, &position);
    assert_status(refocus_source_set_focus(source, REFOCUS_SOURCE_FOCUS_OFF, 9, &reason),
                  REFOCUS_OK);
    assert_int_equal(look(source, &position), 1);
    assert_true(position == 1.5 + 0.25); /* the lens stops on its way, also when told twice */
    assert_status(refocus_source_restart(source, NULL, &reason), REFOCUS_OK);
    look(source, &position);
    assert_true(position == 1.5 + 0.25);
    assert_status(refocus_source_lock_exposure(source, 1, &reason), REFOCUS_OK);
    refocus_source_close(&source);
}

TEST(no_lens_moves_without_one)
{
    struct refocus_source_lens lens = refocus_source_lens_default();
    struct refocus_source *source = started("replay::size 16x12", REFOCUS_SOURCE_FAST);
    struct refocus_reason reason;

    assert_status(refocus_source_get_lens(source, &lens, NULL), REFOCUS_OK);
    assert_int_equal(lens.modes, 0);
    assert_status(refocus_source_set_focus(source, REFOCUS_SOURCE_FOCUS_FIXED, 0, &reason),
                  REFOCUS_ERR_UNSUPPORTED);
    assert_string_equal(reason.text, "its lens does not move");
    refocus_source_close(&source);
    assert_status(refocus_source_open(&source, "replay::stack lens-9%d.ppm 3", &reason),
                  REFOCUS_ERR_GONE);
    assert_status(refocus_source_open(&source, "replay::stack lens.ppm 3", &reason),
                  REFOCUS_ERR_FORMAT);
    assert_status(refocus_source_open(&source, "replay::lens 4 2", &reason), REFOCUS_ERR_FORMAT);
    source = started("file:lens-%d.ppm", REFOCUS_SOURCE_FAST);
    assert_status(refocus_source_lock_exposure(source, 1, &reason), REFOCUS_ERR_UNSUPPORTED);
    refocus_source_close(&source);
}
