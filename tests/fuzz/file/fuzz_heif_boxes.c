/* fuzz_heif_boxes.c: any bytes as the boxes of a HEIF file that are looked at beside
 * libheif. */
#include "fuzz.h"

/* A changed file needs no change. */
static void change(struct rf_bytes file)
{
    uint8_t *changed, *again;

    if (rf_heif_single_targets(file, &changed) == REFOCUS_OK && changed) {
        rf_heif_single_targets((struct rf_bytes){changed, file.size}, &again);
        if (again)
            abort();
        free(changed);
    }
}

/* Metadata lie in the file, and a copy with the map as main picture has the size of the file. */
static void find_gain_map(struct rf_bytes file)
{
    struct rf_heif_tone_map map, again;
    uint8_t *changed;

    if (!rf_heif_find_tone_map(file, &map))
        return;
    if (map.metadata.size > 0) {
        volatile uint8_t last = map.metadata.data[map.metadata.size - 1];
        (void)last;
    }
    if (rf_heif_with_main_picture(file, map.item, &changed) == REFOCUS_OK) {
        if (rf_heif_find_tone_map((struct rf_bytes){changed, file.size}, &again))
            abort();
        free(changed);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const struct rf_bytes file = {data, size};
    uint32_t pair[2];

    for (uint32_t item = 0; item < 3; item++) {
        const int orientation = rf_heif_orientation(file, item);
        if (orientation < 1 || orientation > 8)
            abort();
    }
    rf_heif_is_sequence(file);
    rf_heif_stereo_pair(file, pair);
    change(file);
    find_gain_map(file);
    return 0;
}
