/* fuzz_mpf.c: any bytes as the MPF directory of a JPEG. */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct rf_mpf mpf;

    if (rf_mpf_parse((struct rf_bytes){data, size}, &mpf) &&
        (mpf.count < 0 || mpf.count > RF_MPF_MAX))
        abort();
    return 0;
}
