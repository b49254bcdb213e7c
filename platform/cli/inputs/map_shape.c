/* map_shape.c: a depth map has its photo's shape, or lies on its side and is turned. */
#include "inputs/map_shape.h"
#include <stdlib.h>
#include "line/report.h"

static bool shape_is_told(int width, int height)
{
    enum { FEWEST = 16 };

    return width >= FEWEST && height >= FEWEST;
}

bool shape_is_another(int width, int height, const struct refocus_image *photo)
{
    const int64_t wide = (int64_t)width * photo->height;
    const int64_t high = (int64_t)height * photo->width;

    return shape_is_told(width, height) && width != height &&
           (2 * wide > 3 * high || 2 * high > 3 * wide);
}

bool shape_lies_on_its_side(int width, int height, const struct refocus_image *photo)
{
    return shape_is_another(width, height, photo) && !shape_is_another(height, width, photo);
}

bool shape_is_of_half(int width, int height, const struct refocus_image *photo)
{
    const int64_t twice = (int64_t)2 * width * photo->height;
    const int64_t high = (int64_t)height * photo->width;

    return shape_is_another(width, height, photo) && 20 * llabs(twice - high) <= high;
}

int shape_check(const char *file, int width, int height, const struct refocus_image *photo,
                const char *what)
{
    const int64_t wide = (int64_t)width * photo->height, high = (int64_t)height * photo->width;

    if (!shape_is_another(width, height, photo)) {
        if ((8 * wide > 9 * high || 8 * high > 9 * wide) && width != height &&
            shape_is_told(width, height) && shape_is_told(photo->width, photo->height))
            report_warning(file, "its %dx%d samples are stretched to the shape of the photo, %dx%d",
                           width, height, (int)photo->width, (int)photo->height);
        return EXIT_DONE;
    }
    return report_failure(EXIT_FAILED, file,
                          "its %dx%d samples have another shape than the photo of %dx%d pixels; "
                          "give the %s of this photo, as upright as the photo is",
                          width, height, (int)photo->width, (int)photo->height, what);
}
