/* webp.c: a WebP is read by libwebp, 8 bits a channel, with EXIF, XMP and the colour profile. */
#include <stdlib.h>
#include <string.h>
#include <webp/decode.h>
#include <webp/demux.h>

#include "codec.h"
#include "reason.h"

static int fail(const struct rf_read *read, VP8StatusCode code)
{
    if (code == VP8_STATUS_OUT_OF_MEMORY)
        return rf_fail_memory(read->reason);
    return rf_fail(read->reason, REFOCUS_ERR_FORMAT, "damaged WebP: %s",
                   code == VP8_STATUS_NOT_ENOUGH_DATA || code == VP8_STATUS_SUSPENDED
                       ? "it ends too early; copy it again"
                       : "it cannot be decoded");
}

static int decode(struct rf_read *read, struct rf_bytes file)
{
    struct rf_raster *const raster = &read->image;
    WebPDecoderConfig config;
    VP8StatusCode code;
    bool alpha;
    int status;

    if (!WebPInitDecoderConfig(&config))
        return rf_fail(read->reason, REFOCUS_ERR_UNSUPPORTED, "WebP: libwebp is of another kind");
    code = WebPGetFeatures(file.data, file.size, &config.input);
    if (code != VP8_STATUS_OK)
        return fail(read, code);
    if (config.input.has_animation) {
        return rf_fail(read->reason, REFOCUS_ERR_UNSUPPORTED,
                       "it is an animated WebP; give a still picture");
    }
    alpha = config.input.has_alpha && rf_wants_alpha(read);
    raster->width = config.input.width;
    raster->height = config.input.height;
    raster->channels = alpha ? 4 : 3;
    raster->sample = REFOCUS_SAMPLE_U8;
    raster->max_value = 255;
    raster->lossy = config.input.format != 2;
    status = rf_raster_alloc(read, raster);
    if (status == REFOCUS_OK) /* libwebp keeps the whole picture of a lossless one: 4 bytes */
        status = rf_check_memory(read, (uint64_t)raster->width * (uint64_t)raster->height * 4);
    if (status != REFOCUS_OK)
        return status;
    config.output.colorspace = alpha ? MODE_RGBA : MODE_RGB;
    config.output.is_external_memory = 1;
    config.output.u.RGBA.rgba = raster->pixels;
    config.output.u.RGBA.stride = (int)rf_raster_stride(raster);
    config.output.u.RGBA.size = rf_raster_stride(raster) * (size_t)raster->height;
    code = WebPDecode(file.data, file.size, &config);
    WebPFreeDecBuffer(&config.output);
    if (code != VP8_STATUS_OK)
        return fail(read, code);
    if (alpha)
        status = rf_part_alpha(read);
    if (status == REFOCUS_OK && config.input.has_alpha && !read->holes.pixels)
        rf_note(read->info, "WebP: transparency is dropped");
    return status;
}

static int copy(const struct rf_read *read, const WebPDemuxer *demuxer, const char *name,
                struct refocus_blob *blob)
{
    WebPChunkIterator chunk;
    int status = REFOCUS_OK;

    memset(&chunk, 0, sizeof chunk);
    if (WebPDemuxGetChunk(demuxer, name, 1, &chunk) && chunk.chunk.size > 0) {
        status = rf_check_metadata(read, chunk.chunk.size, "a block of it");
        if (status == REFOCUS_OK) {
            blob->data = malloc(chunk.chunk.size);
            status = blob->data ? REFOCUS_OK : rf_fail_memory(read->reason);
        }
        if (status == REFOCUS_OK) {
            memcpy(blob->data, chunk.chunk.bytes, chunk.chunk.size);
            blob->size = chunk.chunk.size;
        }
    }
    WebPDemuxReleaseChunkIterator(&chunk);
    return status;
}

/* Some programs put the signature of a JPEG segment before the block. */
static void trim(struct refocus_blob *exif)
{
    if (exif->size > 6 && memcmp(exif->data, "Exif\0\0", 6) == 0) {
        exif->size -= 6;
        memmove(exif->data, exif->data + 6, exif->size);
    }
}

static int read_webp(struct rf_read *read, struct rf_bytes file, struct rf_extras *extras)
{
    const WebPData data = {file.data, file.size};
    WebPDemuxer *demuxer;
    int status = decode(read, file);

    if (status != REFOCUS_OK)
        return status;
    demuxer = WebPDemux(&data);
    if (!demuxer)
        return REFOCUS_OK; /* the pixels are whole all the same */
    status = copy(read, demuxer, "ICCP", &extras->icc);
    if (status == REFOCUS_OK)
        status = copy(read, demuxer, "EXIF", &extras->exif);
    if (status == REFOCUS_OK)
        status = copy(read, demuxer, "XMP ", &extras->xmp);
    WebPDemuxDelete(demuxer);
    trim(&extras->exif);
    return status;
}

__attribute__((visibility("default"))) extern const struct rf_codec rf_codec_webp;
const struct rf_codec rf_codec_webp = {.version = RF_CODEC_VERSION, .read = read_webp};
