/* fuzz_pfm.c: any bytes as a PFM file, of depth and of light. */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const struct rf_bytes file = {data, size};
    struct fuzz_reading reading;

    for (int photo = 0; photo < 2 && rf_format_pfm.recognise(file); photo++) {
        fuzz_begin(&reading);
        reading.read.picture_always = photo;
        if (rf_format_pfm.read(&reading.read, file) == REFOCUS_OK && photo &&
            rf_image_to_rgb8(&reading.read) != REFOCUS_OK)
            abort(); /* the limits leave room for it */
        fuzz_end(&reading);
    }
    return 0;
}
