/* test_range.c: the distance range of `refocus live` over made-up depth: an empty room stays as
 * it is, who walks in gets a disparity of his own soon and without a jump, and what is in focus
 * stays so. */
#include <stdint.h>
#include <stdlib.h>
#include "unit_test.h"
#include <refocus/refocus.h>
#include "live/live_depth.h"
#include "live/live_focus.h"

enum { W = 160, H = 120, FPS = 30, WALL = 4000, FLOOR = 2500, PERSON = 1100 };
static const int64_t period_ns = 1000000000 / FPS;

struct room {
    struct live_ranger ranger;
    struct live_focus focus;
    struct refocus_depth_map map;
    uint16_t mm[W * H], disparity[W * H];
    int64_t now;
    uint32_t seed;
    double d, blur; /* focus and blur of the present frame */
    struct live_range range;
    double pace, change; /* the largest steps so far: of the range, and of the lens */
};
static struct room room;
static int wall = WALL;

static int noise(int most)
{
    room.seed = room.seed * 1664525u + 1013904223u;
    return (int)((room.seed >> 8) % (uint32_t)(2 * most + 1)) - most;
}

/* A wall and a floor with 1 % of noise, holes, and single samples that are far off; somebody
 * stands before the columns up to `person`. */
static void draw(int person)
{
    for (int i = 0; i < W * H; i++) {
        const int y = i / W, x = i % W;
        const int mm = x < person && y > 20 ? PERSON
                       : y > 80             ? wall - (wall - FLOOR) * (y - 80) / (H - 81)
                                            : wall;

        room.mm[i] = (uint16_t)(mm + noise(mm / 100));
        if (noise(50) == 0)
            room.mm[i] = (uint16_t)(noise(1) > 0 ? 300 : noise(1) > 0 ? 60000 : 0);
    }
}

/* Do with a frame of such depth what live does. */
static void look(void)
{
    const struct live_range before = room.ranger.range;
    const struct live_range was = room.range;
    const double lens = room.blur / (was.near - was.far);
    struct live_range seen;
    double point[2];

    assert_true(live_range_measure(&room.ranger, &room.map, &seen));
    live_range_follow(&room.ranger, &seen, room.now += period_ns);
    room.range = room.ranger.range;
    room.map.near_m = 1 / room.range.near;
    room.map.far_m = 1 / room.range.far;
    assert_int_equal(refocus_depth_to_disparity(&room.map, room.disparity, 2 * W, NULL),
                     REFOCUS_OK);
    live_focus_frame(&room.focus, room.now, (double)NAN, &room.range);
    while (live_focus_point(&room.focus, point))
        live_focus_found(&room.focus, point,
                         room.disparity[(int)point[1] * W + (int)point[0]] / 65535.0);
    live_focus_get(&room.focus, &room.d, &room.blur);
    if (was.near > was.far) {
        const double span = before.near - before.far;
        const double near = fabs(room.ranger.range.near - before.near) / span;
        const double far = fabs(room.ranger.range.far - before.far) / span;
        const double now = room.blur / (room.range.near - room.range.far);

        room.pace = fmax(room.pace, fmax(near, far));
        room.change = fmax(room.change, fabs(log(now / lens)));
    }
}

static void begin(double near_m, double far_m)
{
    struct lens_settings lens = LENS_SETTINGS_NONE;

    live_range_end(&room.ranger);
    memset(&room, 0, sizeof room);
    live_range_begin(&room.ranger, near_m, far_m);
    lens.focus_at[0] = W - 10; /* the wall */
    lens.focus_at[1] = 30;
    live_focus_init(&room.focus, &lens);
    room.focus.blur = 10;
    room.focus.blur_most = 120;
    room.map = (struct refocus_depth_map){.struct_size = sizeof(struct refocus_depth_map),
                                          .samples = room.mm,
                                          .width = W,
                                          .height = H,
                                          .stride = 2 * W,
                                          .sample = REFOCUS_SAMPLE_U16};
    assert_int_equal(refocus_depth_set_unit(&room.map, "mm"), REFOCUS_OK);
    room.now = 77000000000;
}

