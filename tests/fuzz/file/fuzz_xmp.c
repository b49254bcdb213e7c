/* fuzz_xmp.c: any bytes as a packet of XMP alone, and its depth. */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct rf_xmp xmp = {.items = 0};
    struct fuzz_reading reading;

    fuzz_begin(&reading);
    if (rf_xmp_parse(&reading.read, (struct rf_bytes){data, size}, &xmp) == REFOCUS_OK)
        rf_read_gdepth(&reading.read, &xmp);
    rf_xmp_free(&xmp);
    fuzz_end(&reading);
    return 0;
}
