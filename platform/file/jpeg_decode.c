/* jpeg_decode.c: the pixels of a JPEG are decoded by TurboJPEG, which needs no jumps. */
#include "jpeg_decode.h"

#include <limits.h>
#include <string.h>
#include <turbojpeg.h>

#include "jpeg_walk.h"
#include "reason.h"

static int fail_jpeg(const struct rf_read *read, tjhandle jpeg)
{
    return rf_fail(read->reason, REFOCUS_ERR_FORMAT, "damaged JPEG: %s", tjGetErrorStr2(jpeg));
}

/* TurboJPEG paints a missing rest grey without an error, so the end of the picture must be there.
 */
static bool is_whole(struct rf_bytes file)
{
    struct rf_jpeg_walk walk;
    enum rf_jpeg_step step = RF_JPEG_SEGMENT;

    if (!rf_jpeg_walk_begin(&walk, file)) {
        return false;
    }
    while (step == RF_JPEG_SEGMENT) {
        step = rf_jpeg_walk_next(&walk);
    }
    return step == RF_JPEG_END;
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
    int status;

    memset(raster, 0, sizeof *raster);
    if (file.size > ULONG_MAX || !is_whole(file)) {
        return rf_fail(read->reason, REFOCUS_ERR_FORMAT,
                       "damaged JPEG: it ends in the middle of the picture; copy it again");
    }
    jpeg = tjInitDecompress();
    if (!jpeg) {
        return rf_fail_memory(read->reason);
    }
    status = read_header(read, jpeg, file, raster);
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
