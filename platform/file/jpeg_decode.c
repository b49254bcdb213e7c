/* jpeg_decode.c: the pixels of a JPEG are decoded by TurboJPEG, which needs no jumps. */
#include "jpeg_decode.h"

#include <string.h>
#include <turbojpeg.h>

#include "jpeg_walk.h"
#include "reason.h"

static int fail_jpeg(const struct rf_read *read, tjhandle jpeg)
{
    return rf_fail(read->reason, REFOCUS_ERR_FORMAT, "damaged JPEG: %s", tjGetErrorStr2(jpeg));
}

enum { MARKER_SOS = 0xda };

/* Count the scans. TurboJPEG paints a missing rest grey without an error, so the end of the picture
 * must be there. */
static int survey(const struct rf_read *read, struct rf_bytes file, uint32_t *scans)
{
    struct rf_jpeg_walk walk;
    enum rf_jpeg_step step = RF_JPEG_DAMAGED;
    uint32_t segments = 0;

    *scans = 0;
    if (rf_jpeg_walk_begin(&walk, file)) {
        while ((step = rf_jpeg_walk_next(&walk)) == RF_JPEG_SEGMENT) {
            *scans += walk.marker == MARKER_SOS;
            if (++segments > read->limits.max_segments || *scans > read->limits.max_scans) {
                return rf_fail(
                    read->reason, REFOCUS_ERR_SIZE, "its %s are more than the limit of %u",
                    *scans > read->limits.max_scans ? "scans" : "segments",
                    (unsigned)(*scans > read->limits.max_scans ? read->limits.max_scans
                                                               : read->limits.max_segments));
            }
        }
    }
    return step == RF_JPEG_END
               ? REFOCUS_OK
               : rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                         "damaged JPEG: it ends in the middle of the picture; copy it again");
}

/* Each scan goes over all blocks, and of several scans all coefficients are kept, 2 bytes each. */
static int check_work(const struct rf_read *read, const struct rf_raster *raster, uint32_t scans)
{
    const uint64_t pixels = (uint64_t)raster->width * (uint64_t)raster->height;

    if (pixels * scans / 20 > read->limits.max_pixels) {
        return rf_fail(read->reason, REFOCUS_ERR_SIZE,
                       "its %u scans of %d x %d pixels take too long; save it with fewer",
                       (unsigned)scans, (int)raster->width, (int)raster->height);
    }
    return rf_check_memory(read, pixels * (uint64_t)raster->channels * (scans > 1 ? 3 : 1));
}

static int read_header(const struct rf_read *read, tjhandle jpeg, struct rf_bytes file,
                       struct rf_raster *raster)
{
    int width = 0, height = 0, sampling = -1, space = -1;

    /* It refuses rare chroma samplings here although it decodes them: judge by the
     * rest. */
    tjDecompressHeader3(jpeg, file.data, (unsigned long)file.size, &width, &height, &sampling,
                        &space);
    if (width < 1 || height < 1 || space < 0) {
        return fail_jpeg(read, jpeg);
    }
    if (space == TJCS_CMYK || space == TJCS_YCCK) {
        return rf_fail(read->reason, REFOCUS_ERR_UNSUPPORTED,
                       "it is a JPEG for print (CMYK); convert it to RGB");
    }
    raster->width = width;
    raster->height = height;
    raster->channels = space == TJCS_GRAY ? 1 : 3;
    raster->sample = REFOCUS_SAMPLE_U8;
    raster->max_value = 255;
    raster->lossy = true;
    return rf_check_size(read, (uint64_t)width, (uint64_t)height, (uint64_t)raster->channels);
}

/* Some cameras leave a few bytes too many before a marker: every decoder skips them.
 * More are a sign that the decoder lost its way earlier. */
static bool few_bytes_too_many(const char *words)
{
    static const char before[] = "Corrupt JPEG data: ";
    const char *const end = strstr(words, " extraneous bytes");

    return strncmp(words, before, sizeof before - 1) == 0 && end &&
           end - words <= (ptrdiff_t)sizeof before + 1; /* two digits */
}

static int read_pixels(const struct rf_read *read, tjhandle jpeg, struct rf_bytes file,
                       struct rf_raster *raster)
{
    const int format = raster->channels == 1 ? TJPF_GRAY : TJPF_RGB;
    int flags = TJFLAG_ACCURATEDCT | TJFLAG_LIMITSCANS | TJFLAG_STOPONWARNING;
    int failed =
        tjDecompress2(jpeg, file.data, (unsigned long)file.size, raster->pixels, raster->width,
                      (int)rf_raster_stride(raster), raster->height, format, flags);

    if (failed && few_bytes_too_many(tjGetErrorStr2(jpeg))) {
        flags &= ~TJFLAG_STOPONWARNING;
        failed =
            tjDecompress2(jpeg, file.data, (unsigned long)file.size, raster->pixels, raster->width,
                          (int)rf_raster_stride(raster), raster->height, format, flags) != 0 &&
            tjGetErrorCode(jpeg) != TJERR_WARNING;
    }
    return failed ? fail_jpeg(read, jpeg) : REFOCUS_OK;
}

int rf_jpeg_decode(const struct rf_read *read, struct rf_bytes file, struct rf_raster *raster)
{
    tjhandle jpeg;
    uint32_t scans;
    int status;

    memset(raster, 0, sizeof *raster);
    if ((status = survey(read, file, &scans)) != REFOCUS_OK) {
        return status;
    }
    jpeg = tjInitDecompress();
    if (!jpeg) {
        return rf_fail_memory(read->reason);
    }
    status = read_header(read, jpeg, file, raster);
    if (status == REFOCUS_OK) {
        status = check_work(read, raster, scans);
    }
    if (status == REFOCUS_OK) {
        status = rf_raster_alloc(read, raster);
    }
    if (status == REFOCUS_OK) {
        status = read_pixels(read, jpeg, file, raster);
    }
    if (status != REFOCUS_OK) {
        rf_raster_free(raster);
    }
    tjDestroy(jpeg);
    return status;
}
