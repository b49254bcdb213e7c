/* convert.c: frames of every pixel format become RGB8 or 16-bit samples. Each row of the camera's
 * memory is copied once, in order, before it is looked at, as uncached memory is slow to read,
 * and slowest in pieces. */
#include <stdlib.h>
#include <string.h>
#include "converter.h"
#include "backend.h"
#include "samples.h"
#include "sink.h"

/* R = (cy (Y - y0) + rv (V - 128) + half) >> SHIFT and so on. */
enum { SHIFT = 14 };
struct coefficients {
    int y0, cy, rv, gu, gv, bu;
};

/* Kr and Kb of the standards; limited range spans 219 and 224 codes. */
static struct coefficients choose_coefficients(const struct refocus_frame *frame)
{
    const bool full = frame->flags & REFOCUS_FRAME_FULL_RANGE;
    const bool hd = frame->matrix == REFOCUS_MATRIX_BT709;
    const double kr = hd ? 0.2126 : 0.299, kb = hd ? 0.0722 : 0.114, kg = 1 - kr - kb;
    const double luma = full ? 1 : 255.0 / 219, chroma = full ? 1 : 255.0 / 224;
    const double one = 1 << SHIFT;

    return (struct coefficients){
        .y0 = full ? 0 : 16,
        .cy = (int)(one * luma + 0.5),
        .rv = (int)(one * chroma * 2 * (1 - kr) + 0.5),
        .gu = (int)(one * chroma * 2 * (1 - kb) * kb / kg + 0.5),
        .gv = (int)(one * chroma * 2 * (1 - kr) * kr / kg + 0.5),
        .bu = (int)(one * chroma * 2 * (1 - kb) + 0.5),
    };
}

static uint8_t clamp(int value)
{
    value >>= SHIFT;
    return (uint8_t)(value < 0 ? 0 : value > 255 ? 255 : value);
}

static void put_pixel(uint8_t *rgb, int luma, int red, int green, int blue)
{
    rgb[0] = clamp(luma + red);
    rgb[1] = clamp(luma + green);
    rgb[2] = clamp(luma + blue);
}

/* A row of Y and one of U and V, which lie step apart; two pixels share a U and a V. */
static void convert_yuv_row(uint8_t *restrict rgb, const uint8_t *restrict y, int y_step,
                            const uint8_t *restrict u, const uint8_t *restrict v, int uv_step,
                            int width, const struct coefficients *coefficients)
{
    const struct coefficients c = *coefficients;
    const int half = (1 << (SHIFT - 1)) - c.cy * c.y0;

    for (int x = 0; x < width; x += 2) {
        const int cu = u[x / 2 * uv_step] - 128, cv = v[x / 2 * uv_step] - 128;
        const int red = c.rv * cv, green = -c.gu * cu - c.gv * cv, blue = c.bu * cu;

        put_pixel(rgb + 3 * x, c.cy * y[x * y_step] + half, red, green, blue);
        if (x + 1 < width)
            put_pixel(rgb + 3 * x + 3, c.cy * y[(x + 1) * y_step] + half, red, green, blue);
    }
}

static void convert_rgb_row(uint8_t *restrict rgb, const uint8_t *restrict from, int bytes,
                            bool blue_first, int width)
{
    const int red = blue_first ? 2 : 0;

    for (int x = 0; x < width; x++) {
        rgb[3 * x] = from[x * bytes + red];
        rgb[3 * x + 1] = from[x * bytes + 1];
        rgb[3 * x + 2] = from[x * bytes + 2 - red];
    }
}

static void convert_grey_row(uint8_t *restrict rgb, const uint8_t *restrict from, int step,
                             int width)
{
    for (int x = 0; x < width; x++)
        rgb[3 * x] = rgb[3 * x + 1] = rgb[3 * x + 2] = from[x * step];
}