static void watch(double seconds, int person)
{
    for (int i = 0; i < seconds * FPS; i++) {
        draw(person);
        look();
    }
}

/* The mean disparity of a place where one distance is. */
static double mean_at(int x, int y)
{
    double sum = 0;

    for (int i = 0; i < 64; i++)
        sum += room.disparity[(y + i / 8) * W + x + i % 8];
    return sum / 64 / 65535;
}

/* The distance at a place by the map. */
static double dioptres_at(int x, int y)
{
    return room.ranger.range.far + mean_at(x, y) * (room.ranger.range.near - room.ranger.range.far);
}

static double in_focus(void)
{
    return room.range.far + room.d * (room.range.near - room.range.far);
}

TEST(a_still_scene_stays_still)
{
    begin(0, 0);
    watch(20, 0);
    assert_true(room.pace == 0);
    assert_true(room.change < 1e-12);
    assert_true(fabs(1 / room.range.near - 2.5) < 0.06);
    assert_true(fabs(1 / room.range.far - 4) < 0.09);
    /* Somebody who stands there, too. */
    begin(0, 0);
    watch(20, 60);
    assert_true(room.pace == 0);
    assert_true(fabs(1 / room.range.near - 1.1) < 0.02);
    assert_true(fabs(1 / room.range.far - 4) < 0.09);
}

TEST(who_walks_in_has_a_disparity_of_his_own)
{
    double focus, lens;

    begin(0, 0);
    watch(3, 0);
    focus = in_focus();
    lens = room.blur / (room.range.near - room.range.far);
    assert_true(fabs(1 / focus - 4) < 0.1);
    for (int x = 0; x < 60; x += 2) { /* a second to walk in */
        draw(x);
        look();
        assert_true(fabs(in_focus() - focus) < 1e-9);
    }
    watch(0.7, 60);
    assert_true(mean_at(20, 60) > 0.95);
    assert_true(mean_at(100, 100) < 0.2);
    assert_true(mean_at(100, 30) < 0.05);
    assert_true(fabs(dioptres_at(20, 60) - 1 / 1.1) < 0.02);
    assert_true(fabs(dioptres_at(100, 30) - 0.25) < 0.01);
    /* A step of a range that widens is at most an eighth of it, and the lens hardly moves: what
     * stood still is blurred as before. */
    assert_true(room.pace > 0.05 && room.pace < 0.15);
    assert_true(room.change < 0.02);
    assert_true(fabs(log(room.blur / (room.range.near - room.range.far) / lens)) < 0.3);
    watch(40, 60);
    assert_true(fabs(room.blur - 10) < 0.5); /* K is that of the greatest distance again */
    assert_true(fabs(in_focus() - focus) < 1e-9);
    assert_true(room.change < 0.02);
}

TEST(who_leaves_leaves_the_range_slowly)
{
    double focus;

    begin(0, 0);
    watch(1, 60);
    focus = in_focus();
    assert_true(fabs(1 / room.range.near - 1.1) < 0.02);
    watch(0.9, 0);
    watch(0.2, 60); /* He may come back. */
    watch(0.9, 0);
    assert_true(fabs(1 / room.range.near - 1.1) < 0.02);
    assert_true(room.pace == 0);
    watch(9, 0);
    assert_true(fabs(1 / room.range.near - 2.5) < 0.1);
    assert_true(room.pace < 0.03 && room.change < 0.03);
    assert_true(fabs(in_focus() - focus) < 1e-9);
}

