/* test_due.c: when `refocus live` expects the depth of a frame, by how the last maps came. */
#include <stdint.h>
#include "unit_test.h"
#include "live/live_depth.h"
#include "live/live_times.h"

enum { MS = 1000000, HALF = 17 * MS };
static struct live_depths depths;

/* Maps of so many milliseconds from 0 on, each that much later here than it was taken. */
static void come(int maps, int period_ms, int lag_ms)
{
    depths = (struct live_depths){0};
    assert_true(live_depths_init(&depths, false));
    for (int i = 0; i < maps; i++) {
        struct live_depth_map *const map = live_depths_fill(&depths, 1, 1);

        assert_non_null(map);
        live_depths_put(&depths, map, (int64_t)i * period_ms * MS, false);
    }
    for (int i = 0; i < LIVE_HABITS; i++) /* by a clock on the wall that stood at 0 then */
        depths.lag_ns[i] = (int64_t)lag_ms * MS;
}

/* When the map of a moment is due, as of another one, in milliseconds; -1 never, -2 not known. */
static int due(int time_ms, int now_ms)
{
    const int64_t at = live_depths_due(&depths, (int64_t)time_ms * MS, HALF, (int64_t)now_ms * MS);

    return at == INT64_MAX ? -1 : at == INT64_MIN ? -2 : (int)((at + MS / 2) / MS);
}

static void end(void)
{
    live_depths_free(&depths);
}

TEST(a_map_for_each_frame)
{
    come(0, 33, 5);
    assert_int_equal(due(0, 0), -2);
    end();
    come(1, 33, 5);
    assert_int_equal(due(33, 33), 38);
    end();
    come(5, 33, 5); /* the last one is of 132 ms */
    assert_int_equal(due(165, 165), 170);
    assert_int_equal(due(175, 175), 170);
    assert_int_equal(due(198, 198), 203); /* one was lost */
    assert_int_equal(due(231, 240), -1);  /* here it were three */
    end();
}

TEST(fewer_maps_than_frames)
{
    come(4, 200, 5); /* the last one is of 600 ms */
    assert_int_equal(due(633, 633), -1);
    assert_int_equal(due(766, 766), -1);
    assert_int_equal(due(800, 800), 805);
    assert_int_equal(due(780, 780), 805); /* cameras are not punctual */
    end();
}

/* One map that is late does not make the next ones be given up, nor one lag that is short. */
TEST(odd_ones)
{
    come(5, 33, 5);
    depths.lag_ns[1] = 300 * (int64_t)MS;
    depths.period_ns[2] = 500 * (int64_t)MS;
    assert_int_equal(due(165, 165), 170);
    end();
    come(5, 33, 90);
    depths.lag_ns[0] = 0;
    depths.period_ns[0] = -1000 * (int64_t)MS;
    assert_int_equal(due(165, 165), 255);
    end();
}

/* Pairing comes back at once where nothing is due by the deadline. */
TEST(nothing_is_waited_for)
{
    const int64_t now = live_now_ns(), far = now + 20000 * (int64_t)MS;
    bool paired = true;

    come(4, 200, 5);
    depths.newest_ns = now - 5 * (int64_t)MS;
    assert_non_null(live_depths_pair(&depths, now + 100 * (int64_t)MS, HALF, far, &paired));
    assert_false(paired);
    assert_true(live_now_ns() < far);
    end();
}
