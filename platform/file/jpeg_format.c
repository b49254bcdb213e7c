/* jpeg_format.c: JPEG as a picture format, which needs TurboJPEG. */
#include "format.h"
#include "jpeg_read.h"
#include "jpeg_walk.h"
#include "jpeg_write.h"

const struct rf_format rf_format_jpeg = {
    .name = "JPEG",
    .library = "TurboJPEG",
    .endings = {".jpg", ".jpeg"},
    .writes_pictures = true,
    .has_second = true,
    .recognise = rf_is_jpeg,
#ifdef RF_HAVE_JPEG
    .read = rf_read_jpeg,
    .write = rf_write_jpeg,
#endif
};
