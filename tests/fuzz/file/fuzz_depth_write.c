/* fuzz_depth_write.c: depth into a JPEG photo: what is written can be read, and writing it again
 * changes nothing. */
#include "fuzz.h"

#include <stdio.h>
#include <unistd.h>

static char folder[] = "/tmp/refocus-fuzz-XXXXXX";
static char in[64], out[64];

static void end(void)
{
    remove(in);
    remove(out);
    rmdir(folder);
}

static void begin(void)
{
    if (in[0])
        return;
    if (!mkdtemp(folder))
        abort();
    snprintf(in, sizeof in, "%s/in.jpg", folder);
    snprintf(out, sizeof out, "%s/out.jpg", folder);
    atexit(end);
}

static size_t contents(uint8_t *bytes, size_t most)
{
    FILE *const file = fopen(out, "rb");
    size_t n;

    if (!file)
        abort();
    n = fread(bytes, 1, most, file);
    fclose(file);
    return n;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    enum { MOST = 1 << 21, W = 7, H = 5 };
    static uint8_t first[MOST], second[MOST];
    uint16_t disparity[W * H];
    struct refocus_depth_write depth = refocus_depth_write_default();
    struct refocus_photo *photo = NULL;
    struct refocus_reason reason;
    FILE *file;
    int status;

    begin();
    file = fopen(in, "wb");
    if (!file || fwrite(data, 1, size, file) != size || fclose(file))
        abort();
    for (int i = 0; i < W * H; i++)
        disparity[i] = (uint16_t)(i * 1871 + (int)size);
    depth.width = W;
    depth.height = H;
    depth.stride = 2 * W;
    depth.disparity = disparity;
    depth.near_m = 0.5;
    depth.far_m = 9;
    remove(out);
    status = refocus_photo_write_depth(out, in, &depth, &reason);
    if (status != REFOCUS_OK) {
        if (access(out, F_OK) == 0 || reason.text[0] == '\0')
            abort();
        return 0;
    }
    const size_t n = contents(first, MOST);
    if (refocus_photo_write_depth(out, out, &depth, &reason) != REFOCUS_OK ||
        contents(second, MOST) != n || memcmp(first, second, n) != 0)
        abort();
    /* The picture may be too damaged to be read; what is read is sound. */
    if (refocus_photo_read(&photo, out, &fuzz_limits, &reason) == REFOCUS_OK)
        fuzz_check_photo(photo);
    refocus_photo_free(&photo);
    return 0;
}
