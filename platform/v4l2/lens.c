/* lens.c: the lens and the exposure of a V4L2 camera, by the controls that its driver has.
 *
 * V4L2 gives the focus no unit; larger values are nearer. Lenses that move by steps alone
 * (V4L2_CID_FOCUS_RELATIVE) cannot say where they are; they count as lenses that do not move.
 */
#include <errno.h>
#include <math.h>
#include <string.h>
#include "v4l2.h"

static bool query(const struct rf_v4l2 *device, uint32_t id, struct v4l2_queryctrl *control)
{
    memset(control, 0, sizeof *control);
    control->id = id;
    return rf_v4l2_ioctl(device->fd, VIDIOC_QUERYCTRL, control) == 0 &&
           !(control->flags & V4L2_CTRL_FLAG_DISABLED);
}

static bool has(const struct rf_v4l2 *device, uint32_t id)
{
    struct v4l2_queryctrl control;

    return query(device, id, &control);
}

static int get(const struct rf_v4l2 *device, uint32_t id, int32_t *value)
{
    struct v4l2_control control = {.id = id};
    const int error = rf_v4l2_ioctl(device->fd, VIDIOC_G_CTRL, &control);

    *value = control.value;
    return error;
}

static int set(const struct rf_v4l2 *device, uint32_t id, int32_t value)
{
    struct v4l2_control control = {.id = id, .value = value};

    return rf_v4l2_ioctl(device->fd, VIDIOC_S_CTRL, &control);
}

int rf_v4l2_get_lens(struct refocus_source *source, struct refocus_source_lens *lens,
                     struct refocus_reason *reason)
{
    const struct rf_v4l2 *device = source->state;
    struct v4l2_queryctrl range;
    int32_t position;

    if (device->fd < 0)
        return rf_v4l2_fail(device, reason, ENODEV, "asking for its lens");
    if (query(device, V4L2_CID_FOCUS_ABSOLUTE, &range) && range.minimum < range.maximum) {
        lens->modes |= 1 << REFOCUS_SOURCE_FOCUS_FIXED;
        lens->least = range.minimum;
        lens->greatest = range.maximum;
        if (get(device, V4L2_CID_FOCUS_ABSOLUTE, &position) == 0)
            lens->position = position;
    }
    if (has(device, V4L2_CID_FOCUS_AUTO))
        lens->modes |= 1 << REFOCUS_SOURCE_FOCUS_CONTINUOUS;
    if (has(device, V4L2_CID_AUTO_FOCUS_START))
        lens->modes |= 1 << REFOCUS_SOURCE_FOCUS_ONCE;
    if (lens->modes)
        lens->modes |= 1 << REFOCUS_SOURCE_FOCUS_OFF;
    return REFOCUS_OK;
}

int rf_v4l2_set_focus(struct refocus_source *source, uint32_t mode, double position,
                      struct refocus_reason *reason)
{
    const struct rf_v4l2 *device = source->state;
    int error = 0;

    /* Continuous autofocus goes first: while it is on, drivers refuse the rest. */
    if (has(device, V4L2_CID_FOCUS_AUTO))
        error = set(device, V4L2_CID_FOCUS_AUTO, mode == REFOCUS_SOURCE_FOCUS_CONTINUOUS);
    if (error == 0 && mode == REFOCUS_SOURCE_FOCUS_ONCE)
        error = set(device, V4L2_CID_AUTO_FOCUS_START, 1);
    if (error == 0 && mode == REFOCUS_SOURCE_FOCUS_FIXED)
        error = set(device, V4L2_CID_FOCUS_ABSOLUTE, (int32_t)lround(position));
    return error ? rf_v4l2_fail(device, reason, error, "focusing") : REFOCUS_OK;
}

int rf_v4l2_lock_exposure(struct refocus_source *source, bool lock, struct refocus_reason *reason)
{
    static const struct {
        uint32_t id;
        int32_t locked, automatic;
    } controls[] = {
        {V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL, V4L2_EXPOSURE_APERTURE_PRIORITY},
        {V4L2_CID_AUTOGAIN, 0, 1},
        {V4L2_CID_AUTO_WHITE_BALANCE, 0, 1},
    };
    static const uint32_t kept[] = {V4L2_CID_EXPOSURE_ABSOLUTE, V4L2_CID_EXPOSURE, V4L2_CID_GAIN,
                                    V4L2_CID_WHITE_BALANCE_TEMPERATURE};
    enum { CONTROLS = sizeof controls / sizeof *controls, KEPT = sizeof kept / sizeof *kept };
    const struct rf_v4l2 *device = source->state;
    int32_t value[KEPT];
    bool known[KEPT];
    int done = 0;

    if (device->fd < 0)
        return rf_v4l2_fail(device, reason, ENODEV, "locking its exposure");
    for (int i = 0; i < KEPT; i++)
        known[i] = lock && has(device, kept[i]) && get(device, kept[i], &value[i]) == 0;
    for (int i = 0; i < CONTROLS; i++)
        done += has(device, controls[i].id) &&
                set(device, controls[i].id, lock ? controls[i].locked : controls[i].automatic) == 0;
    if (!lock && !done) /* cameras whose aperture is automatic, too */
        done = set(device, V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_AUTO) == 0;
    /* Some drivers go to their own values with the change; what cannot be set stays. */
    for (int i = 0; i < KEPT && done; i++)
        if (known[i])
            set(device, kept[i], value[i]);
    return done ? REFOCUS_OK
                : rf_capture_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                                  "%s: it has no exposure that can be locked", device->path);
}
