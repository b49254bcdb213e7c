/* fuzz_codec.c: any bytes as a photo or a depth map of the format that RF_CODEC reads. */
#include "codec.h"
#include "fuzz.h"

extern const struct rf_codec RF_CODEC;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct rf_extras extras = {.upright = false};
    struct fuzz_reading reading;
    int status;

    fuzz_begin(&reading);
    reading.read.limits.max_memory = 1u << 26;
    reading.read.picture_always = size % 2 == 0;
    status = RF_CODEC.read(&reading.read, (struct rf_bytes){data, size}, &extras);
    if (status != REFOCUS_OK && reading.reason.text[0] == '\0')
        abort();
    if (status == REFOCUS_OK && !reading.read.image.pixels && !reading.read.samples.pixels)
        abort();
    if (status == REFOCUS_OK && reading.read.image.pixels)
        status = rf_image_to_rgb8(&reading.read);
    free(extras.exif.data);
    free(extras.icc.data);
    free(extras.xmp.data);
    fuzz_end(&reading);
    return 0;
}
