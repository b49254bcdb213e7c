/* fuzz_dynamic.c: any bytes as a packet of XMP, up to the first zero, and those that lie behind the
 * main picture, where its container directory says that depth is. */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const uint8_t *const end = size > 0 ? memchr(data, 0, size) : NULL;
    const size_t packet = end ? (size_t)(end - data) : size, behind = end ? packet + 1 : size;
    const struct rf_bytes file = {data, size};
    struct rf_xmp xmp = {.items = 0};
    struct fuzz_reading reading;

    fuzz_begin(&reading);
    if (rf_xmp_parse(&reading.read, (struct rf_bytes){data, packet}, &xmp) == REFOCUS_OK)
        rf_read_dynamic(&reading.read, file, &xmp, behind);
    rf_xmp_free(&xmp);
    fuzz_end(&reading);
    return 0;
}
