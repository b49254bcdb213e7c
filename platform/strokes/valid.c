/* valid.c: whether strokes, fills, photos and maps are what refocus/platform/strokes.h allows. */
#include "valid.h"

#include <math.h>

bool rf_in_bounds(float value, float least, float greatest)
{
    return value >= least && value <= greatest;
}

static bool fill_is_valid(const struct refocus_fill *fill)
{
    const float far = 1048576;

    if (fill->kind == REFOCUS_FILL_NONE)
        return true;
    if (fill->kind > REFOCUS_FILL_GRADIENT || !rf_in_bounds(fill->d0, 0, 1))
        return false;
    return fill->kind == REFOCUS_FILL_SOLID ||
           (rf_in_bounds(fill->d1, 0, 1) && rf_in_bounds(fill->x0, -far, far) &&
            rf_in_bounds(fill->y0, -far, far) && rf_in_bounds(fill->x1, -far, far) &&
            rf_in_bounds(fill->y1, -far, far) &&
            fmax(fabs((double)fill->x1 - (double)fill->x0),
                 fabs((double)fill->y1 - (double)fill->y0)) >= 1);
}

bool rf_has_points(uint32_t kind)
{
    return kind != REFOCUS_STROKE_ALL && kind != REFOCUS_STROKE_FILL;
}

bool rf_begins_layer(uint32_t kind)
{
    return kind == REFOCUS_STROKE_ALL || kind == REFOCUS_STROKE_OBJECT ||
           kind == REFOCUS_STROKE_BRUSH;
}

static bool selects(uint32_t kind)
{
    return kind == REFOCUS_STROKE_OBJECT || kind == REFOCUS_STROKE_MORE;
}

bool rf_stroke_is_valid(const struct refocus_stroke *stroke)
{
    return stroke->kind <= REFOCUS_STROKE_FILL && fill_is_valid(&stroke->fill) &&
           (!rf_has_points(stroke->kind) || rf_in_bounds(stroke->radius, (float)0.5, 4096)) &&
           (!selects(stroke->kind) || rf_in_bounds(stroke->reach, 1, 64)) &&
           (stroke->kind != REFOCUS_STROKE_FILL || stroke->fill.kind != REFOCUS_FILL_NONE);
}

bool rf_is_stride(ptrdiff_t stride, ptrdiff_t bytes, int32_t rows)
{
    const ptrdiff_t most = PTRDIFF_MAX / rows;

    return stride >= -most && stride <= most && (rows == 1 || stride >= bytes || stride <= -bytes);
}

bool rf_is_photo(const struct refocus_image *photo)
{
    return photo->format >= REFOCUS_FORMAT_RGB8 && photo->format <= REFOCUS_FORMAT_BGRA8 &&
           photo->plane[0] && photo->width >= 1 && photo->width <= REFOCUS_MAX_SIDE &&
           photo->height >= 1 && photo->height <= REFOCUS_MAX_SIDE &&
           rf_is_stride(photo->stride[0], refocus_plane_row_bytes(photo->format, 0, photo->width),
                        photo->height);
}

bool rf_is_base(const struct refocus_disparity *base, const struct refocus_image *photo)
{
    return base->width == photo->width && base->height == photo->height && base->samples &&
           (base->bits == 8 || base->bits == 16) &&
           rf_is_stride(base->stride, (ptrdiff_t)base->width * (base->bits / 8), base->height);
}
