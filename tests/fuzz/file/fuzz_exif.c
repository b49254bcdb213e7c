/* fuzz_exif.c: any bytes as EXIF. Parsing is idempotent: a block that was made upright stays as
 * it is. */
#include "exif_copy.h"
#include "fuzz.h"

/* A block that was made of a TIFF is one itself, of which no more is made. */
static void check_copies(struct rf_bytes tiff)
{
    /* Sanitizers take 20 times as long over blocks of this size as the parser does. */
    static uint8_t copy[RF_EXIF_COPY_ROOM], again[RF_EXIF_COPY_ROOM];
    const size_t size = rf_exif_of_tiff(tiff, copy);
    char text[64];

    if (size > RF_EXIF_COPY_ROOM)
        abort();
    if (size > 0) {
        const size_t smaller = rf_exif_of_tiff((struct rf_bytes){copy, size}, again);

        if (smaller == 0 || smaller > size || rf_exif_has_maker_note((struct rf_bytes){copy, size}))
            abort();
    }
    if (rf_exif_directory(tiff, 0x8769, 8, again) > RF_EXIF_COPY_ROOM ||
        (rf_exif_text(tiff, 0x10f, text, sizeof text) && strlen(text) >= sizeof text))
        abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    uint8_t *const once = malloc(size ? size : 1), *const twice = malloc(size ? size : 1);
    struct rf_exif first, second;

    memcpy(once, data, size);
    if (rf_exif_parse(once, size, &first)) {
        if (first.orientation < 1 || first.orientation > 8)
            abort();
        memcpy(twice, once, size);
        rf_exif_parse(twice, size, &second);
        rf_exif_set_size(twice, size, 1024, 768); /* drops what is of other sides */
    }
    check_copies((struct rf_bytes){data, size});
    free(once);
    free(twice);
    return 0;
}
