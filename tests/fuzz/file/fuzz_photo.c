/* fuzz_photo.c: any bytes as a photo of any format. */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct refocus_photo *photo = NULL;
    struct refocus_reason reason;
    const int status = refocus_photo_read_memory(&photo, data, size, &fuzz_limits, &reason);

    if ((status == REFOCUS_OK) != (photo != NULL) ||
        (status != REFOCUS_OK && reason.text[0] == '\0')) {
        abort();
    }
    if (photo) {
        if (!photo->image->plane[0]) {
            abort();
        }
        fuzz_check_photo(photo);
    }
    refocus_photo_free(&photo);
    return 0;
}
