/* read.c: reads the caller's pictures and maps of disparities, and says what is wrong with them. */
#include "image/read.h"

#include <stdbool.h>
#include <stdint.h>

#include "image/format.h"

/* Say that a member is out of its range. */
static int wrong(const struct rf_log *log, const char *name, const char *member, long long value,
                 const char *may_be)
{
    return rf_refuse(log, REFOCUS_ERR_ARGUMENT, "%s->%s is %lld, may be %s", name, member, value,
                     may_be);
}

/* 1 to REFOCUS_MAX_SIDE. */
static int check_sides(const struct rf_log *log, const char *name, int32_t width, int32_t height)
{
    const bool wide = width >= 1 && width <= REFOCUS_MAX_SIDE;

    if (wide && height >= 1 && height <= REFOCUS_MAX_SIDE)
        return REFOCUS_OK;
    return wrong(log, name, wide ? "height" : "width", wide ? height : width, "1 to 65535");
}

static int check_plane(const struct rf_log *log, const char *name,
                       const struct refocus_image *image, int plane)
{
    const ptrdiff_t bytes = refocus_plane_row_bytes(image->format, plane, image->width);

    if (!image->plane[plane])
        return rf_refuse(log, REFOCUS_ERR_ARGUMENT, "%s->plane[%d] is NULL", name, plane);
    if (!rf_good_stride(image->stride[plane], bytes,
                        refocus_plane_rows(image->format, plane, image->height)))
        return rf_refuse(log, REFOCUS_ERR_ARGUMENT,
                         "%s->stride[%d] is %lld, may be %lld or more either way", name, plane,
                         (long long)image->stride[plane], (long long)bytes);
    return REFOCUS_OK;
}

/* The fields that belong to deep formats. */
static int check_light(const struct rf_log *log, const char *name,
                       const struct refocus_image *image)
{
    const bool deep = rf_is_deep(image->format);

    if (image->transfer > (deep ? REFOCUS_TRANSFER_GAMMA : 0))
        return wrong(log, name, "transfer", image->transfer, deep ? "0 to 6" : "0 with 8 bits");
    if (image->gamma != 0 && !(deep && image->gamma >= 1 && image->gamma <= 5))
        return rf_refuse(log, REFOCUS_ERR_ARGUMENT, "%s->gamma is %.9g, may be 0%s", name,
                         (double)image->gamma, deep ? " or 1 to 5" : " with 8 bits");
    if (image->white != 0 && !(deep && image->white >= 1 / 65536.0f && image->white <= 65536))
        return rf_refuse(log, REFOCUS_ERR_ARGUMENT, "%s->white is %.9g, may be 0%s", name,
                         (double)image->white, deep ? " or 2^-16 to 2^16" : " with 8 bits");
    return image->reserved ? wrong(log, name, "reserved", image->reserved, "0") : REFOCUS_OK;
}

int rf_read_image(const struct rf_log *log, const char *name, struct refocus_image *own,
                  const struct refocus_image *given)
{
    const int status = rf_read_any_image(log, name, own, given);

    if (!status && rf_is_deep(own->format))
        return rf_refuse(log, REFOCUS_ERR_UNSUPPORTED, "%s->format is %u, may be 1 to 8 here", name,
                         (unsigned)own->format);
    return status;
}

int rf_read_any_image(const struct rf_log *log, const char *name, struct refocus_image *own,
                      const struct refocus_image *given)
{
    int status = rf_read_struct(log, name, own, sizeof *own,
                                REFOCUS_SIZE_TO(struct refocus_image, range), given);
    uint32_t most_matrix;

    if (status)
        return status;
    if (!refocus_format_planes(own->format))
        return wrong(log, name, "format", own->format, "1 to 16");
    most_matrix = rf_is_deep(own->format) ? REFOCUS_MATRIX_BT2020 : REFOCUS_MATRIX_BT709;
    if ((status = check_sides(log, name, own->width, own->height)))
        return status;
    if (refocus_format_is_yuv(own->format) && own->matrix > most_matrix)
        return wrong(log, name, "matrix", own->matrix, most_matrix > 1 ? "0 to 2" : "0 to 1");
    if (refocus_format_is_yuv(own->format) && own->range > REFOCUS_RANGE_FULL)
        return wrong(log, name, "range", own->range, "0 to 1");
    status = check_light(log, name, own);
    for (int i = 0; !status && i < refocus_format_planes(own->format); i++)
        status = check_plane(log, name, own, i);
    return status;
}

int rf_read_map(const struct rf_log *log, const char *name, struct refocus_disparity *own,
                const struct refocus_disparity *given)
{
    int status = rf_read_struct(log, name, own, sizeof *own,
                                REFOCUS_SIZE_TO(struct refocus_disparity, stride), given);

    if (status)
        return status;
    if (own->bits != 8 && own->bits != 16)
        return wrong(log, name, "bits", own->bits, "8 or 16");
    if ((status = check_sides(log, name, own->width, own->height)))
        return status;
    if (!own->samples)
        return rf_refuse(log, REFOCUS_ERR_ARGUMENT, "%s->samples is NULL", name);
    if (!rf_good_stride(own->stride, (ptrdiff_t)own->width * (own->bits / 8), own->height))
        return wrong(log, name, "stride", own->stride, "a row or more either way");
    if (own->bits == 16 && (((uintptr_t)own->samples | (uintptr_t)own->stride) & 1))
        return rf_refuse(log, REFOCUS_ERR_ARGUMENT,
                         "%s->samples or its stride is odd, must be even where bits is 16", name);
    return REFOCUS_OK;
}
