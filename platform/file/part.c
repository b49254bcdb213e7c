/* part.c: a PNG or JPEG that lies inside another file is decoded. */
#include "part.h"

#include "jpeg_decode.h"
#include "jpeg_walk.h"
#include "png_format.h"
#include "png_read.h"
#include "reason.h"

/* Decoders, not readers: a reader of JPEG looks for parts itself. */
static const struct {
    bool (*recognise)(struct rf_bytes file);
    /* NULL: the library is missing. */
    int (*decode)(const struct rf_read *read, struct rf_bytes file, struct rf_raster *raster);
    const char *name, *library;
} decoders[] = {
#ifdef RF_HAVE_JPEG
    {rf_is_jpeg, rf_jpeg_decode, "JPEG", "TurboJPEG"},
#else
    {rf_is_jpeg, NULL, "JPEG", "TurboJPEG"},
#endif
#ifdef RF_HAVE_PNG
    {rf_is_png, rf_png_decode, "PNG", "libpng"},
#else
    {rf_is_png, NULL, "PNG", "libpng"},
#endif
};

int rf_decode_part(const struct rf_read *read, struct rf_bytes part, const char *what,
                   struct rf_raster *raster)
{
    for (size_t i = 0; i < sizeof decoders / sizeof *decoders; i++) {
        int status;

        if (!decoders[i].recognise(part))
            continue;
        status = decoders[i].decode
                     ? decoders[i].decode(read, part, raster)
                     : rf_fail_absent(read->reason, decoders[i].name, decoders[i].library);
        if (status != REFOCUS_OK) {
            struct refocus_reason inner = *read->reason;
            inner.text[sizeof inner.text - 32] = '\0';
            rf_fail(read->reason, status, "%s: %s", what, inner.text);
        }
        return status;
    }
    return rf_fail(read->reason, REFOCUS_ERR_FORMAT, "damaged: its %s is neither PNG nor JPEG",
                   what);
}

/* All of FFC0 to FFCF begin a frame but those of tables and extensions. */
static bool begins_frame(int marker)
{
    return marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
}

uint64_t rf_part_pixels(struct rf_bytes part)
{
    struct rf_jpeg_walk walk;

    if (rf_is_png(part) && part.size >= 24)
        return (uint64_t)rf_big_endian(part.data + 16, 4) * rf_big_endian(part.data + 20, 4);
    if (rf_jpeg_walk_begin(&walk, part)) {
        while (rf_jpeg_walk_next(&walk) == RF_JPEG_SEGMENT) {
            if (begins_frame(walk.marker) && walk.segment.size >= 5) {
                return (uint64_t)rf_big_endian(walk.segment.data + 1, 2) *
                       rf_big_endian(walk.segment.data + 3, 2);
            }
        }
    }
    return 0;
}
