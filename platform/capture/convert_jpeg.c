/* convert_jpeg.c: frames of MJPEG are decoded by libjpeg-turbo, into R, G and B or, where pictures
 * have such a format, into their own samples of Y, U and V. */
#include "converter.h"
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include "failure.h"
#ifdef RF_HAVE_JPEG
#include <turbojpeg.h>

enum { FLAGS = TJFLAG_STOPONWARNING | TJFLAG_LIMITSCANS };

/* Returns the subsampling, or -1 for what is damaged or not of the frame's size. */
static int read_header(struct refocus_converter *converter, const struct refocus_frame *frame,
                       int *space)
{
    int width, height, subsampling;

    if (tjDecompressHeader3(converter->jpeg, frame->plane[0], (unsigned long)frame->bytes, &width,
                            &height, &subsampling, space) != 0 ||
        width != frame->width || height != frame->height)
        return -1;
    return subsampling;
}

static int begin(struct refocus_converter *converter, struct refocus_reason *reason)
{
    if (!converter->jpeg)
        converter->jpeg = tjInitDecompress();
    return converter->jpeg ? REFOCUS_OK : rf_capture_fail_memory(reason);
}

static int fail_header(struct refocus_reason *reason)
{
    return rf_capture_fail(reason, REFOCUS_ERR_FORMAT,
                           "the JPEG of the frame is damaged or of another size");
}

static int fail_decoding(const struct refocus_converter *converter, struct refocus_reason *reason)
{
    return rf_capture_fail(reason, REFOCUS_ERR_FORMAT, "the JPEG of the frame: %.180s",
                           tjGetErrorStr2(converter->jpeg));
}

int rf_convert_jpeg_rgb8(struct refocus_converter *converter, const struct refocus_frame *frame,
                         const struct refocus_image *out, struct refocus_reason *reason)
{
    int space, status = begin(converter, reason);

    if (status != REFOCUS_OK)
        return status;
    if (read_header(converter, frame, &space) < 0)
        return fail_header(reason);
    if (out->stride[0] < 0 || out->stride[0] > 1 << 30)
        return rf_capture_fail(reason, REFOCUS_ERR_ARGUMENT, "this stride is not possible");
    if (tjDecompress2(converter->jpeg, frame->plane[0], (unsigned long)frame->bytes, out->plane[0],
                      out->width, (int)out->stride[0], out->height, TJPF_RGB, FLAGS) != 0)
        return fail_decoding(converter, reason);
    return REFOCUS_OK;
}

/* Sides that split no pair are decoded without a column or row more than the picture has. */
static uint32_t format_of(const struct refocus_frame *frame, int subsampling, int space)
{
    if (space != TJCS_YCbCr || frame->width % 2)
        return REFOCUS_FORMAT_NONE;
    if (subsampling == TJSAMP_420 && frame->height % 2 == 0)
        return REFOCUS_FORMAT_I420;
    return subsampling == TJSAMP_422 ? REFOCUS_FORMAT_YUYV : REFOCUS_FORMAT_NONE;
}

uint32_t rf_jpeg_image_format(struct refocus_converter *converter,
                              const struct refocus_frame *frame)
{
    struct refocus_reason unheard;
    int space, subsampling;

    if (begin(converter, &unheard) != REFOCUS_OK)
        return REFOCUS_FORMAT_NONE;
    subsampling = read_header(converter, frame, &space);
    return subsampling < 0 ? (uint32_t)REFOCUS_FORMAT_NONE : format_of(frame, subsampling, space);
}

