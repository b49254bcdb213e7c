/* test_touch.c: the window without a screen (SDL's dummy driver), worked by events of a touch
 * screen: SDL makes a mouse of the first finger, and tells of two as gestures. */
#include "unit_test.h"
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <SDL.h>
#include "view.h"

enum { W = 400, H = 300 };

static void push_mouse(Uint32 type, int x, int y)
{
    SDL_Event event;

    memset(&event, 0, sizeof event);
    event.type = type;
    if (type == SDL_MOUSEMOTION) {
        event.motion.which = SDL_TOUCH_MOUSEID;
        event.motion.x = x;
        event.motion.y = y;
    } else {
        event.button.which = SDL_TOUCH_MOUSEID;
        event.button.button = SDL_BUTTON_LEFT;
        event.button.x = x;
        event.button.y = y;
    }
    SDL_PushEvent(&event);
}

static void push_pinch(float x, float y, float spread)
{
    SDL_Event event;

    memset(&event, 0, sizeof event);
    event.type = SDL_MULTIGESTURE;
    event.mgesture.x = x;
    event.mgesture.y = y;
    event.mgesture.dDist = spread;
    event.mgesture.numFingers = 2;
    SDL_PushEvent(&event);
}

static void push_key(SDL_Keycode key)
{
    SDL_Event event;

    memset(&event, 0, sizeof event);
    event.type = SDL_KEYDOWN;
    event.key.keysym.sym = key;
    SDL_PushEvent(&event);
}

/* Whether all that was asked for has been shown. */
static bool answered(const struct rf_view_report *report)
{
    for (int i = 0; i < report->count; i++)
        if (report->times[i].first_ms < 0)
            return false;
    return report->count > 0;
}

struct fingers {
    const struct rf_view_report *report;
    int step;
};

static void push_finger_up(void)
{
    SDL_Event event;

    memset(&event, 0, sizeof event);
    event.type = SDL_FINGERUP;
    SDL_PushEvent(&event);
}

/* Two fingers move, a step whenever the window is at rest: it is polled in its loop. */
static int move_fingers(void *user)
{
    struct fingers *const fingers = user;

    if (!answered(fingers->report))
        return 0;
    switch (fingers->step++) {
    case 0: /* a tap on the nearer half */
        push_mouse(SDL_MOUSEBUTTONDOWN, 100, 80);
        push_mouse(SDL_MOUSEBUTTONUP, 100, 80);
        break;
    case 2: /* the first of two: no tap, no aperture */
        push_mouse(SDL_MOUSEBUTTONDOWN, 200, 100);
        push_pinch(0.5f, 0.5f, 0);
        for (int i = 0; i < 5; i++) {
            push_mouse(SDL_MOUSEMOTION, 200 - 10 * i, 100);
            push_pinch(0.5f, 0.5f, 0.1f);
        }
        push_mouse(SDL_MOUSEBUTTONUP, 160, 100);
        push_finger_up();
        break;
    case 4: /* a tap on the help closes it and focuses nowhere */
        push_key(SDLK_h);
        push_mouse(SDL_MOUSEBUTTONDOWN, 300, 80);
        push_mouse(SDL_MOUSEBUTTONUP, 300, 80);
        push_key(SDLK_h);
        push_key(SDLK_ESCAPE);
        break;
    case 6: /* ended with the help closed */
        push_key(SDLK_ESCAPE);
        break;
    default:
        break;
    }
    return 0;
}

static void no_save(void *user, const struct rf_view_result *result, char words[RF_VIEW_WORDS])
{
    (void)user;
    (void)result;
    (void)words;
    fail();
}

TEST(test_two_fingers)
{
    static uint8_t pixels[3 * W * H];
    static uint16_t depth[W * H];
    struct refocus_image photo = refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, W, H, 3 * W);
    struct rf_view_setup setup;
    struct rf_view_report *const report = calloc(1, sizeof *report);
    struct fingers fingers = {report, 0};
    char reason[256] = "";

    assert_non_null(report);
    for (int i = 0; i < W * H; i++) {
        depth[i] = i % W < W / 2 ? 40000 : 3000;
        pixels[3 * i] = (uint8_t)(i * 7);
    }
    memset(&setup, 0, sizeof setup);
    setup.session.photo = &photo;
    setup.session.disparity = depth;
    setup.session.params = refocus_settings_default(0, 0);
    setup.session.save = no_save;
    setup.state.blur = 6;
    setup.title = "test";
    setup.width = W;
    setup.height = H;
    setup.quit_after_ms = 100000;
    setup.stop = move_fingers;
    setup.stop_user = &fingers;
    setenv("SDL_VIDEODRIVER", "dummy", 1);
    assert_int_equal(rf_view_run(&setup, report, reason), REFOCUS_OK);
    assert_string_equal(reason, "");
    assert_string_equal(report->driver, "dummy");
    assert_true(fabs((double)report->last.focus - 40000 / 65535.0) < 1e-3);
    assert_true(report->last.blur >= 6 && report->last.blur <= 6);
    assert_int_equal(report->last.focus_tap, 1);
    assert_true(fabs(report->last.scale - exp(1.0)) < 1e-3); /* five times a tenth, twice over */
    assert_true(fingers.step > 6);
    assert_true(report->count > 3 && report->times[0].first_ms > 0);
    free(report);
}

TEST(test_no_display)
{
    static uint8_t pixel[3];
    struct refocus_image photo = refocus_image_packed(REFOCUS_FORMAT_RGB8, pixel, 1, 1, 3);
    struct rf_view_setup setup;
    struct rf_view_report *const report = calloc(1, sizeof *report);
    char reason[256] = "";

    assert_non_null(report);
    memset(&setup, 0, sizeof setup);
    setup.session.photo = &photo;
    setup.title = "test";
    setenv("SDL_VIDEODRIVER", "no such driver", 1);
    assert_true(rf_view_run(&setup, report, reason) < 0);
    assert_memory_equal(reason, "no display can be opened: ", 26);
    free(report);
}
