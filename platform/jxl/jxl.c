/* jxl.c: a JPEG XL is read by libjxl, upright: up to 16 bits as codes, floats and the curves of HDR
 * as linear light. */
#include <jxl/decode.h>
#include <stdlib.h>
#include <string.h>

#include "codec.h"
#include "light.h"
#include "reason.h"

struct reader {
    struct rf_read *read;
    struct rf_bytes file;
    struct rf_extras *extras;
    JxlDecoder *decoder;
    JxlBasicInfo about;
    JxlPixelFormat format;
    int curve, primaries;    /* numbers of ITU-T H.273; 0: not said */
    struct refocus_blob box; /* the one that is being read */
    JxlBoxType type;
    JXL_BOOL unpacks; /* libjxl unpacks boxes that are compressed by Brotli ("brob") */
    bool has_picture;
};

static int fail_damaged(const struct reader *reader)
{
    return rf_fail(reader->read->reason, REFOCUS_ERR_FORMAT,
                   "damaged JPEG XL, or it ends too early; copy it again");
}

static int take_about(struct reader *reader)
{
    struct rf_read *const read = reader->read;
    struct rf_raster *const raster = &read->image;
    int status;

    if (JxlDecoderGetBasicInfo(reader->decoder, &reader->about) != JXL_DEC_SUCCESS)
        return fail_damaged(reader);
    if (reader->about.have_animation) {
        return rf_fail(read->reason, REFOCUS_ERR_UNSUPPORTED,
                       "it is an animated JPEG XL; give a still picture");
    }
    status = rf_check_size(read, reader->about.xsize, reader->about.ysize, 12);
    if (status == REFOCUS_OK) /* libjxl has three floats a pixel, and as much for its filters */
        status = rf_check_memory(read, (uint64_t)reader->about.xsize * reader->about.ysize * 24);
    raster->width = (int32_t)reader->about.xsize;
    raster->height = (int32_t)reader->about.ysize;
    return status;
}

static int take_profile(struct reader *reader)
{
    struct refocus_blob *const icc = &reader->extras->icc;
    size_t size = 0;
    int status;

    if (JxlDecoderGetICCProfileSize(reader->decoder, NULL, JXL_COLOR_PROFILE_TARGET_DATA, &size) !=
            JXL_DEC_SUCCESS ||
        size == 0 || icc->data)
        return REFOCUS_OK;
    status = rf_check_metadata(reader->read, size, "its ICC profile");
    if (status != REFOCUS_OK)
        return status;
    icc->data = malloc(size);
    if (!icc->data)
        return rf_fail_memory(reader->read->reason);
    icc->size = size;
    return JxlDecoderGetColorAsICCProfile(reader->decoder, NULL, JXL_COLOR_PROFILE_TARGET_DATA,
                                          icc->data, size) == JXL_DEC_SUCCESS
               ? REFOCUS_OK
               : fail_damaged(reader);
}

/* Colours by sRGB have no profile, those of HDR become light; all others keep theirs. */
static int take_colour(struct reader *reader)
{
    JxlColorEncoding colour;

    if (JxlDecoderGetColorAsEncodedProfile(reader->decoder, NULL, JXL_COLOR_PROFILE_TARGET_DATA,
                                           &colour) != JXL_DEC_SUCCESS)
        return take_profile(reader);
    /* The numbers are those of H.273, but for P3's. */
    reader->curve = (int)colour.transfer_function;
    reader->primaries =
        colour.primaries == JXL_PRIMARIES_P3 ? RF_PRIMARIES_P3 : (int)colour.primaries;
    if (rf_curve_is_hdr(reader->curve) ||
        (reader->curve == RF_CURVE_SRGB &&
         (colour.color_space == JXL_COLOR_SPACE_GRAY || colour.primaries == JXL_PRIMARIES_SRGB)))
        return REFOCUS_OK;
    return take_profile(reader);
}

