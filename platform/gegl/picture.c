/* picture.c: photos and depth maps are read out of GEGL's buffers. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "picture.h"

static BablModelFlag flags_of(const Babl *format)
{
    return babl_get_model_flags(babl_format_get_model(format));
}

/* The curve of a space is that of sRGB, so that its codes are those that the library averages by.
 */
static bool is_srgb_curve(const Babl *space)
{
    const Babl *red, *green, *blue, *srgb = babl_trc("sRGB");

    if (!space)
        return true;
    babl_space_get(space, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, &red, &green, &blue);
    return red == srgb && green == srgb && blue == srgb;
}

static enum rf_gegl_depth depth_of(const Babl *photo, const Babl *space)
{
    const Babl *type;
    BablModelFlag flags;

    if (!photo)
        return RF_GEGL_FLOATS;
    if (babl_format_is_palette(photo))
        return is_srgb_curve(space) ? RF_GEGL_CODES_8 : RF_GEGL_CODES_16;
    type = babl_format_get_type(photo, 0);
    flags = flags_of(photo);
    if ((flags & BABL_MODEL_FLAG_ASSOCIATED) ||
        !(flags & (BABL_MODEL_FLAG_RGB | BABL_MODEL_FLAG_GRAY)))
        return RF_GEGL_FLOATS;
    if (type == babl_type("u16"))
        return RF_GEGL_CODES_16;
    if (type != babl_type("u8"))
        return RF_GEGL_FLOATS;
    if ((flags & BABL_MODEL_FLAG_NONLINEAR) && is_srgb_curve(space))
        return RF_GEGL_CODES_8;
    return flags & BABL_MODEL_FLAG_PERCEPTUAL ? RF_GEGL_CODES_8 : RF_GEGL_CODES_16;
}

/* R'G'B' where its curve is sRGB's: what is stored so is copied. Else R~G~B~, whose curve always
 * is. */
static const Babl *babl_of(enum rf_gegl_depth depth, bool has_alpha, const Babl *space)
{
    static const char *const names[][2][2] = {
        [RF_GEGL_CODES_8] = {{"R~G~B~ u8", "R~G~B~A u8"}, {"R'G'B' u8", "R'G'B'A u8"}},
        [RF_GEGL_CODES_16] = {{"R~G~B~ u16", "R~G~B~A u16"}, {"R'G'B' u16", "R'G'B'A u16"}},
        [RF_GEGL_FLOATS] = {{"RGB float", "RGBA float"}, {"RGB float", "RGBA float"}},
    };

    return babl_format_with_space(names[depth][is_srgb_curve(space)][has_alpha], space);
}

struct rf_gegl_format rf_gegl_format_of(const Babl *photo, const Babl *space)
{
    struct rf_gegl_format format = {depth_of(photo, space), true, space, NULL};

    if (photo)
        format.has_alpha = babl_format_has_alpha(photo);
    format.babl = babl_of(format.depth, format.has_alpha, space);
    return format;
}

static uint32_t core_format(enum rf_gegl_depth depth, bool has_alpha)
{
    static const uint32_t formats[][2] = {
        [RF_GEGL_CODES_8] = {REFOCUS_FORMAT_RGB8, REFOCUS_FORMAT_RGBA8},
        [RF_GEGL_CODES_16] = {REFOCUS_FORMAT_RGB16, REFOCUS_FORMAT_RGBA16},
        [RF_GEGL_FLOATS] = {REFOCUS_FORMAT_RGB_FLOAT, REFOCUS_FORMAT_RGBA_FLOAT},
    };

    return formats[depth][has_alpha];
}

static struct refocus_image image_of(enum rf_gegl_depth depth, bool has_alpha,
                                     const GeglRectangle *size)
{
    const uint32_t format = core_format(depth, has_alpha);
    const uint64_t bytes = refocus_image_bytes(format, size->width, size->height);

    return refocus_image_packed(format, bytes && bytes <= SIZE_MAX ? malloc((size_t)bytes) : NULL,
                                size->width, size->height,
                                refocus_plane_row_bytes(format, 0, size->width));
}