static void convert_row(uint8_t *rgb, uint8_t *const row[3], uint32_t format, int width,
                        const struct coefficients *c)
{
    switch (format) {
    case REFOCUS_FRAME_YUYV:
        convert_yuv_row(rgb, row[0], 2, row[0] + 1, row[0] + 3, 4, width, c);
        break;
    case REFOCUS_FRAME_UYVY:
        convert_yuv_row(rgb, row[0] + 1, 2, row[0], row[0] + 2, 4, width, c);
        break;
    case REFOCUS_FRAME_NV12:
        convert_yuv_row(rgb, row[0], 1, row[1], row[1] + 1, 2, width, c);
        break;
    case REFOCUS_FRAME_NV21:
        convert_yuv_row(rgb, row[0], 1, row[1] + 1, row[1], 2, width, c);
        break;
    case REFOCUS_FRAME_YUV420:
        convert_yuv_row(rgb, row[0], 1, row[1], row[2], 1, width, c);
        break;
    case REFOCUS_FRAME_RGB24:
    case REFOCUS_FRAME_BGR24:
        convert_rgb_row(rgb, row[0], 3, format == REFOCUS_FRAME_BGR24, width);
        break;
    case REFOCUS_FRAME_RGBX:
    case REFOCUS_FRAME_BGRX:
        convert_rgb_row(rgb, row[0], 4, format == REFOCUS_FRAME_BGRX, width);
        break;
    case REFOCUS_FRAME_GREY:
        convert_grey_row(rgb, row[0], 1, width);
        break;
    default: /* Y16, Z16: the high byte */
        convert_grey_row(rgb, row[0] + 1, 2, width);
        break;
    }
}

int refocus_converter_create(struct refocus_converter **converter)
{
    if (!converter)
        return REFOCUS_ERR_ARGUMENT;
    *converter = calloc(1, sizeof **converter);
    return *converter ? REFOCUS_OK : REFOCUS_ERR_MEMORY;
}

void refocus_converter_destroy(struct refocus_converter **converter)
{
    if (!converter || !*converter)
        return;
    rf_free_jpeg(*converter);
    for (int i = 0; i < 3; i++)
        free((*converter)->row[i]);
    free(*converter);
    *converter = NULL;
}

static int read_frame(struct refocus_frame *own, const struct refocus_frame *frame,
                      struct refocus_reason *reason)
{
    const int status =
        refocus_struct_read(own, sizeof *own, REFOCUS_SIZE_TO(struct refocus_frame, dmabuf), frame);

    return status ? rf_capture_fail(reason, status, "the frame is not of a known size of struct")
                  : REFOCUS_OK;
}

static int check(const struct refocus_frame *frame, struct refocus_reason *reason)
{
    if (rf_format_planes(frame->format) == 0 || frame->width < 1 || frame->height < 1 ||
        frame->width > REFOCUS_MAX_SIDE || frame->height > REFOCUS_MAX_SIDE)
        return rf_capture_fail(reason, REFOCUS_ERR_ARGUMENT, "the frame has no size or format");
    for (int i = 0; i < rf_format_planes(frame->format); i++) {
        const int64_t row = rf_plane_row(frame->format, i, frame->width);

        if (!frame->plane[i] ||
            !rf_stride_fits(frame->stride[i], row, rf_plane_rows(frame->format, i, frame->height)))
            return rf_capture_fail(reason, REFOCUS_ERR_ARGUMENT,
                                   "plane %d of the frame: its stride of %lld bytes is "
                                   "less than a row, or more than memory",
                                   i, (long long)frame->stride[i]);
    }
    return REFOCUS_OK;
}

/* Room for a row of each plane. */
static int reserve_rows(struct refocus_converter *converter, const struct refocus_frame *frame,
                        struct refocus_reason *reason)
{
    for (int i = 0; i < rf_format_planes(frame->format); i++) {
        const size_t size = (size_t)rf_plane_row(frame->format, i, frame->width);

        if (size <= converter->size[i])
            continue;
        free(converter->row[i]);
        converter->row[i] = malloc(size);
        converter->size[i] = converter->row[i] ? size : 0;
        if (!converter->row[i])
            return rf_capture_fail_memory(reason);
    }
    return REFOCUS_OK;
}

