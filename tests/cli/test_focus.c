/* test_focus.c: focus pulls of `refocus live`, by the times of frames: smooth, and without a
 * jump also when one begins before the other has ended. */
#include <math.h>
#include <stdint.h>
#include "unit_test.h"
#include <string.h>
#include "live/live_focus.h"

static int64_t now;
static struct live_range range; /* range of the frames: not known */

static void begin(struct live_focus *focus, double disparity)
{
    struct lens_settings lens = LENS_SETTINGS_NONE;

    now = 5000000000;
    lens.focus = disparity;
    live_focus_init(focus, &lens);
    focus->blur = 8;
    focus->blur_most = 16;
}

/* The focus in a frame of now; where a point is asked for, 0.25 is there. */
static double look(struct live_focus *focus)
{
    struct live_range of_frame = range;
    double disparity, blur, point[2];

    live_focus_frame(focus, now, (double)NAN, &of_frame);
    while (live_focus_point(focus, point))
        live_focus_found(focus, point, 0.25);
    live_focus_get(focus, &disparity, &blur);
    return disparity;
}

static void command(struct live_focus *focus, const char *line)
{
    char why[200] = "";
    bool quit = false;

    if (!live_focus_command(focus, line, &quit, why, sizeof why) || quit)
        fail_msg("%s: %s", line, why);
}

/* The focus is watched at 1000 frames a second for so long: it moves never back, and no step
 * above 1.5 times the mean one. */
static void watch(struct live_focus *focus, double to, int ms)
{
    const double from = look(focus);
    const double most = 1.5 * fabs(to - from) / ms + 1e-9;
    double before = from, first = 0;

    for (int i = 0; i < ms; i++) {
        const double step = (now += 1000000, look(focus)) - before;

        assert_true(step * (to - from) >= 0);
        assert_true(fabs(step) <= most);
        first = i == 0 ? fabs(step) : first;
        before += step;
    }
    assert_true(first < fabs(to - from) / ms / 50); /* it starts from rest */
    assert_true(fabs(before - to) < 1e-9);
}

TEST(pulls_are_smooth)
{
    struct live_focus focus;

    begin(&focus, 0.1);
    command(&focus, "pull 0.9 2");
    assert_true(fabs(look(&focus) - 0.1) < 1e-12);
    watch(&focus, 0.9, 2000);
    now += 60000000000;
    assert_true(look(&focus) == 0.9);
    command(&focus, "pull 0 0.5");
    watch(&focus, 0, 500);
    pthread_mutex_destroy(&focus.lock);
}

TEST(one_takes_over_from_another)
{
    struct live_focus focus;
    double at;

    begin(&focus, 0);
    look(&focus);
    command(&focus, "pull 1 2");
    look(&focus);
    now += 900000000;
    at = look(&focus);
    assert_true(at > 0.3 && at < 0.5);
    command(&focus, "pull 0.2 1");
    assert_true(fabs(look(&focus) - at) < 1e-12);
    watch(&focus, 0.2, 1000);
    command(&focus, "focus 0.7"); /* at once */
    assert_true(look(&focus) == 0.7);
    pthread_mutex_destroy(&focus.lock);
}

TEST(points_are_asked_for_once)
{
    struct live_focus focus;
    double point[2];

    begin(&focus, 0.5);
    assert_false(live_focus_point(&focus, point));
    look(&focus);
    command(&focus, "pull-at 12,34 1");
    assert_true(live_focus_point(&focus, point));
    assert_true(point[0] == 12 && point[1] == 34);
    live_focus_found(&focus, (double[2]){1, 2}, 0.7); /* point of another command */
    assert_true(live_focus_point(&focus, point));
    live_focus_found(&focus, point, 1);
    assert_false(live_focus_point(&focus, point));
    watch(&focus, 1, 1000);
    command(&focus, "focus-at 1,2");
    assert_true(live_focus_point(&focus, point));
    live_focus_found(&focus, point, (double)NAN); /* nothing is there */
    assert_true(look(&focus) == 0);
    pthread_mutex_destroy(&focus.lock);
}

/* A command before the first frame holds from it on, and a pull begins there. */
TEST(commands_before_the_first_frame_are_kept)
{
    struct live_focus focus;

    begin(&focus, (double)NAN); /* the centre, where 0.25 is */
    assert_true(look(&focus) == 0.25);
    begin(&focus, (double)NAN);
    command(&focus, "focus 0.8");
    assert_true(look(&focus) == 0.8);
    now += 1000000000;
    assert_true(look(&focus) == 0.8);
    begin(&focus, (double)NAN);
    command(&focus, "pull 0.75 2"); /* from the centre */
    now += 3000000000;
    assert_true(look(&focus) == 0.25);
    watch(&focus, 0.75, 2000);
    begin(&focus, 0.5);
    command(&focus, "focus-at 3,4");
    command(&focus, "pull 1 1");
    command(&focus, "pull 0.75 1");
    assert_true(look(&focus) == 0.25);
    watch(&focus, 0.75, 1000);
    pthread_mutex_destroy(&focus.lock);
}

