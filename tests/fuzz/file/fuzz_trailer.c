/* fuzz_trailer.c: any bytes as what lies behind a main picture, where phones have trailers. */
#include "fuzz.h"
#include "trailer.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_reading reading;

    fuzz_begin(&reading);
    rf_read_trailer(&reading.read, (struct rf_bytes){data, size}, 0);
    fuzz_end(&reading);
    return 0;
}
