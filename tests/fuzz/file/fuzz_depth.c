/* fuzz_depth.c: any bytes as a depth map; the first byte chooses the unit. */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const units[] = {NULL, "disparity", "inverse", "mm", "m", "5000/m"};
    struct refocus_photo *depth = NULL;
    struct refocus_reason reason;
    int status;

    if (size < 1)
        return 0;
    status = refocus_depth_read_memory(&depth, data + 1, size - 1, units[data[0] % 6],
                                       data[0] & 64 ? 0.5 : 0.0, data[0] & 128 ? 9.0 : 0.0,
                                       &fuzz_limits, &reason);
    if ((status == REFOCUS_OK) != (depth != NULL) ||
        (status != REFOCUS_OK && reason.text[0] == '\0'))
        abort();
    if (depth) {
        if (!depth->depth->samples)
            abort();
        fuzz_check_photo(depth);
    }
    refocus_photo_free(&depth);
    return 0;
}
