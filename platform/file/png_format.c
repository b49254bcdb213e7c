/* png_format.c: PNG as a picture format, which needs libpng. */
#include "png_format.h"

#include <string.h>

#include "format.h"
#include "png_read.h"
#include "png_write.h"

bool rf_is_png(struct rf_bytes file)
{
    return file.size >= 8 && memcmp(file.data, "\x89PNG\r\n\x1a\n", 8) == 0;
}

const struct rf_format rf_format_png = {
    .name = "PNG",
    .library = "libpng",
    .endings = {".png"},
    .writes_pictures = true,
    .writes_depth = true,
    .deep = REFOCUS_FORMAT_RGB16,
    .recognise = rf_is_png,
#ifdef RF_HAVE_PNG
    .read = rf_read_png,
    .write = rf_write_png,
#endif
};
