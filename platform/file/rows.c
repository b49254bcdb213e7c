/* rows.c: whether the rows of a picture can lie in memory as they are said to. */
#include "rows.h"

#include <refocus/image.h>

int rf_format_bytes(uint32_t format)
{
    switch (format) {
    case REFOCUS_FORMAT_RGB8:
    case REFOCUS_FORMAT_BGR8:
        return 3;
    case REFOCUS_FORMAT_RGBA8:
    case REFOCUS_FORMAT_BGRA8:
        return 4;
    case REFOCUS_FORMAT_RGB16:
        return 6;
    case REFOCUS_FORMAT_RGB_FLOAT:
        return 12;
    default:
        return 0;
    }
}

bool rf_good_rows(ptrdiff_t stride, int64_t bytes, int64_t rows)
{
    const int64_t most = PTRDIFF_MAX / rows;

    return stride >= -most && stride <= most && (rows == 1 || stride >= bytes || stride <= -bytes);
}
