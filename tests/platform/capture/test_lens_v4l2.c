/* test_lens_v4l2.c: which controls the lens of a V4L2 camera is moved by, against drivers that have
 * some of them and refuse, as real ones do, what does not go with continuous autofocus. */
#include <errno.h>
#include <math.h>
#include "check.h"
#include "v4l2.h"

enum { AUTO, START, PLACE, CONTROLS };

static const uint32_t ids[CONTROLS] = {V4L2_CID_FOCUS_AUTO, V4L2_CID_AUTO_FOCUS_START,
                                       V4L2_CID_FOCUS_ABSOLUTE};
static bool there[CONTROLS];
static int value[CONTROLS], starts, broken;

int rf_v4l2_ioctl(int fd, unsigned long request, void *argument)
{
    struct v4l2_control *const control = argument;
    int n = 0;

    assert_int_equal(fd, 5);
    while (n < CONTROLS && ids[n] != control->id) /* the first field of both structs */
        n++;
    if (n == CONTROLS || (!there[n] && n != PLACE))
        return EINVAL;
    if (request == VIDIOC_QUERYCTRL) {
        struct v4l2_queryctrl *const range = argument;

        range->flags = there[n] ? 0 : V4L2_CTRL_FLAG_DISABLED;
        range->minimum = n == PLACE ? 10 : 0;
        range->maximum = n == PLACE ? 250 : n == AUTO;
        return 0;
    }
    if (broken)
        return broken;
    if (request == VIDIOC_G_CTRL) {
        control->value = value[n];
        return n == START ? EACCES : 0; /* a button */
    }
    assert_true(request == VIDIOC_S_CTRL);
    if (n != AUTO && value[AUTO])
        return EBUSY;
    starts += n == START;
    value[n] = control->value;
    return 0;
}

int rf_v4l2_fail(const struct rf_v4l2 *device, struct refocus_reason *reason, int error,
                 const char *doing)
{
    return rf_capture_fail(reason, error == ENODEV ? REFOCUS_ERR_GONE : REFOCUS_ERR_IO, "%s: %s",
                           device->path, doing);
}

static struct refocus_source_lens lens_of(bool automatic, bool start, bool place)
{
    struct rf_v4l2 device = {.path = "/dev/video5", .fd = 5};
    struct refocus_source source = {.state = &device};
    struct refocus_source_lens lens = refocus_source_lens_default();
    struct refocus_reason reason = {""};

    there[AUTO] = automatic;
    there[START] = start;
    there[PLACE] = place;
    assert_status(rf_v4l2_get_lens(&source, &lens, &reason), REFOCUS_OK);
    return lens;
}

static int focus(uint32_t mode, double position)
{
    struct rf_v4l2 device = {.path = "/dev/video5", .fd = 5};
    struct refocus_source source = {.state = &device};
    struct refocus_reason reason = {""};

    return rf_v4l2_set_focus(&source, mode, position, &reason);
}

enum {
    CONTINUOUS = 1 << REFOCUS_SOURCE_FOCUS_CONTINUOUS,
    ONCE = 1 << REFOCUS_SOURCE_FOCUS_ONCE,
    FIXED = 1 << REFOCUS_SOURCE_FOCUS_FIXED,
    OFF = 1 << REFOCUS_SOURCE_FOCUS_OFF,
};

TEST(modes_are_those_of_the_controls)
{
    struct refocus_source_lens lens;

    value[PLACE] = 42;
    assert_int_equal(lens_of(false, false, false).modes, 0);
    assert_int_equal(lens_of(true, false, false).modes, CONTINUOUS | OFF);
    assert_int_equal(lens_of(false, true, false).modes, ONCE | OFF);
    lens = lens_of(false, false, true);
    assert_int_equal(lens.modes, FIXED | OFF);
    assert_true(lens.least == 10 && lens.greatest == 250 && lens.position == 42);
    assert_false(lens.dioptres);
    assert_true(isnan(lens_of(true, true, false).position));
    assert_int_equal(lens_of(true, true, true).modes, CONTINUOUS | ONCE | FIXED | OFF);
}

TEST(continuous_autofocus_ends_before_the_rest)
{
    lens_of(true, true, true);
    value[PLACE] = 42;
    starts = 0;
    assert_status(focus(REFOCUS_SOURCE_FOCUS_CONTINUOUS, 0), REFOCUS_OK);
    assert_true(value[AUTO] == 1 && starts == 0);
    assert_status(focus(REFOCUS_SOURCE_FOCUS_OFF, 0), REFOCUS_OK);
    assert_true(value[AUTO] == 0 && starts == 0 && value[PLACE] == 42);
    value[AUTO] = 1;
    assert_status(focus(REFOCUS_SOURCE_FOCUS_ONCE, 0), REFOCUS_OK);
    assert_true(value[AUTO] == 0 && starts == 1 && value[PLACE] == 42);
    value[AUTO] = 1;
    assert_status(focus(REFOCUS_SOURCE_FOCUS_FIXED, 99.6), REFOCUS_OK);
    assert_true(value[AUTO] == 0 && starts == 1 && value[PLACE] == 100);
    lens_of(false, false, true);
    assert_status(focus(REFOCUS_SOURCE_FOCUS_OFF, 0), REFOCUS_OK);
    assert_int_equal(value[PLACE], 100);
    broken = EIO;
    assert_status(focus(REFOCUS_SOURCE_FOCUS_FIXED, 20), REFOCUS_ERR_IO);
    broken = ENODEV;
    assert_status(focus(REFOCUS_SOURCE_FOCUS_FIXED, 20), REFOCUS_ERR_GONE);
    broken = 0;
}