/* So is what is farther: at once there, and slowly forgotten. */
TEST(a_door_is_opened_and_shut)
{
    begin(0, 0);
    watch(1, 0);
    wall = 2 * WALL;
    watch(0.7, 0);
    assert_true(fabs(1 / room.range.far - 8) < 0.5);
    wall = WALL;
    watch(0.9, 0);
    assert_true(fabs(1 / room.range.far - 8) < 0.5);
    watch(9, 0);
    assert_true(fabs(1 / room.range.far - 4) < 0.1);
}

/* Focus on the person, who then leaves: the focus stays where he was, beyond what there is. */
TEST(a_focus_beyond_the_scene_stays_where_it_is)
{
    struct live_depth_map wide = {0};
    struct live_depth_map map = {.disparity = room.disparity, .width = W, .height = H};
    const struct live_depth_map *wider = &map;
    double focus;

    begin(0, 0);
    room.focus.to.point[0] = room.focus.from.point[0] = 20;
    room.focus.to.point[1] = room.focus.from.point[1] = 60;
    watch(1, 60);
    focus = in_focus();
    assert_true(fabs(focus - 1 / 1.1) < 0.02);
    watch(12, 0);
    assert_true(fabs(in_focus() - focus) < 1e-9);
    assert_true(fabs(1 / room.ranger.range.near - 2.5) < 0.1);
    assert_true(room.change < 0.03);
    map.range = room.ranger.range;
    assert_int_equal(live_depth_widen(&wide, &wider, &room.range), REFOCUS_OK);
    assert_ptr_equal(wider, &wide);
    for (int i = 0; i < W * H; i++) {
        const struct live_range *in = &map.range, *out = &wide.range;
        const double from = in->far + map.disparity[i] / 65535.0 * (in->near - in->far);
        const double to = out->far + wide.disparity[i] / 65535.0 * (out->near - out->far);

        assert_true(fabs(from - to) < 1e-5);
    }
    free(wide.disparity);
}

/* A map that is wrong altogether, a long gap, times that go back. */
TEST(faults_move_nothing)
{
    struct live_range range;

    begin(0, 0);
    watch(1, 0);
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < W * H; k++)
            room.mm[k] = (uint16_t)(i == 0 ? 200 : i == 1 ? 60000 : 1 + (uint16_t)noise(30000));
        look();
        assert_true(room.pace == 0);
        watch(0.5, 0);
    }
    memset(room.mm, 0, sizeof room.mm);
    assert_false(live_range_measure(&room.ranger, &room.map, &range));
    room.now += 1000000000000;
    watch(1, 0);
    room.now -= 2000000000000;
    watch(1, 0);
    assert_true(room.pace == 0);
}

/* A laser scanner's samples lie alone. */
TEST(few_points_will_do)
{
    struct live_range seen;

    begin(0, 0);
    for (int i = 0; i < W * H; i++)
        room.mm[i] = i / W % 3 || i % W % 3 ? 0 : i % W < W / 2 ? 2000 : 5000;
    assert_true(live_range_measure(&room.ranger, &room.map, &seen));
    assert_true(fabs(seen.near - 0.5) < 1e-6 && fabs(seen.far - 0.2) < 1e-6);
}

TEST(what_is_given_stays)
{
    begin(2, 0);
    watch(2, 60);
    assert_true(room.range.near == 0.5);
    assert_true(fabs(1 / room.range.far - 4) < 0.09);
    assert_true(mean_at(20, 60) == 1);
    begin(0, (double)INFINITY);
    watch(2, 0);
    watch(2, 60);
    assert_true(room.range.far == 0);
    assert_true(fabs(1 / room.range.near - 1.1) < 0.02);
    /* A bare wall is no scene: its noise does not become one. */
    begin(0, 0);
    for (int i = 0; i < 60; i++) {
        for (int k = 0; k < W * H; k++)
            room.mm[k] = (uint16_t)(WALL + noise(4));
        look();
    }
    assert_true(fabs(room.range.near / room.range.far - 1.05) < 1e-9);
    assert_true(mean_at(20, 60) < 0.05);
    live_range_end(&room.ranger);
}
