/* fuzz_pnm.c: any bytes as a PNM file. */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const struct rf_bytes file = {data, size};
    struct fuzz_reading reading;

    if (rf_format_ppm.recognise(file) || rf_format_pgm.recognise(file)) {
        fuzz_begin(&reading);
        if (rf_format_ppm.read(&reading.read, file) == REFOCUS_OK &&
            rf_image_to_rgb8(&reading.read) != REFOCUS_OK)
            abort(); /* the limits leave room for it */
        fuzz_end(&reading);
    }
    return 0;
}
