/* test_window.c: the window sink, on SDL's driver without a screen; tests/cli/test_window.py
 * looks at pixels. */
#include "check.h"

#include <time.h>
#include <SDL.h>
#include <refocus/platform/sink.h>

enum { MOST = 96 };
static uint8_t pixels[MOST * MOST * 3];

static struct refocus_image picture(int width, int height)
{
    memset(pixels, width, sizeof pixels);
    return refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, width, height, width * 3);
}

static struct refocus_sink *opened(void)
{
    struct refocus_sink *sink = NULL;
    struct refocus_reason reason;

    if (refocus_sink_open(&sink, "window", &reason) != REFOCUS_OK)
        fail_msg("%s", reason.text);
    return sink;
}

static int write_one(struct refocus_sink *sink, int width, int height)
{
    const struct refocus_image image = picture(width, height);

    assert_status(refocus_sink_start(sink, width, height, 30, NULL), REFOCUS_OK);
    return refocus_sink_write(sink, &image, NULL);
}

TEST(frames_of_any_size_are_shown)
{
    struct refocus_sink *sink = opened();

    for (int i = 0; i < 30; i++)
        assert_status(write_one(sink, 16 + i / 10 * 40, 96 - i / 10 * 40), REFOCUS_OK);
    assert_status(refocus_sink_start(sink, 65535, 65535, 30, NULL), REFOCUS_ERR_UNSUPPORTED);
    assert_status(refocus_sink_close(&sink, NULL), REFOCUS_OK);
}

/* Frames, until the event is seen; a second at most. */
static int until_end(struct refocus_sink *sink, SDL_Event *event)
{
    const struct timespec pause = {0, 5000000};
    int status = REFOCUS_OK;

    assert_status(write_one(sink, 32, 32), REFOCUS_OK);
    assert_int_equal(SDL_PushEvent(event), 1);
    for (int i = 0; i < 1000 && status == REFOCUS_OK; i++) {
        nanosleep(&pause, NULL);
        status = write_one(sink, 32, 32);
    }
    return status;
}

TEST(its_user_closes_it)
{
    SDL_Event events[] = {{.type = SDL_QUIT},
                          {.key = {.type = SDL_KEYDOWN, .keysym = {.sym = SDLK_ESCAPE}}},
                          {.key = {.type = SDL_KEYDOWN, .keysym = {.sym = SDLK_q}}},
                          {.window = {.type = SDL_WINDOWEVENT, .event = SDL_WINDOWEVENT_CLOSE}}};

    for (int i = 0; i < 4; i++) {
        struct refocus_sink *sink = opened();

        assert_status(until_end(sink, &events[i]), REFOCUS_ERR_END);
        assert_status(write_one(sink, 32, 32), REFOCUS_ERR_END);
        assert_status(refocus_sink_close(&sink, NULL), REFOCUS_OK);
    }
}

TEST(no_display_is_a_status)
{
    struct refocus_sink *sink = NULL;
    struct refocus_reason reason;

    setenv("SDL_VIDEODRIVER", "none-such", 1);
    assert_status(refocus_sink_open(&sink, "window", &reason), REFOCUS_ERR_GONE);
    assert_null(sink);
    assert_non_null(strstr(reason.text, "no display"));
    setenv("SDL_VIDEODRIVER", "dummy", 1);
}

TEST(cycles_leak_nothing)
{
    int fds = 0, threads = 0;

    for (int i = 0; i < 200; i++) {
        struct refocus_sink *sink = opened();

        assert_status(write_one(sink, 32, 32), REFOCUS_OK);
        assert_status(refocus_sink_close(&sink, NULL), REFOCUS_OK);
        if (i == 10) {
            fds = count_entries("fd");
            threads = count_entries("task");
        }
    }
    assert_int_equal(count_entries("fd"), fds);
    assert_int_equal(count_entries("task"), threads);
}

int main(void)
{
    setenv("SDL_VIDEODRIVER", "dummy", 1);
    return unit_test_run(NULL, NULL);
}