static void copy_row(struct refocus_converter *converter, const struct refocus_frame *frame,
                     int plane, int y)
{
    memcpy(converter->row[plane], frame->plane[plane] + y * frame->stride[plane],
           (size_t)rf_plane_row(frame->format, plane, frame->width));
}

int refocus_convert_rgb8(struct refocus_converter *converter, const struct refocus_frame *frame,
                         const struct refocus_image *out, struct refocus_reason *reason)
{
    struct refocus_reason unheard;
    struct refocus_frame own_frame;
    struct refocus_image own;
    struct coefficients c;
    int status;

    reason = reason ? reason : &unheard;
    reason->text[0] = '\0';
    if ((status = read_frame(&own_frame, frame, reason)))
        return status;
    if ((status = refocus_image_read(&own, out)))
        return rf_capture_fail(reason, status, "the picture is not of a known size of struct");
    frame = &own_frame;
    out = &own;
    if (!converter || !out->plane[0] || out->format != REFOCUS_FORMAT_RGB8 ||
        out->width != frame->width || out->height != frame->height ||
        !rf_stride_fits(out->stride[0], (int64_t)out->width * 3, out->height))
        return rf_capture_fail(reason, REFOCUS_ERR_ARGUMENT,
                               "the picture to convert into must be RGB8 of the frame's size");
    if (frame->format == REFOCUS_FRAME_MJPEG && frame->plane[0])
        return rf_convert_jpeg_rgb8(converter, frame, out, reason);
    status = check(frame, reason);
    if (status == REFOCUS_OK)
        status = reserve_rows(converter, frame, reason);
    if (status != REFOCUS_OK)
        return status;
    c = choose_coefficients(frame);
    for (int y = 0; y < frame->height; y++) {
        copy_row(converter, frame, 0, y);
        for (int i = 1; i < rf_format_planes(frame->format); i++)
            if (y % 2 == 0)
                copy_row(converter, frame, i, y / 2);
        convert_row(out->plane[0] + y * out->stride[0], converter->row, frame->format, frame->width,
                    &c);
    }
    return REFOCUS_OK;
}

uint32_t refocus_frame_image_format(uint32_t frame_format)
{
    switch (frame_format) {
    case REFOCUS_FRAME_YUYV:
    case REFOCUS_FRAME_UYVY:
        return REFOCUS_FORMAT_YUYV;
    case REFOCUS_FRAME_NV12:
        return REFOCUS_FORMAT_NV12;
    case REFOCUS_FRAME_NV21:
        return REFOCUS_FORMAT_NV21;
    case REFOCUS_FRAME_YUV420:
        return REFOCUS_FORMAT_I420;
    default:
        return REFOCUS_FORMAT_NONE;
    }
}

uint32_t refocus_convert_image_format(struct refocus_converter *converter,
                                      const struct refocus_frame *frame)
{
    struct refocus_reason unheard;
    struct refocus_frame own;

    if (!converter || read_frame(&own, frame, &unheard) != REFOCUS_OK)
        return REFOCUS_FORMAT_NONE;
    if (own.format == REFOCUS_FRAME_MJPEG)
        return own.plane[0] ? rf_jpeg_image_format(converter, &own) : (uint32_t)REFOCUS_FORMAT_NONE;
    return refocus_frame_image_format(own.format);
}

/* Whether a picture of that format can hold the frame. */
static bool fits(const struct refocus_frame *frame, uint32_t own, const struct refocus_image *out)
{
    if (out->format != own || out->width != frame->width || out->height != frame->height)
        return false;
    for (int i = 0; i < rf_format_planes(rf_frame_format_of(out->format)); i++) {
        const uint32_t format = rf_frame_format_of(out->format);

        if (!out->plane[i] || !rf_stride_fits(out->stride[i], rf_plane_row(format, i, out->width),
                                              rf_plane_rows(format, i, out->height)))
            return false;
    }
    return true;
}

