/* fuzz_xmp_extended.c: any bytes as the segments of a JPEG that hold extended XMP, with the GUID
 * that the seeds use. */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char guid[] = "0123456789ABCDEF0123456789ABCDEF";
    struct refocus_blob packet;
    struct fuzz_reading reading;
    volatile unsigned sum = 0;

    fuzz_begin(&reading);
    if (rf_xmp_extended(&reading.read, (struct rf_bytes){data, size}, guid, 32, &packet) ==
        REFOCUS_OK)
        for (size_t i = 0; i < packet.size; i++)
            sum += packet.data[i];
    (void)sum;
    free(packet.data);
    fuzz_end(&reading);
    return 0;
}