/* Planes of 4:2:2, which are packed as YUYV afterwards. */
static int reserve_planes(struct refocus_converter *converter, const struct refocus_frame *frame,
                          uint8_t *plane[3], int stride[3], struct refocus_reason *reason)
{
    const size_t luma = (size_t)frame->width * (size_t)frame->height;

    if (2 * luma > converter->planes_size) {
        free(converter->planes);
        converter->planes = malloc(2 * luma);
        converter->planes_size = converter->planes ? 2 * luma : 0;
    }
    if (!converter->planes)
        return rf_capture_fail_memory(reason);
    for (int i = 0; i < 3; i++) {
        plane[i] = converter->planes + (i == 0 ? 0 : luma + (size_t)(i - 1) * luma / 2);
        stride[i] = i == 0 ? frame->width : frame->width / 2;
    }
    return REFOCUS_OK;
}

/* Four bytes of a pair at once, which compilers turn into vectors; plane by plane is nine times as
 * slow. */
static void pack_row(uint8_t *restrict out, const uint8_t *restrict luma, const uint8_t *restrict u,
                     const uint8_t *restrict v, int pairs)
{
    for (int x = 0; x < pairs; x++) {
        out[4 * x] = luma[2 * x];
        out[4 * x + 1] = u[x];
        out[4 * x + 2] = luma[2 * x + 1];
        out[4 * x + 3] = v[x];
    }
}

/* Codes of JPEG are those of BT.601 in the full range. */
int rf_convert_jpeg_yuv(struct refocus_converter *converter, const struct refocus_frame *frame,
                        struct refocus_image *out, struct refocus_reason *reason)
{
    const bool packed = out->format == REFOCUS_FORMAT_YUYV;
    uint8_t *plane[3];
    int stride[3], status = REFOCUS_OK;

    if (packed)
        status = reserve_planes(converter, frame, plane, stride, reason);
    for (int i = 0; i < 3 && !packed; i++) {
        plane[i] = out->plane[i];
        stride[i] = (int)out->stride[i];
        if (out->stride[i] < 0 || out->stride[i] > 1 << 30)
            return rf_capture_fail(reason, REFOCUS_ERR_ARGUMENT, "this stride is not possible");
    }
    if (status != REFOCUS_OK)
        return status;
    if (tjDecompressToYUVPlanes(converter->jpeg, frame->plane[0], (unsigned long)frame->bytes,
                                plane, frame->width, stride, frame->height, FLAGS) != 0)
        return fail_decoding(converter, reason);
    out->matrix = REFOCUS_MATRIX_BT601;
    out->range = REFOCUS_RANGE_FULL;
    if (!packed)
        return REFOCUS_OK;
    for (int y = 0; y < frame->height; y++)
        pack_row(out->plane[0] + y * out->stride[0], plane[0] + (ptrdiff_t)y * stride[0],
                 plane[1] + (ptrdiff_t)y * stride[1], plane[2] + (ptrdiff_t)y * stride[2],
                 frame->width / 2);
    return REFOCUS_OK;
}

void rf_free_jpeg(struct refocus_converter *converter)
{
    if (converter->jpeg)
        tjDestroy(converter->jpeg);
    free(converter->planes);
}
#else
static int lacks_jpeg(struct refocus_reason *reason)
{
    return rf_capture_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                           "this build has no JPEG; choose another format of the camera");
}

int rf_convert_jpeg_rgb8(struct refocus_converter *converter, const struct refocus_frame *frame,
                         const struct refocus_image *out, struct refocus_reason *reason)
{
    (void)converter;
    (void)frame;
    (void)out;
    return lacks_jpeg(reason);
}

int rf_convert_jpeg_yuv(struct refocus_converter *converter, const struct refocus_frame *frame,
                        struct refocus_image *out, struct refocus_reason *reason)
{
    (void)converter;
    (void)frame;
    (void)out;
    return lacks_jpeg(reason);
}

uint32_t rf_jpeg_image_format(struct refocus_converter *converter,
                              const struct refocus_frame *frame)
{
    (void)converter;
    (void)frame;
    return REFOCUS_FORMAT_NONE;
}

void rf_free_jpeg(struct refocus_converter *converter)
{
    (void)converter;
}
#endif
