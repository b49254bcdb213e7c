/* fuzz_photo.c: any bytes as a photo of any format, and as either one of a stereo file. */
#include "fuzz.h"

static void read_view(const uint8_t *data, size_t size, enum rf_view view)
{
    struct fuzz_reading reading;

    fuzz_begin(&reading);
    if (rf_read_begin(&reading.read, (struct rf_bytes){data, size}, &fuzz_limits, true, view,
                      &reading.info, NULL, &reading.reason) != REFOCUS_OK &&
        reading.reason.text[0] == '\0')
        abort();
    fuzz_end(&reading);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct refocus_photo *photo = NULL;
    struct refocus_reason reason;
    const int status = refocus_photo_read_memory(&photo, data, size, &fuzz_limits, &reason);

    if ((status == REFOCUS_OK) != (photo != NULL) ||
        (status != REFOCUS_OK && reason.text[0] == '\0'))
        abort();
    if (photo) {
        if (!photo->image->plane[0])
            abort();
        fuzz_check_photo(photo);
    }
    refocus_photo_free(&photo);
    read_view(data, size, RF_VIEW_FIRST);
    read_view(data, size, RF_VIEW_SECOND);
    return 0;
}
