/* fuzz_npy.c: any bytes as a NumPy array. */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const struct rf_bytes file = {data, size};
    struct fuzz_reading reading;

    if (rf_format_npy.recognise(file)) {
        fuzz_begin(&reading);
        rf_format_npy.read(&reading.read, file);
        fuzz_end(&reading);
    }
    return 0;
}
