/* jpeg_decode.c: the pixels of a JPEG are decoded by TurboJPEG, which needs no jumps. */
#include "jpeg_decode.h"

#include <stdlib.h>
#include <string.h>
#include <turbojpeg.h>

#include "jpeg_chroma.h"
#include "jpeg_walk.h"
#include "reason.h"

static int fail_jpeg(const struct rf_read *read, tjhandle jpeg)
{
    return rf_fail(read->reason, REFOCUS_ERR_FORMAT, "damaged JPEG: %s", tjGetErrorStr2(jpeg));
}

enum { MARKER_SOS = 0xda, MARKER_DQT = 0xdb, MARKER_APP14 = 0xee };
enum { MARKER_SOF0 = 0xc0, MARKER_SOF2 = 0xc2, MARKER_SOF15 = 0xcf };
enum { MARKER_DHT = 0xc4, MARKER_JPG = 0xc8, MARKER_DAC = 0xcc, MARKER_SOF9 = 0xc9 };

static bool is_frame(int marker)
{
    return marker >= MARKER_SOF0 && marker <= MARKER_SOF15 && marker != MARKER_DHT &&
           marker != MARKER_JPG && marker != MARKER_DAC;
}

/* ITU-T T.81 has kinds that few programs read: of 12 bits, without loss, of several sizes. */
static bool is_rare_kind(const struct rf_jpeg_walk *walk)
{
    const int marker = walk->marker;
    const bool known = marker <= MARKER_SOF2 || marker == MARKER_SOF9 || marker == MARKER_SOF9 + 1;

    return is_frame(marker) && (!known || (walk->segment.size > 0 && walk->segment.data[0] == 12));
}

struct survey {
    uint32_t scans;
    bool adobe;  /* Adobe wrote it. */
    int step[4]; /* for the lowest frequency, by table */
    int chroma;  /* the table of the second component */
};

/* Tables are a byte, precision and number, and 64 values of one byte or two, the mean first. */
static void survey_tables(struct survey *survey, struct rf_bytes segment)
{
    for (size_t at = 0, size; at < segment.size; at += 1 + 64 * size) {
        const uint8_t *table = segment.data + at + 1;

        size = segment.data[at] >> 4 ? 2 : 1;
        if (segment.size - at < 1 + 64 * size)
            return;
        survey->step[segment.data[at] & 3] = size == 1 ? table[1] : table[2] << 8 | table[3];
    }
}

/* Looks at the segments. TurboJPEG paints a missing rest grey without an error, so the end of the
 * picture must be there. */
