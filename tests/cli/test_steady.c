/* test_steady.c: depth of `refocus live` is filtered over time, and not across a gap in it. */
#include <stdint.h>
#include "unit_test.h"
#include <refocus/refocus.h>
#include "live/live_steady.h"

enum { W = 16, H = 16, FIRST = 30000, NEXT = 30500 }; /* the difference is within the noise */
static const int64_t period_ns = 40000000;

/* The first sample of the filtered map after four maps of FIRST and one of NEXT, step_ns later. */
static int filtered_after(int64_t step_ns)
{
    static uint16_t samples[W * H];
    static uint8_t grey[W * H * 3];
    const struct refocus_image photo =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, grey, W, H, (ptrdiff_t)W * 3);
    struct live_steady steady = {0};
    struct live_depth_map map = {.disparity = samples, .width = W, .height = H};
    const struct live_depth_map *got = NULL;
    int64_t now = 5000000000;
    int result;

    for (int frame = 0; frame < 5; frame++) {
        now += frame == 4 ? step_ns : period_ns;
        for (int i = 0; i < W * H; i++)
            samples[i] = frame == 4 ? NEXT : FIRST;
        map.number++;
        map.timestamp_ns = now;
        got = &map;
        assert_int_equal(live_steady_run(&steady, 0.9, &got, &photo), REFOCUS_OK);
        assert_ptr_not_equal(got, &map);
        assert_true(got->timestamp_ns == now);
    }
    result = got->disparity[0];
    live_steady_end(&steady);
    return result;
}

TEST(gaps)
{
    assert_in_range(filtered_after(period_ns), FIRST, NEXT - 100);
    assert_in_range(filtered_after(900000000), FIRST, NEXT - 100);
    assert_int_equal(filtered_after(1100000000), NEXT);
    assert_int_equal(filtered_after(-4 * period_ns), NEXT); /* a file that begins again */
}
