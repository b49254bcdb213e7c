/* What formats answer that this build was made without. */
#ifndef RF_FILE_ABSENT_H
#define RF_FILE_ABSENT_H

static inline int rf_absent_format(struct refocus_reason *reason, const char *format,
                                   const char *library)
{
    return rf_fail(reason, REFOCUS_ERR_UNSUPPORTED, "this build has no %s; build it with %s",
                   format, library);
}

#ifndef RF_HAVE_JPEG
#define rf_read_jpeg(read, file)                                                                   \
    ((void)(file), rf_absent_format((read)->reason, "JPEG", "TurboJPEG"))
#define rf_jpeg_decode(read, file, raster)                                                         \
    ((void)(file), (void)(raster), rf_absent_format((read)->reason, "JPEG", "TurboJPEG"))
#define rf_write_jpeg(store, rows, options, reason)                                                \
    ((void)(options), rf_absent_format(reason, "JPEG", "TurboJPEG"))
#endif

#ifndef RF_HAVE_PNG
#define rf_read_png(read, file) ((void)(file), rf_absent_format((read)->reason, "PNG", "libpng"))
#define rf_png_decode(read, file, raster, exif, icc)                                               \
    ((void)(file), (void)(raster), rf_absent_format((read)->reason, "PNG", "libpng"))
#define rf_write_png(store, rows, options, reason)                                                 \
    ((void)(options), rf_absent_format(reason, "PNG", "libpng"))
#endif

#ifndef RF_HAVE_HEIC
#define rf_read_heic(read, file) ((void)(file), rf_absent_format((read)->reason, "HEIC", "libheif"))
#endif

#endif