int refocus_convert_copy(struct refocus_converter *converter, const struct refocus_frame *frame,
                         struct refocus_image *out, struct refocus_reason *reason)
{
    struct refocus_reason unheard;
    struct refocus_frame own_frame;
    struct refocus_image own;
    uint32_t format;
    int status;

    reason = reason ? reason : &unheard;
    reason->text[0] = '\0';
    if (!converter)
        return REFOCUS_ERR_ARGUMENT;
    if ((status = read_frame(&own_frame, frame, reason)))
        return status;
    frame = &own_frame;
    format = refocus_convert_image_format(converter, frame);
    if (!format)
        return rf_capture_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                               "frames of this format have to become RGB8");
    if ((status = refocus_image_read(&own, out)))
        return rf_capture_fail(reason, status, "the picture is not of a known size of struct");
    if (!fits(frame, format, &own))
        return rf_capture_fail(reason, REFOCUS_ERR_ARGUMENT,
                               "the picture to copy into must be like the frame");
    if (frame->format == REFOCUS_FRAME_MJPEG)
        return rf_convert_jpeg_yuv(converter, frame, out, reason);
    status = check(frame, reason);
    if (status == REFOCUS_OK)
        status = reserve_rows(converter, frame, reason);
    if (status != REFOCUS_OK)
        return status;
    out->matrix = frame->matrix;
    out->range =
        frame->flags & REFOCUS_FRAME_FULL_RANGE ? REFOCUS_RANGE_FULL : REFOCUS_RANGE_LIMITED;
    for (int i = 0; i < rf_format_planes(frame->format); i++) {
        const size_t bytes = (size_t)rf_plane_row(frame->format, i, frame->width);

        for (int y = 0; y < rf_plane_rows(rf_frame_format_of(out->format), i, out->height); y++) {
            uint8_t *row = out->plane[i] + y * out->stride[i];

            if (frame->format == REFOCUS_FRAME_UYVY) {
                copy_row(converter, frame, i, y);
                for (size_t x = 0; x < bytes; x++)
                    row[x] = converter->row[i][x ^ 1];
            } else {
                memcpy(row, frame->plane[i] + y * frame->stride[i], bytes);
            }
        }
    }
    return REFOCUS_OK;
}

int refocus_convert_samples(struct refocus_converter *converter, const struct refocus_frame *frame,
                            uint16_t *samples, struct refocus_reason *reason)
{
    struct refocus_reason unheard;
    struct refocus_frame own_frame;
    int status;

    reason = reason ? reason : &unheard;
    reason->text[0] = '\0';
    if (!converter || !samples)
        return REFOCUS_ERR_ARGUMENT;
    if ((status = read_frame(&own_frame, frame, reason)))
        return status;
    frame = &own_frame;
    if (frame->format != REFOCUS_FRAME_GREY && frame->format != REFOCUS_FRAME_Y16 &&
        frame->format != REFOCUS_FRAME_Z16)
        return rf_capture_fail(reason, REFOCUS_ERR_UNSUPPORTED,
                               "it is a colour format; depth comes as GREY, Y16 or Z16");
    status = check(frame, reason);
    if (status == REFOCUS_OK)
        status = reserve_rows(converter, frame, reason);
    if (status != REFOCUS_OK)
        return status;
    for (int y = 0; y < frame->height; y++, samples += frame->width) {
        const uint8_t *row = converter->row[0];

        copy_row(converter, frame, 0, y);
        if (frame->format == REFOCUS_FRAME_GREY)
            for (int x = 0; x < frame->width; x++)
                samples[x] = (uint16_t)(row[x] * 257);
        else
            for (int x = 0; x < frame->width; x++)
                samples[x] = (uint16_t)(row[2 * x] | row[2 * x + 1] << 8);
    }
    return REFOCUS_OK;
}