static bool has_light_above_white(const struct refocus_image *photo, bool has_alpha)
{
    const size_t samples = (size_t)photo->width * (has_alpha ? 4 : 3);

    for (int32_t y = 0; y < photo->height; y++) {
        const float *const row = (const float *)(photo->plane[0] + y * photo->stride[0]);

        for (size_t i = 0; i < samples; i++)
            if (row[i] > 1 && isfinite(row[i]) && !(has_alpha && i % 4 == 3))
                return true;
    }
    return false;
}

/* Light that was clipped at white is looked for by the library in codes alone. */
static void clip(struct refocus_image *photo, GeglBuffer *buffer, const GeglRectangle *whole,
                 const struct rf_gegl_format *format)
{
    const uint32_t codes = core_format(RF_GEGL_CODES_16, format->has_alpha);

    photo->format = codes;
    photo->stride[0] = refocus_plane_row_bytes(codes, 0, photo->width);
    gegl_buffer_get(buffer, whole, 1, babl_of(RF_GEGL_CODES_16, format->has_alpha, format->space),
                    photo->plane[0], (gint)photo->stride[0], GEGL_ABYSS_NONE);
}

void rf_gegl_picture_free(struct rf_gegl_picture *picture)
{
    if (picture->out.plane[0] != picture->photo.plane[0])
        free(picture->out.plane[0]);
    free(picture->photo.plane[0]);
    memset(picture, 0, sizeof *picture);
}

bool rf_gegl_picture_read(struct rf_gegl_picture *picture, GeglBuffer *buffer,
                          const GeglRectangle *whole, const GeglRectangle *part,
                          const struct rf_gegl_format *format, enum rf_gegl_light light)
{
    struct refocus_image *const photo = &picture->photo, *const out = &picture->out;
    const uint32_t pixels = core_format(format->depth, format->has_alpha);

    memset(picture, 0, sizeof *picture);
    *photo = image_of(format->depth, format->has_alpha, whole);
    if (!photo->plane[0])
        return false;
    if (format->depth == RF_GEGL_CODES_8)
        *out = refocus_image_packed(pixels, photo->plane[0], part->width, part->height,
                                    refocus_plane_row_bytes(pixels, 0, part->width));
    else
        *out = image_of(format->depth, format->has_alpha, part);
    if (!out->plane[0]) {
        rf_gegl_picture_free(picture);
        return false;
    }
    gegl_buffer_get(buffer, whole, 1, format->babl, photo->plane[0], (gint)photo->stride[0],
                    GEGL_ABYSS_NONE);
    if (format->depth == RF_GEGL_FLOATS &&
        (light == RF_GEGL_PHOTO ||
         (light == RF_GEGL_AUTO && !has_light_above_white(photo, format->has_alpha))))
        clip(photo, buffer, whole, format);
    return true;
}

static const Babl *depth_format(const Babl *stored, enum rf_gegl_values values)
{
    static const char *const names[][2] = {
        [RF_GEGL_STORED] = {"Y' float", "Y'A float"},
        [RF_GEGL_PERCEPTUAL] = {"Y~ float", "Y~A float"},
        [RF_GEGL_LINEAR] = {"Y float", "YA float"},
    };
    const BablModelFlag flags = flags_of(stored);

    if (values == RF_GEGL_STORED && (flags & BABL_MODEL_FLAG_LINEAR))
        values = RF_GEGL_LINEAR;
    if (values == RF_GEGL_STORED && (flags & BABL_MODEL_FLAG_PERCEPTUAL))
        values = RF_GEGL_PERCEPTUAL;
    return babl_format_with_space(names[values][babl_format_has_alpha(stored)],
                                  babl_format_get_space(stored));
}

float *rf_gegl_depth_read(GeglBuffer *buffer, const GeglRectangle *whole,
                          enum rf_gegl_values values)
{
    const Babl *const format = depth_format(gegl_buffer_get_format(buffer), values);
    const int bytes = babl_format_get_bytes_per_pixel(format);
    const uint64_t count = (uint64_t)whole->width * (uint64_t)whole->height;
    float *const samples =
        count <= SIZE_MAX / (unsigned)bytes ? malloc((size_t)count * (size_t)bytes) : NULL;

    if (!samples)
        return NULL;
    gegl_buffer_get(buffer, whole, 1, format, samples, bytes * whole->width, GEGL_ABYSS_NONE);
    if (babl_format_has_alpha(format))
        for (size_t i = 0; i < count; i++)
            samples[i] = samples[2 * i + 1] > 0 ? samples[2 * i] : NAN;
    return samples;
}