static int survey_file(const struct rf_read *read, struct rf_bytes file, struct survey *survey)
{
    enum { CHROMA = 11 }; /* the second of three bytes for each component ends there */
    struct rf_jpeg_walk walk;
    enum rf_jpeg_step step = RF_JPEG_DAMAGED;
    uint32_t segments = 0;

    memset(survey, 0, sizeof *survey);
    if (rf_jpeg_walk_begin(&walk, file)) {
        while ((step = rf_jpeg_walk_next(&walk)) == RF_JPEG_SEGMENT) {
            if (is_rare_kind(&walk)) {
                return rf_fail(read->reason, REFOCUS_ERR_UNSUPPORTED,
                               "it is a JPEG of 12 bits or without loss, which is not read; save "
                               "it as PNG or TIFF");
            }
            survey->scans += walk.marker == MARKER_SOS;
            survey->adobe |= walk.marker == MARKER_APP14 && walk.segment.size >= 5 &&
                             memcmp(walk.segment.data, "Adobe", 5) == 0;
            if (walk.marker == MARKER_DQT)
                survey_tables(survey, walk.segment);
            if (is_frame(walk.marker) && walk.segment.size > CHROMA)
                survey->chroma = walk.segment.data[CHROMA] & 3;
            if (++segments > read->limits.max_segments || survey->scans > read->limits.max_scans) {
                const bool scans = survey->scans > read->limits.max_scans;

                return rf_fail(
                    read->reason, REFOCUS_ERR_SIZE, "its %s are more than the limit of %u",
                    scans ? "scans" : "segments",
                    (unsigned)(scans ? read->limits.max_scans : read->limits.max_segments));
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
                       struct rf_raster *raster, bool *half)
{
    int width = 0, height = 0, sampling = -1, space = -1;

    /* It refuses rare chroma samplings here although it decodes them: judge by the
     * rest. */
    tjDecompressHeader3(jpeg, file.data, (unsigned long)file.size, &width, &height, &sampling,
                        &space);
    if (width < 1 || height < 1 || space < 0)
        return fail_jpeg(read, jpeg);
    raster->width = width;
    raster->height = height;
    raster->channels = space == TJCS_GRAY ? 1 : space == TJCS_CMYK || space == TJCS_YCCK ? 4 : 3;
    raster->sample = REFOCUS_SAMPLE_U8;
    raster->max_value = 255;
    raster->lossy = true;
    *half = space == TJCS_YCbCr && sampling == TJSAMP_420;
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

/* The planes that a JPEG with colour of half the size stores, behind each other. */
struct planes {
    uint8_t *plane[3];
    int stride[3];
};

/* One try: the pixels, or the planes where there are some. */
static int decode(tjhandle jpeg, struct rf_bytes file, struct rf_raster *raster,
                  struct planes *planes, int flags)
{
    const unsigned long size = (unsigned long)file.size;
    const int format = raster->channels == 1   ? TJPF_GRAY
                       : raster->channels == 4 ? TJPF_CMYK
                                               : TJPF_RGB;

    return planes ? tjDecompressToYUVPlanes(jpeg, file.data, size, planes->plane, raster->width,
                                            planes->stride, raster->height, flags)
                  : tjDecompress2(jpeg, file.data, size, raster->pixels, raster->width,
                                  (int)rf_raster_stride(raster), raster->height, format, flags);
}

static int read_pixels(const struct rf_read *read, tjhandle jpeg, struct rf_bytes file,
                       struct rf_raster *raster, struct planes *planes)
{
    int flags = TJFLAG_ACCURATEDCT | TJFLAG_LIMITSCANS | TJFLAG_STOPONWARNING;
    int failed = decode(jpeg, file, raster, planes, flags);

    if (failed && few_bytes_too_many(tjGetErrorStr2(jpeg))) {
        flags &= ~TJFLAG_STOPONWARNING;
        failed =
            decode(jpeg, file, raster, planes, flags) != 0 && tjGetErrorCode(jpeg) != TJERR_WARNING;
    }
    return failed ? fail_jpeg(read, jpeg) : REFOCUS_OK;
}

/* Colour of half the size, as cameras and phones store it, follows luma where it is enlarged. */
static int read_half(const struct rf_read *read, tjhandle jpeg, struct rf_bytes file,
                     struct rf_raster *raster, int step)
{
    /* TurboJPEG writes an even number of columns and rows of luma. */
    const uint64_t columns = ((uint64_t)raster->width + 1) / 2;
    const uint64_t samples = columns * (((uint64_t)raster->height + 1) / 2), luma = 4 * samples;
    const uint64_t work = (rf_jpeg_chroma_bytes(raster->width, raster->height) + 7) / 8 * 8;
    struct planes planes = {.stride = {2 * (int)columns, (int)columns, (int)columns}};
    uint8_t *memory;
    int status = rf_check_memory(read, work + luma + 2 * samples);

    if (status != REFOCUS_OK)
        return status;
    memory = malloc((size_t)(work + luma + 2 * samples));
    if (!memory)
        return rf_fail_memory(read->reason);
    planes.plane[0] = memory + work;
    planes.plane[1] = planes.plane[0] + luma;
    planes.plane[2] = planes.plane[1] + samples;
    status = read_pixels(read, jpeg, file, raster, &planes);
    if (status == REFOCUS_OK) {
        rf_jpeg_chroma(raster,
                       &(struct rf_jpeg_planes){planes.plane[0],
                                                {planes.plane[1], planes.plane[2]},
                                                step > 0 ? step : 1},
                       memory);
    }
    free(memory);
    return status;
}

/* Ink on white paper becomes R, G, B, in place: each ink takes its own colour away and black all of
 * them, as other programs have it who do not know the profile. Adobe stores how much is left. */
static void cmyk_to_rgb(struct rf_raster *raster, bool adobe)
{
    const size_t count = (size_t)raster->width * (size_t)raster->height;
    const unsigned flip = adobe ? 0 : 255;
    const uint8_t *in = raster->pixels;
    uint8_t *out = raster->pixels;

    for (size_t i = 0; i < count; i++, in += 4) {
        const unsigned black = in[3] ^ flip;

        for (int c = 0; c < 3; c++)
            *out++ = (uint8_t)(((in[c] ^ flip) * black + 127) / 255);
    }
    raster->channels = 3;
}

int rf_jpeg_decode(const struct rf_read *read, struct rf_bytes file, struct rf_raster *raster)
{
    struct survey survey;
    tjhandle jpeg;
    bool half = false;
    int status;

    memset(raster, 0, sizeof *raster);
    if ((status = survey_file(read, file, &survey)) != REFOCUS_OK)
        return status;
    jpeg = tjInitDecompress();
    if (!jpeg)
        return rf_fail_memory(read->reason);
    status = read_header(read, jpeg, file, raster, &half);
    if (status == REFOCUS_OK)
        status = check_work(read, raster, survey.scans);
    if (status == REFOCUS_OK)
        status = rf_raster_alloc(read, raster);
    if (status == REFOCUS_OK) {
        status = half ? read_half(read, jpeg, file, raster, survey.step[survey.chroma])
                      : read_pixels(read, jpeg, file, raster, NULL);
    }
    if (status == REFOCUS_OK && raster->channels == 4)
        cmyk_to_rgb(raster, survey.adobe);
    if (status != REFOCUS_OK)
        rf_raster_free(raster);
    tjDestroy(jpeg);
    return status;
}
