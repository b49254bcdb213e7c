/* device.c: V4L2 devices are opened, their formats are translated, and their errors put into
 * words. */
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>
#include "v4l2.h"

static const struct {
    uint32_t fourcc, format;
    int memories;
} formats[] = {
    {V4L2_PIX_FMT_YUYV, REFOCUS_FRAME_YUYV, 1},     {V4L2_PIX_FMT_UYVY, REFOCUS_FRAME_UYVY, 1},
    {V4L2_PIX_FMT_NV12, REFOCUS_FRAME_NV12, 1},     {V4L2_PIX_FMT_NV12M, REFOCUS_FRAME_NV12, 2},
    {V4L2_PIX_FMT_NV21, REFOCUS_FRAME_NV21, 1},     {V4L2_PIX_FMT_NV21M, REFOCUS_FRAME_NV21, 2},
    {V4L2_PIX_FMT_YUV420, REFOCUS_FRAME_YUV420, 1}, {V4L2_PIX_FMT_YUV420M, REFOCUS_FRAME_YUV420, 3},
    {V4L2_PIX_FMT_RGB24, REFOCUS_FRAME_RGB24, 1},   {V4L2_PIX_FMT_BGR24, REFOCUS_FRAME_BGR24, 1},
    {V4L2_PIX_FMT_RGBX32, REFOCUS_FRAME_RGBX, 1},   {V4L2_PIX_FMT_RGBA32, REFOCUS_FRAME_RGBX, 1},
    {V4L2_PIX_FMT_XBGR32, REFOCUS_FRAME_BGRX, 1},   {V4L2_PIX_FMT_ABGR32, REFOCUS_FRAME_BGRX, 1},
    {V4L2_PIX_FMT_MJPEG, REFOCUS_FRAME_MJPEG, 1},   {V4L2_PIX_FMT_JPEG, REFOCUS_FRAME_MJPEG, 1},
    {V4L2_PIX_FMT_GREY, REFOCUS_FRAME_GREY, 1},     {V4L2_PIX_FMT_Y16, REFOCUS_FRAME_Y16, 1},
    {V4L2_PIX_FMT_Z16, REFOCUS_FRAME_Z16, 1},
};
enum { FORMATS = sizeof formats / sizeof *formats };

uint32_t rf_v4l2_format_of(uint32_t fourcc)
{
    for (int i = 0; i < FORMATS; i++)
        if (formats[i].fourcc == fourcc)
            return formats[i].format;
    return REFOCUS_FRAME_ANY;
}

uint32_t rf_v4l2_fourcc_of(uint32_t format, int n)
{
    for (int i = 0; i < FORMATS; i++)
        if (formats[i].format == format && n-- == 0)
            return formats[i].fourcc;
    return 0;
}

static int memories_of(uint32_t fourcc)
{
    for (int i = 0; i < FORMATS; i++)
        if (formats[i].fourcc == fourcc)
            return formats[i].memories;
    return 1;
}

int rf_v4l2_ioctl(int fd, unsigned long request, void *argument)
{
    int n;

    do
        n = ioctl(fd, request, argument);
    while (n < 0 && errno == EINTR);
    return n < 0 ? errno : 0;
}

int rf_v4l2_fail(const struct rf_v4l2 *device, struct refocus_reason *reason, int error,
                 const char *doing)
{
    char what[128];

    snprintf(what, sizeof what, "%s: %s", device->path, doing);
    if (error == ENODEV || error == ENXIO || error == ENOENT || error == EBUSY || error == EACCES ||
        error == EPERM)
        return rf_capture_fail_errno(reason, error, device->path);
    return rf_capture_fail_errno(reason, error, what);
}

static int check_device(struct rf_v4l2 *device, bool output, struct refocus_reason *reason)
{
    const uint32_t single = output ? V4L2_CAP_VIDEO_OUTPUT : V4L2_CAP_VIDEO_CAPTURE;
    const uint32_t multi = output ? V4L2_CAP_VIDEO_OUTPUT_MPLANE : V4L2_CAP_VIDEO_CAPTURE_MPLANE;
    struct v4l2_capability capability;
    struct stat file;
    uint32_t has;
    int error;

    if (fstat(device->fd, &file) != 0 || !S_ISCHR(file.st_mode))
        return rf_capture_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                               "%s: it is no device; give one such as /dev/video0", device->path);
    memset(&capability, 0, sizeof capability);
    error = rf_v4l2_ioctl(device->fd, VIDIOC_QUERYCAP, &capability);
    if (error == ENOTTY || error == EINVAL)
        return rf_capture_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                               "%s: it is no V4L2 device; give one such as /dev/video0",
                               device->path);
    if (error)
        return rf_v4l2_fail(device, reason, error, "asking what it is");
    has = capability.capabilities & V4L2_CAP_DEVICE_CAPS ? capability.device_caps
                                                         : capability.capabilities;
    if (!(has & (single | multi)) || !(has & V4L2_CAP_STREAMING))
        return rf_capture_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                               "%s (%.32s): it is not for video %s; give another node",
                               device->path, (const char *)capability.card,
                               output ? "output" : "capture");
    device->multi = !(has & single);
    device->type =
        output ? (device->multi ? V4L2_BUF_TYPE_VIDEO_OUTPUT_MPLANE : V4L2_BUF_TYPE_VIDEO_OUTPUT)
               : (device->multi ? V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE : V4L2_BUF_TYPE_VIDEO_CAPTURE);
    return REFOCUS_OK;
}