static int begin_picture(struct reader *reader)
{
    struct rf_raster *const raster = &reader->read->image;
    const bool floats = reader->about.exponent_bits_per_sample > 0 ||
                        reader->about.bits_per_sample > 16 || reader->curve == RF_CURVE_LINEAR;
    const bool small =
        !floats && reader->about.bits_per_sample <= 8 && !rf_curve_is_hdr(reader->curve);
    const bool grey =
        reader->about.num_color_channels == 1 && !floats && !rf_curve_is_hdr(reader->curve);
    size_t size = 0;
    int status;

    raster->channels =
        (grey ? 1 : 3) + (reader->about.alpha_bits > 0 && rf_wants_alpha(reader->read));
    raster->sample = floats ? REFOCUS_SAMPLE_F32 : small ? REFOCUS_SAMPLE_U8 : REFOCUS_SAMPLE_U16;
    raster->max_value = floats ? 0 : small ? 255 : 65535;
    reader->read->info->stored_bits = floats ? 0 : (int32_t)reader->about.bits_per_sample;
    reader->format = (JxlPixelFormat){(uint32_t)raster->channels,
                                      floats  ? JXL_TYPE_FLOAT
                                      : small ? JXL_TYPE_UINT8
                                              : JXL_TYPE_UINT16,
                                      JXL_NATIVE_ENDIAN, 0};
    status = rf_raster_alloc(reader->read, raster);
    if (status != REFOCUS_OK)
        return status;
    if (JxlDecoderImageOutBufferSize(reader->decoder, &reader->format, &size) != JXL_DEC_SUCCESS ||
        size != rf_raster_stride(raster) * (size_t)raster->height ||
        JxlDecoderSetImageOutBuffer(reader->decoder, &reader->format, raster->pixels, size) !=
            JXL_DEC_SUCCESS)
        return fail_damaged(reader);
    return REFOCUS_OK;
}

/* A box has ended: it is one of the extras, or of no use. EXIF begins with the offset of its TIFF
 * block (ISO/IEC 18181-2, 9.4). */
static void end_box(struct reader *reader)
{
    struct refocus_blob *const box = &reader->box;
    const bool exif = memcmp(reader->type, "Exif", 4) == 0;
    struct refocus_blob *const to = exif ? &reader->extras->exif : &reader->extras->xmp;
    size_t skip = 0;

    if (!box->data)
        return;
    box->size -= JxlDecoderReleaseBoxBuffer(reader->decoder);
    if (exif && box->size > 4) {
        skip = 4 + ((size_t)box->data[0] << 24 | (size_t)box->data[1] << 16 |
                    (size_t)box->data[2] << 8 | box->data[3]);
    }
    if (!to->data && skip < box->size && (skip > 0 || !exif)) {
        memmove(box->data, box->data + skip, box->size - skip);
        *to = (struct refocus_blob){box->data, box->size - skip};
    } else {
        free(box->data);
    }
    *box = (struct refocus_blob){NULL, 0};
}

static int begin_box(struct reader *reader)
{
    uint64_t size = 0;

    end_box(reader);
    if (JxlDecoderGetBoxType(reader->decoder, reader->type, reader->unpacks) != JXL_DEC_SUCCESS ||
        JxlDecoderGetBoxSizeRaw(reader->decoder, &size) != JXL_DEC_SUCCESS)
        return fail_damaged(reader);
    if (memcmp(reader->type, "Exif", 4) != 0 && memcmp(reader->type, "xml ", 4) != 0)
        return REFOCUS_OK;
    if (size < 8 || size > reader->file.size ||
        rf_check_metadata(reader->read, size, "a block of it") != REFOCUS_OK)
        return REFOCUS_OK;
    reader->box.data = malloc((size_t)size);
    if (!reader->box.data)
        return rf_fail_memory(reader->read->reason);
    reader->box.size = (size_t)size;
    return JxlDecoderSetBoxBuffer(reader->decoder, reader->box.data, reader->box.size) ==
                   JXL_DEC_SUCCESS
               ? REFOCUS_OK
               : fail_damaged(reader);
}

