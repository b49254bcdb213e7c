/* fuzz_keep.c: any photo, and a picture that keeps what its file says: the picture can be read, and
 * one that is made from it keeps all of it, byte for byte, with a gain map of its own. So it is
 * where the picture is editable, and it has its original then. */
#include "fuzz.h"

#include <stdio.h>
#include <unistd.h>

enum { W = 7, H = 5, MOST = 1 << 22 };
static char folder[] = "/tmp/refocus-fuzz-XXXXXX";
static char out[64];

static void end(void)
{
    remove(out);
    rmdir(folder);
}

static void begin(void)
{
    if (out[0])
        return;
    if (!mkdtemp(folder))
        abort();
    snprintf(out, sizeof out, "%s/out.jpg", folder);
    atexit(end);
}

/* Make a picture that keeps what a photo says, and read its file. */
static size_t make(struct refocus_photo **photo, const struct refocus_editable *editable,
                   uint8_t *bytes)
{
    static uint8_t pixels[W * H * 3];
    static uint16_t halves[W * H * 3] = {0x4800}; /* one of 8 times white */
    const struct refocus_image light =
        refocus_image_packed(REFOCUS_FORMAT_RGB_HALF, halves, W, H, W * 6);
    const struct refocus_image image =
        refocus_image_packed(REFOCUS_FORMAT_RGB8, pixels, W, H, W * 3);
    struct refocus_write_options options = refocus_write_options_default();
    struct refocus_reason reason;
    FILE *file;
    size_t n;

    options.exif = &(*photo)->exif;
    options.icc = &(*photo)->icc;
    options.keep = *photo;
    options.editable = editable;
    options.light = &light;
    options.unsynced = 1;
    if (refocus_image_write(out, &image, &options, &reason) != REFOCUS_OK)
        abort();
    file = fopen(out, "rb");
    if (!file)
        abort();
    n = fread(bytes, 1, MOST, file);
    fclose(file);
    refocus_photo_free(photo);
    if (refocus_photo_read_memory(photo, bytes, n, &fuzz_limits, NULL) != REFOCUS_OK)
        abort();
    if (!editable && !((*photo)->info->gain_map_stops > 2))
        abort();
    if (editable && !strstr(reason.text, "no room") &&
        !((*photo)->info->original_used && (*photo)->depth->samples))
        abort();
    return n;
}

/* Make three pictures, one of the other: the last two are the same. */
static void make_three(const uint8_t *data, size_t size, bool is_editable)
{
    static const uint16_t samples[6] = {0, 9, 99, 999, 9999, 65535};
    static uint8_t bytes[2][MOST];
    struct refocus_depth_write depth = refocus_depth_write_default();
    struct refocus_editable editable = refocus_editable_default();
    struct refocus_photo *photo = NULL;
    size_t n;

    if (refocus_photo_read_memory(&photo, data, size, &fuzz_limits, NULL) != REFOCUS_OK)
        return;
    depth.disparity = samples;
    depth.width = 3;
    depth.height = 2;
    depth.stride = 6;
    editable.depth = &depth;
    if (photo->image->plane[0] && !(is_editable && strcmp(photo->info->container, "JPEG") != 0)) {
        make(&photo, is_editable ? &editable : NULL, bytes[0]);
        editable.own_depth = photo->info->depth_source == REFOCUS_DEPTH_SOURCE_GDEPTH;
        n = make(&photo, is_editable ? &editable : NULL, bytes[0]);
        if (make(&photo, is_editable ? &editable : NULL, bytes[1]) != n ||
            memcmp(bytes[0], bytes[1], n) != 0)
            abort();
        if (!is_editable && photo->depth->samples)
            abort();
    }
    refocus_photo_free(&photo);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    begin();
    make_three(data, size, false);
    make_three(data, size, true);
    return 0;
}