int rf_v4l2_open(struct rf_v4l2 *device, const char *name, bool output,
                 struct refocus_reason *reason)
{
    const char *before = name[0] == '/'                     ? ""
                         : name[0] >= '0' && name[0] <= '9' ? "/dev/video"
                                                            : "/dev/";
    int status;

    device->fd = -1;
    if (snprintf(device->path, sizeof device->path, "%s%s", before, name) >=
        (int)sizeof device->path)
        return rf_capture_fail(reason, REFOCUS_ERR_ARGUMENT, "the name is too long");
    device->fd = open(device->path, O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (device->fd < 0)
        return rf_v4l2_fail(device, reason, errno, "opening it");
    status = check_device(device, output, reason);
    if (status != REFOCUS_OK)
        rf_v4l2_close(device);
    return status;
}

void rf_v4l2_close(struct rf_v4l2 *device)
{
    if (device->fd >= 0)
        close(device->fd);
    device->fd = -1;
    device->streaming = false;
}

/* How Y, U and V were made, by what the driver says. */
static void read_colours(struct rf_v4l2 *device)
{
    const struct v4l2_format *f = &device->v4l2_format;
    const uint32_t space = device->multi ? f->fmt.pix_mp.colorspace : f->fmt.pix.colorspace;
    uint32_t encoding = device->multi ? f->fmt.pix_mp.ycbcr_enc : f->fmt.pix.ycbcr_enc;
    uint32_t range = device->multi ? f->fmt.pix_mp.quantization : f->fmt.pix.quantization;

    if (encoding == V4L2_YCBCR_ENC_DEFAULT)
        encoding = V4L2_MAP_YCBCR_ENC_DEFAULT(space);
    if (range == V4L2_QUANTIZATION_DEFAULT)
        range = V4L2_MAP_QUANTIZATION_DEFAULT(false, space, encoding);
    device->matrix = encoding == V4L2_YCBCR_ENC_709 || encoding == V4L2_YCBCR_ENC_XV709
                         ? REFOCUS_MATRIX_BT709
                         : REFOCUS_MATRIX_BT601;
    device->flags = range == V4L2_QUANTIZATION_FULL_RANGE ? REFOCUS_FRAME_FULL_RANGE : 0;
}

int rf_v4l2_set_format(struct rf_v4l2 *device, uint32_t fourcc, int width, int height,
                       struct refocus_reason *reason)
{
    struct v4l2_format *f = &device->v4l2_format;
    int error;

    memset(f, 0, sizeof *f);
    f->type = device->type;
    if (device->multi) {
        f->fmt.pix_mp.pixelformat = fourcc;
        f->fmt.pix_mp.width = (uint32_t)width;
        f->fmt.pix_mp.height = (uint32_t)height;
        f->fmt.pix_mp.field = V4L2_FIELD_NONE;
        f->fmt.pix_mp.num_planes = (uint8_t)memories_of(fourcc);
    } else {
        f->fmt.pix.pixelformat = fourcc;
        f->fmt.pix.width = (uint32_t)width;
        f->fmt.pix.height = (uint32_t)height;
        f->fmt.pix.field = V4L2_FIELD_NONE;
    }
    error = rf_v4l2_ioctl(device->fd, VIDIOC_S_FMT, f);
    if (error)
        return rf_v4l2_fail(device, reason, error, "setting the format");
    fourcc = device->multi ? f->fmt.pix_mp.pixelformat : f->fmt.pix.pixelformat;
    device->format = rf_v4l2_format_of(fourcc);
    device->width = (int)(device->multi ? f->fmt.pix_mp.width : f->fmt.pix.width);
    device->height = (int)(device->multi ? f->fmt.pix_mp.height : f->fmt.pix.height);
    device->memories = device->multi ? f->fmt.pix_mp.num_planes : 1;
    read_colours(device);
    if (device->format == REFOCUS_FRAME_ANY || device->width < 1 || device->height < 1 ||
        device->width > REFOCUS_MAX_SIDE || device->height > REFOCUS_MAX_SIDE ||
        device->memories != memories_of(fourcc))
        return rf_capture_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                               "%s: it delivers '%.4s' of %dx%d, which cannot be used; "
                               "--list shows what can",
                               device->path, (const char *)&fourcc, device->width, device->height);
    return REFOCUS_OK;
}