/* A compressed box is larger than its room: it gets twice as much, or is passed over. */
static int grow_box(struct reader *reader)
{
    struct refocus_blob *const box = &reader->box;
    const size_t filled = box->size - JxlDecoderReleaseBoxBuffer(reader->decoder);
    uint8_t *grown;

    if (box->size > SIZE_MAX / 2 ||
        rf_check_metadata(reader->read, 2 * (uint64_t)box->size, "a block of it") != REFOCUS_OK) {
        free(box->data);
        *box = (struct refocus_blob){NULL, 0};
        return REFOCUS_OK;
    }
    grown = realloc(box->data, 2 * box->size);
    if (!grown)
        return rf_fail_memory(reader->read->reason);
    *box = (struct refocus_blob){grown, 2 * box->size};
    return JxlDecoderSetBoxBuffer(reader->decoder, grown + filled, box->size - filled) ==
                   JXL_DEC_SUCCESS
               ? REFOCUS_OK
               : fail_damaged(reader);
}

static int step(struct reader *reader, bool *ended)
{
    switch (JxlDecoderProcessInput(reader->decoder)) {
    case JXL_DEC_BASIC_INFO:
        return take_about(reader);
    case JXL_DEC_COLOR_ENCODING:
        return take_colour(reader);
    case JXL_DEC_NEED_IMAGE_OUT_BUFFER:
        return begin_picture(reader);
    case JXL_DEC_FULL_IMAGE:
        reader->has_picture = true;
        return REFOCUS_OK;
    case JXL_DEC_BOX:
        return begin_box(reader);
    case JXL_DEC_BOX_NEED_MORE_OUTPUT:
        return grow_box(reader);
    case JXL_DEC_SUCCESS:
        *ended = true;
        return REFOCUS_OK;
    default: /* a picture that is whole is taken, whatever follows it */
        *ended = reader->has_picture;
        return *ended ? REFOCUS_OK : fail_damaged(reader);
    }
}

static int decode(struct reader *reader)
{
    struct rf_raster *const raster = &reader->read->image;
    bool ended = false;
    int status = REFOCUS_OK;

    reader->unpacks = JxlDecoderSetDecompressBoxes(reader->decoder, JXL_TRUE) == JXL_DEC_SUCCESS;
    if (JxlDecoderSubscribeEvents(reader->decoder, JXL_DEC_BASIC_INFO | JXL_DEC_COLOR_ENCODING |
                                                       JXL_DEC_FULL_IMAGE | JXL_DEC_BOX) !=
            JXL_DEC_SUCCESS ||
        JxlDecoderSetInput(reader->decoder, reader->file.data, reader->file.size) !=
            JXL_DEC_SUCCESS)
        return fail_damaged(reader);
    while (status == REFOCUS_OK && !ended)
        status = step(reader, &ended);
    end_box(reader);
    if (status == REFOCUS_OK && !reader->has_picture)
        status = fail_damaged(reader);
    if (status == REFOCUS_OK && reader->about.alpha_bits > 0 && rf_wants_alpha(reader->read))
        status = rf_part_alpha(reader->read);
    if (status == REFOCUS_OK && reader->about.alpha_bits > 0 && !reader->read->holes.pixels)
        rf_note(reader->read->info, "JPEG XL: transparency is dropped");
    if (status == REFOCUS_OK &&
        (rf_curve_is_hdr(reader->curve) || raster->sample == REFOCUS_SAMPLE_F32)) {
        status = rf_raster_to_light(reader->read, raster, reader->curve, reader->primaries);
        rf_note(reader->read->info, "JPEG XL: %s, read as linear light",
                reader->curve == RF_CURVE_PQ    ? "the curve of PQ"
                : reader->curve == RF_CURVE_HLG ? "the curve of HLG"
                                                : "floats or linear samples");
    }
    return status;
}

static int read_jxl(struct rf_read *read, struct rf_bytes file, struct rf_extras *extras)
{
    struct reader reader = {.read = read, .file = file, .extras = extras};
    int status;

    extras->upright = true;
    reader.decoder = JxlDecoderCreate(NULL);
    if (!reader.decoder)
        return rf_fail_memory(read->reason);
    status = decode(&reader);
    JxlDecoderDestroy(reader.decoder);
    return status;
}

__attribute__((visibility("default"))) extern const struct rf_codec rf_codec_jxl;
const struct rf_codec rf_codec_jxl = {.version = RF_CODEC_VERSION, .read = read_jxl};
