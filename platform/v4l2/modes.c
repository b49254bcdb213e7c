/* modes.c: the formats, sizes and rates that a camera offers, and which of them are taken. */
#include <math.h>
#include <string.h>
#include "v4l2.h"

enum { MOST_MODES = 256 };

static double greatest_rate(int fd, uint32_t fourcc, uint32_t width, uint32_t height)
{
    struct v4l2_frmivalenum interval;
    double fps = 0;

    memset(&interval, 0, sizeof interval);
    interval.pixel_format = fourcc;
    interval.width = width;
    interval.height = height;
    for (; interval.index < MOST_MODES &&
           rf_v4l2_ioctl(fd, VIDIOC_ENUM_FRAMEINTERVALS, &interval) == 0;
         interval.index++) {
        const struct v4l2_fract *least = interval.type == V4L2_FRMIVAL_TYPE_DISCRETE
                                             ? &interval.discrete
                                             : &interval.stepwise.min;

        if (least->numerator > 0)
            fps = fmax(fps, (double)least->denominator / least->numerator);
    }
    return fps;
}

/* Mode number *index of one format; counts *index down by those that there are. */
static bool find_size(const struct rf_v4l2 *device, uint32_t fourcc, int *index,
                      struct refocus_source_mode *mode)
{
    struct v4l2_frmsizeenum size;

    memset(&size, 0, sizeof size);
    size.pixel_format = fourcc;
    for (; size.index < MOST_MODES && rf_v4l2_ioctl(device->fd, VIDIOC_ENUM_FRAMESIZES, &size) == 0;
         size.index++) {
        const bool discrete = size.type == V4L2_FRMSIZE_TYPE_DISCRETE;
        const uint32_t width = discrete ? size.discrete.width : size.stepwise.max_width;
        const uint32_t height = discrete ? size.discrete.height : size.stepwise.max_height;

        if ((*index)-- == 0) {
            mode->format = rf_v4l2_format_of(fourcc);
            mode->width = (int32_t)width;
            mode->height = (int32_t)height;
            mode->fps = greatest_rate(device->fd, fourcc, width, height);
            return true;
        }
        if (!discrete)
            return false;
    }
    /* Devices that do not say sizes have one mode for each format. */
    if (size.index == 0 && (*index)-- == 0) {
        mode->format = rf_v4l2_format_of(fourcc);
        return true;
    }
    return false;
}

int rf_v4l2_get_mode(struct refocus_source *source, int index, struct refocus_source_mode *mode)
{
    const struct rf_v4l2 *device = source->state;
    struct v4l2_fmtdesc format;

    memset(&format, 0, sizeof format);
    format.type = device->type;
    for (; format.index < MOST_MODES && rf_v4l2_ioctl(device->fd, VIDIOC_ENUM_FMT, &format) == 0;
         format.index++)
        if (rf_v4l2_format_of(format.pixelformat) != REFOCUS_FRAME_ANY &&
            find_size(device, format.pixelformat, &index, mode))
            return REFOCUS_OK;
    return REFOCUS_ERR_ARGUMENT;
}

static bool offers(const struct rf_v4l2 *device, uint32_t fourcc)
{
    struct v4l2_fmtdesc format;

    memset(&format, 0, sizeof format);
    format.type = device->type;
    for (; format.index < MOST_MODES && rf_v4l2_ioctl(device->fd, VIDIOC_ENUM_FMT, &format) == 0;
         format.index++)
        if (format.pixelformat == fourcc)
            return true;
    return false;
}

/* The node's own format comes first, then formats that are cheap to convert, then depth. */
static uint32_t choose_fourcc(const struct rf_v4l2 *device, uint32_t wanted, uint32_t present)
{
    static const uint32_t preferred[] = {
        REFOCUS_FRAME_NV12, REFOCUS_FRAME_NV21,  REFOCUS_FRAME_YUV420, REFOCUS_FRAME_YUYV,
        REFOCUS_FRAME_UYVY, REFOCUS_FRAME_RGB24, REFOCUS_FRAME_BGR24,  REFOCUS_FRAME_RGBX,
        REFOCUS_FRAME_BGRX, REFOCUS_FRAME_MJPEG, REFOCUS_FRAME_Z16,    REFOCUS_FRAME_Y16,
        REFOCUS_FRAME_GREY};
    const uint32_t is = rf_v4l2_format_of(present);
    uint32_t fourcc;

    if (is != REFOCUS_FRAME_ANY && (wanted == REFOCUS_FRAME_ANY || wanted == is))
        return present;
    for (size_t i = 0; i < sizeof preferred / sizeof *preferred; i++)
        if (wanted == REFOCUS_FRAME_ANY || wanted == preferred[i])
            for (int n = 0; (fourcc = rf_v4l2_fourcc_of(preferred[i], n)); n++)
                if (offers(device, fourcc))
                    return fourcc;
    return 0;
}

/* The rate: as wanted, or as it is. */
double rf_v4l2_set_rate(const struct rf_v4l2 *device, double fps)
{
    struct v4l2_streamparm parameters;
    const struct v4l2_fract *period = &parameters.parm.capture.timeperframe;

    memset(&parameters, 0, sizeof parameters);
    parameters.type = device->type;
    if (rf_v4l2_ioctl(device->fd, VIDIOC_G_PARM, &parameters) != 0)
        return 0;
    if (fps > 0) {
        parameters.parm.capture.timeperframe.numerator = 1000;
        parameters.parm.capture.timeperframe.denominator = (uint32_t)(fps * 1000 + 0.5);
        rf_v4l2_ioctl(device->fd, VIDIOC_S_PARM, &parameters);
    }
    return period->numerator > 0 ? (double)period->denominator / period->numerator : 0;
}

int rf_v4l2_choose_format(struct refocus_source *source, struct refocus_reason *reason)
{
    struct rf_v4l2 *device = source->state;
    struct v4l2_format present;
    uint32_t fourcc, width, height;
    int error, status;

    memset(&present, 0, sizeof present);
    present.type = device->type;
    error = rf_v4l2_ioctl(device->fd, VIDIOC_G_FMT, &present);
    if (error)
        return rf_v4l2_fail(device, reason, error, "asking for the format");
    fourcc = device->multi ? present.fmt.pix_mp.pixelformat : present.fmt.pix.pixelformat;
    width = device->multi ? present.fmt.pix_mp.width : present.fmt.pix.width;
    height = device->multi ? present.fmt.pix_mp.height : present.fmt.pix.height;
    fourcc = choose_fourcc(device, source->config.format, fourcc);
    if (fourcc == 0)
        return rf_capture_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                               "%s: it has no %s; --list shows what it has", device->path,
                               source->config.format
                                   ? refocus_frame_format_name(source->config.format)
                                   : "format that is known");
    status =
        rf_v4l2_set_format(device, fourcc, source->config.width ? source->config.width : (int)width,
                           source->config.height ? source->config.height : (int)height, reason);
    if (status == REFOCUS_OK && source->config.format && device->format != source->config.format)
        return rf_capture_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                               "%s: it gives %s where %s was asked for", device->path,
                               refocus_frame_format_name(device->format),
                               refocus_frame_format_name(source->config.format));
    return status;
}
