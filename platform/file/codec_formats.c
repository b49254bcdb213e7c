/* codec_formats.c: the picture formats that are modules, each in a folder of its own: how their
 * files begin. */
#include <string.h>

#include "codec_format.h"

static bool begins(struct rf_bytes file, const char *text, size_t size)
{
    return file.size >= size && memcmp(file.data, text, size) == 0;
}

/* TIFF 6.0, and BigTIFF */
static bool is_tiff(struct rf_bytes file)
{
    return begins(file, "II*\0", 4) || begins(file, "MM\0*", 4) || begins(file, "II+\0", 4) ||
           begins(file, "MM\0+", 4);
}

static bool is_openexr(struct rf_bytes file)
{
    return begins(file, "\x76\x2f\x31\x01", 4);
}

#ifdef RF_HAVE_TIFF
RF_CODEC_READ(tiff)
RF_CODEC_WRITE(tiff)
#endif
const struct rf_format rf_format_tiff = {
    .name = "TIFF",
    .library = "libtiff",
    .endings = {".tif", ".tiff"},
    .writes_pictures = true,
    .writes_depth = true,
    .deep = REFOCUS_FORMAT_RGB16,
    .recognise = is_tiff,
#ifdef RF_HAVE_TIFF
    .read = read_tiff,
    .write = write_tiff,
#endif
};

#ifdef RF_HAVE_OPENEXR
RF_CODEC_READ(openexr)
RF_CODEC_WRITE(openexr)
#endif
const struct rf_format rf_format_openexr = {
    .name = "OpenEXR",
    .library = "OpenEXR",
    .endings = {".exr"},
    .writes_pictures = true,
    .deep = REFOCUS_FORMAT_RGB_FLOAT,
    .recognise = is_openexr,
#ifdef RF_HAVE_OPENEXR
    .read = read_openexr,
    .write = write_openexr,
#endif
};

static bool is_webp(struct rf_bytes file)
{
    return begins(file, "RIFF", 4) && file.size >= 12 && memcmp(file.data + 8, "WEBP", 4) == 0;
}

#ifdef RF_HAVE_WEBP
RF_CODEC_READ(webp)
#endif
const struct rf_format rf_format_webp = {
    .name = "WebP",
    .library = "libwebp",
    .recognise = is_webp,
#ifdef RF_HAVE_WEBP
    .read = read_webp,
#endif
};

/* A stream by itself, or in boxes. */
static bool is_jxl(struct rf_bytes file)
{
    return begins(file, "\xff\x0a", 2) || begins(file, "\0\0\0\x0cJXL \r\n\x87\n", 12);
}

#ifdef RF_HAVE_JXL
RF_CODEC_READ(jxl)
#endif
const struct rf_format rf_format_jxl = {
    .name = "JPEG-XL",
    .library = "libjxl",
    .recognise = is_jxl,
#ifdef RF_HAVE_JXL
    .read = read_jxl,
#endif
};

/* Any ZIP archive. */
static bool is_npz(struct rf_bytes file)
{
    return begins(file, "PK\3\4", 4) || begins(file, "PK\5\6", 4);
}

#ifdef RF_HAVE_NPZ
RF_CODEC_READ(npz)
#endif
const struct rf_format rf_format_npz = {
    .name = "NPZ",
    .library = "libzip",
    .recognise = is_npz,
#ifdef RF_HAVE_NPZ
    .read = read_npz,
#endif
};