/* A point is a distance from then on, and so is where a pull is taken over; a disparity is none. */
TEST(distances_stay_while_the_range_moves)
{
    struct live_focus focus;
    double at;

    range = (struct live_range){0.5, 0.25};
    begin(&focus, (double)NAN);
    assert_true(look(&focus) == 0.25); /* 0.3125 dioptres */
    range.near = 1;
    assert_true(fabs(look(&focus) - 0.0625 / 0.75) < 1e-12);
    command(&focus, "focus 0.5");
    assert_true(look(&focus) == 0.5);
    command(&focus, "pull 1 1");
    look(&focus);
    now += 500000000;
    at = look(&focus) * 0.75 + 0.25;
    command(&focus, "pull-at 1,1 1"); /* 0.6875 dioptres in the next frame */
    range.near = 2;
    assert_true(fabs(look(&focus) * 1.75 + 0.25 - at) < 1e-12);
    now += 2000000000;
    assert_true(look(&focus) == 0.25);
    range.near = 1;
    assert_true(fabs(look(&focus) * 0.75 + 0.25 - 0.6875) < 1e-12);
    range = (struct live_range){0, 0};
    pthread_mutex_destroy(&focus.lock);
}

TEST(the_camera_s_lens_is_followed)
{
    struct live_focus focus;
    double disparity, blur;

    range = (struct live_range){1, 0.2};
    begin(&focus, (double)NAN);
    for (int i = 0; i < 3; i++) {
        live_focus_frame(&focus, now += 1000000, i == 1 ? 0.6 : 0.4, &range);
        live_focus_get(&focus, &disparity, &blur);
        assert_true(fabs(disparity - (i == 1 ? 0.5 : 0.25)) < 1e-12);
    }
    live_focus_frame(&focus, now, 7, &range); /* nearer than all there is */
    live_focus_get(&focus, &disparity, &blur);
    assert_true(disparity == 1);
    command(&focus, "focus 0.1");
    live_focus_frame(&focus, now, 0.4, &range);
    live_focus_get(&focus, &disparity, &blur);
    assert_true(disparity == 0.1);
    range = (struct live_range){0, 0};
    pthread_mutex_destroy(&focus.lock);
}

TEST(points_lie_in_the_picture)
{
    static const char *const outside[] = {"focus-at 64,3",
                                          "pull-at 3,48 1",
                                          "focus-at -1,0",
                                          "focus-at 0,-0.5",
                                          "focus-rectangle 0,0,64,49",
                                          "focus-rectangle 1,1,9,0.5"};
    static const char *const wrong[] = {"pull 0.5 -1", "pull 0.5 3601", "pull 0.5 nan",
                                        "focus-at 1;2", "focus 0,5"};
    struct live_focus focus;
    double point[2];

    begin(&focus, 0.5);
    command(&focus, "focus-at 9999,9"); /* no picture yet: its edge serves */
    assert_true(live_focus_point(&focus, point));
    look(&focus);
    live_focus_size(&focus, 64, 48);
    command(&focus, "focus-at 63,47");
    assert_true(live_focus_point(&focus, point));
    look(&focus);
    for (int i = 0; i < 6; i++) {
        char why[200] = "";
        bool quit = false;

        assert_false(live_focus_command(&focus, outside[i], &quit, why, sizeof why));
        assert_non_null(strstr(why, "64x48"));
        assert_false(live_focus_point(&focus, point));
    }
    for (int i = 0; i < 5; i++) {
        char why[200] = "";
        bool quit = false;

        assert_false(live_focus_command(&focus, wrong[i], &quit, why, sizeof why));
        assert_non_null(strstr(why, "cannot be used; give "));
        assert_true((strstr(why, "0 to 3600 seconds") != NULL) ==
                    (strncmp(wrong[i], "pull", 4) == 0));
    }
    pthread_mutex_destroy(&focus.lock);
}

/* A rectangle is its middle until it is followed. */
TEST(rectangles_have_a_middle)
{
    static const char *const other[] = {"focus-at 3,4", "focus 0.5"};
    struct live_focus focus;
    double point[2], box[4];
    uint64_t asked;

    begin(&focus, 0.5);
    live_focus_size(&focus, 64, 48);
    for (int i = 0; i < 2; i++) {
        command(&focus, "focus-rectangle 0,0,64,48");
        look(&focus);
        command(&focus, "focus-rectangle 10,20,30,20");
        assert_true(live_focus_point(&focus, point) && live_focus_rectangle(&focus, box, &asked));
        assert_true(point[0] == 25 && point[1] == 30);
        command(&focus, other[i]); /* It is followed no more. */
        assert_false(live_focus_rectangle(&focus, box, &asked));
    }
    pthread_mutex_destroy(&focus.lock);
}

/* The range of a frame takes in the distance in focus, nearer or farther than what there is. */
TEST(the_range_takes_in_the_focus)
{
    static const double metres[] = {0.5, 8, 3};

    for (int i = 0; i < 3; i++) {
        struct live_range of_frame = {0.5, 0.25};
        struct lens_settings lens = LENS_SETTINGS_NONE;
        struct live_focus focus;

        lens.focus_distance = metres[i];
        live_focus_init(&focus, &lens);
        live_focus_frame(&focus, now, (double)NAN, &of_frame);
        assert_true(of_frame.near == (i == 0 ? 2 : 0.5) && of_frame.far == (i == 1 ? 0.125 : 0.25));
        lens = (struct lens_settings)LENS_SETTINGS_NONE; /* A lens may be set beyond infinity. */
        live_focus_init(&focus, &lens);
        live_focus_frame(&focus, now, -0.5, &of_frame);
        assert_true(of_frame.far == 0);
        pthread_mutex_destroy(&focus.lock);
    }
}
