/* orient.c: pictures are turned upright by their EXIF orientation, once, when they are read. */
#include "orient.h"

#include <string.h>

/* The place of the upright picture's pixel (0, 0) in the stored one, and the steps, in pixels, to
 * its right and lower neighbours; from EXIF 2.3, table of tag 274. */
struct steps {
    ptrdiff_t origin, right, down;
};

static struct steps find_steps(ptrdiff_t w, ptrdiff_t h, int orientation)
{
    const ptrdiff_t last_row = (h - 1) * w;

    switch (orientation) {
    case 2: /* mirrored left to right */
        return (struct steps){w - 1, -1, w};
    case 3: /* turned by 180 degrees */
        return (struct steps){last_row + w - 1, -1, -w};
    case 4: /* mirrored top to bottom */
        return (struct steps){last_row, 1, -w};
    case 5: /* rows are columns */
        return (struct steps){0, w, 1};
    case 6: /* to be turned clockwise */
        return (struct steps){last_row, -w, 1};
    case 7: /* rows are columns, from the other corner */
        return (struct steps){last_row + w - 1, -w, -1};
    case 8: /* to be turned anticlockwise */
        return (struct steps){w - 1, w, -1};
    default:
        return (struct steps){0, 1, w};
    }
}

int rf_raster_orient(const struct rf_read *read, struct rf_raster *raster, int orientation)
{
    const size_t bytes = (size_t)raster->channels * rf_sample_bytes(raster->sample);
    const struct steps steps = find_steps(raster->width, raster->height, orientation);
    struct rf_raster upright = *raster;
    uint8_t *to;
    int status;

    if (orientation <= 1 || !raster->pixels)
        return REFOCUS_OK;
    if (orientation >= 5) {
        upright.width = raster->height;
        upright.height = raster->width;
    }
    status = rf_raster_alloc(read, &upright);
    if (status != REFOCUS_OK)
        return status;
    to = upright.pixels;
    for (int32_t y = 0; y < upright.height; y++) {
        ptrdiff_t from = steps.origin + y * steps.down;
        for (int32_t x = 0; x < upright.width; x++) {
            memcpy(to, raster->pixels + (size_t)from * bytes, bytes);
            to += bytes;
            from += steps.right;
        }
    }
    rf_raster_free(raster);
    *raster = upright;
    return REFOCUS_OK;
}

void rf_orient_point(double *x, double *y, int orientation)
{
    const double u = *x, v = *y;

    switch (orientation) {
    case 2:
        *x = 1 - u;
        break;
    case 3:
        *x = 1 - u;
        *y = 1 - v;
        break;
    case 4:
        *y = 1 - v;
        break;
    case 5:
        *x = v;
        *y = u;
        break;
    case 6:
        *x = 1 - v;
        *y = u;
        break;
    case 7:
        *x = 1 - v;
        *y = 1 - u;
        break;
    case 8:
        *x = v;
        *y = 1 - u;
        break;
    default:
        break;
    }
}

int rf_orient_inverse(int orientation)
{
    return orientation == 6 ? 8 : orientation == 8 ? 6 : orientation;
}

int rf_orient_both(int first, int second)
{
    int orientation = 1;

    /* No two orientations bring this point to the same place. */
    for (; orientation < 8; orientation++) {
        double x = 0.125, y = 0.25, u = x, v = y;

        rf_orient_point(&x, &y, first);
        rf_orient_point(&x, &y, second);
        rf_orient_point(&u, &v, orientation);
        if (x == u && y == v)
            break;
    }
    return orientation;
}
