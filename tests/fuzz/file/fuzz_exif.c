/* fuzz_exif.c: any bytes as EXIF. Parsing is idempotent: a block that was made upright stays as
 * it is. */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    uint8_t *const once = malloc(size ? size : 1), *const twice = malloc(size ? size : 1);
    struct rf_exif first, second;

    memcpy(once, data, size);
    if (rf_exif_parse(once, size, &first)) {
        if (first.orientation < 1 || first.orientation > 8) {
            abort();
        }
        memcpy(twice, once, size);
        rf_exif_parse(twice, size, &second);
    }
    free(once);
    free(twice);
    return 0;
}
