/* mpf.c: the index of pictures in a file is read (CIPA DC-007, Multi-Picture Format): a TIFF
 * directory with one entry a picture. */
#include "mpf.h"

#include <string.h>

enum { TAG_ENTRIES = 0xb002, ENTRY_BYTES = 16 };

bool rf_mpf_parse(struct rf_bytes tiff, struct rf_mpf *mpf)
{
    size_t directory, entries = 0, size = 0;
    uint32_t tags;

    memset(mpf, 0, sizeof *mpf);
    if (tiff.size < 10 ||
        (memcmp(tiff.data, "MM\0*", 4) != 0 && memcmp(tiff.data, "II*\0", 4) != 0))
        return false;
    directory = rf_tiff_number(tiff, 4, 4);
    if (directory > tiff.size - 2)
        return false;
    tags = rf_tiff_number(tiff, directory, 2);
    if (tags > (tiff.size - directory - 2) / 12)
        return false;
    for (uint32_t i = 0; i < tags; i++) {
        const size_t at = directory + 2 + (size_t)i * 12;
        if (rf_tiff_number(tiff, at, 2) == TAG_ENTRIES) {
            size = rf_tiff_number(tiff, at + 4, 4);
            entries = rf_tiff_number(tiff, at + 8, 4);
        }
    }
    if (size < ENTRY_BYTES || entries > tiff.size || size > tiff.size - entries)
        return false;
    for (; size >= ENTRY_BYTES && mpf->count < RF_MPF_MAX; size -= ENTRY_BYTES) {
        mpf->image[mpf->count].type = rf_tiff_number(tiff, entries, 4) & 0xffffff;
        mpf->image[mpf->count].size = rf_tiff_number(tiff, entries + 4, 4);
        mpf->image[mpf->count].offset = rf_tiff_number(tiff, entries + 8, 4);
        mpf->count++;
        entries += ENTRY_BYTES;
    }
    return true;
}
