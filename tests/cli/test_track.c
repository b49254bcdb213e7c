/* test_track.c: the rectangle of `refocus live --focus-rectangle` stays on its subject. */
#include <math.h>
#include <stdint.h>
#include <string.h>
#include "unit_test.h"
#include <refocus/refocus.h>
#include "live/live_track.h"

enum { W = 320, H = 240, SIDE = 72 };
static uint8_t rgb[H][W][3];
static uint32_t seed;

static int noise(int most)
{
    seed = seed * 1664525u + 1013904223u;
    return (int)((seed >> 8) % (uint32_t)(2 * most + 1)) - most;
}

/* Texture without a period, some pixels in size. */
static double texture(double x, double y, double kind)
{
    return 128 + 40 * sin(0.31 * x + kind) * cos(0.23 * y - kind) +
           30 * sin(0.013 * x * y + 0.11 * x) + 20 * cos(0.17 * (x + 2 * y) + 3 * kind);
}

/* A subject about (x, y), so many times its first size, before a wall; what hides it is of another
 * texture, from `left` on as wide as the subject. */
static void draw(double x, double y, double size, int left)
{
    for (int j = 0; j < H; j++)
        for (int i = 0; i < W; i++) {
            const double u = (i - x) / size, v = (j - y) / size;
            const bool inside = u * u + v * v < SIDE * SIDE / 4.0;
            const double code = i >= left && i < left + SIDE ? texture(j, i, 5)
                                : inside                     ? texture(u + 50, v + 50, 1)
                                                             : texture(i, j, 3);

            rgb[j][i][1] = (uint8_t)lrint(fmin(fmax(code + noise(6), 0), 255));
            rgb[j][i][0] = rgb[j][i][2] = (uint8_t)noise(127); /* green stands for brightness */
        }
}

static bool follow(struct live_tracker *tracker)
{
    const struct refocus_image photo =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, rgb, W, H, (ptrdiff_t)W * 3);

    return live_track_frame(tracker, &photo);
}

static struct live_tracker begin(double height)
{
    const double box[4] = {160 - SIDE / 2.0, 120 - height / 2, SIDE, height};
    struct live_tracker tracker;

    seed = 1;
    live_track_begin(&tracker, box);
    draw(160, 120, 1, W);
    assert_true(follow(&tracker));
    return tracker;
}

/* The distance of the middle of the box from (x, y). */
static double off(const struct live_tracker *tracker, double x, double y)
{
    const double *const box = tracker->box;

    return hypot(box[0] + box[2] / 2 - x, box[1] + box[3] / 2 - y);
}

/* Errors do not add up: neither where all stands still nor where the subject comes back. */
TEST(does_not_drift)
{
    struct live_tracker tracker = begin(SIDE);

    for (int t = 0; t < 200; t++) {
        draw(160, 120, 1, W);
        assert_true(follow(&tracker));
        assert_true(off(&tracker, 160, 120) < 0.5);
    }
    for (int t = 0; t < 100; t++) {
        const double x = 160 + 60 * sin(t / 12.0), y = 120 + 30 * sin(t / 7.0);

        draw(x, y, 1, W);
        assert_true(follow(&tracker));
        assert_true(off(&tracker, x, y) < 3);
    }
    assert_true(tracker.box[2] > 0.93 * SIDE && tracker.box[2] < 1.07 * SIDE);
}

/* The rectangle does not go with what passes before its subject. */
TEST(outlives_an_occluder)
{
    struct live_tracker tracker = begin(SIDE);

    for (int left = -SIDE; left < W; left += 4) {
        draw(160, 120, 1, left);
        follow(&tracker);
    }
    draw(160, 120, 1, W);
    assert_true(follow(&tracker));
    assert_true(off(&tracker, 160, 120) < 1);
    assert_true(tracker.lost > 0);
}

TEST(grows_with_its_subject)
{
    for (int i = 0; i < 2; i++) {
        const double most = i ? 1.6 : 0.6;
        struct live_tracker tracker = begin(SIDE / 2.0);

        for (int t = 0; t <= 60; t++) {
            const double size = 1 + (most - 1) * t / 60;

            draw(160, 120, size, W);
            assert_true(follow(&tracker));
            assert_true(off(&tracker, 160, 120) < 3);
            assert_true(fabs(tracker.box[2] / (size * SIDE) - 1) < 0.15);
        }
    }
}

/* Y of frames is what G of pictures is, and nothing else counts. */
TEST(any_format)
{
    static const struct {
        uint32_t format;
        int step;
    } kinds[] = {{REFOCUS_FORMAT_NV12, 1}, {REFOCUS_FORMAT_YUYV, 2}};
    static uint8_t memory[2 * W * H];

    for (int k = 0; k < 2; k++) {
        const struct refocus_image photo = refocus_image_planar(kinds[k].format, memory, W, H);
        struct live_tracker tracker = begin(SIDE), other = tracker;

        other.has_pattern = false;
        for (int t = 0; t < 12; t++) {
            if (t)
                draw(160 + 3 * t, 120 - 2 * t, 1, W);
            for (int i = 0; i < 2 * W * H; i++)
                memory[i] = (uint8_t)noise(127);
            for (int i = 0; i < W * H; i++)
                memory[i * kinds[k].step] = rgb[i / W][i % W][1];
            assert_true(follow(&tracker) && live_track_frame(&other, &photo));
            assert_memory_equal(other.box, tracker.box, sizeof tracker.box);
        }
        assert_true(off(&tracker, 193, 98) < 3);
    }
}
