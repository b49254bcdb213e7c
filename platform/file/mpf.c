/* mpf.c: the index of pictures in a file is read (CIPA DC-007, Multi-Picture Format): a TIFF
 * directory with one entry a picture. */
#include "mpf.h"

#include <string.h>

enum { TAG_ENTRIES = 0xb002, ENTRY_BYTES = 16 };

static uint32_t get(struct rf_bytes tiff, size_t at, int bytes)
{
    const bool big_endian = tiff.data[0] == 'M';
    uint32_t value = 0;

    for (int i = 0; i < bytes; i++) {
        value = value << 8 | tiff.data[at + (size_t)(big_endian ? i : bytes - 1 - i)];
    }
    return value;
}

bool rf_mpf_parse(struct rf_bytes tiff, struct rf_mpf *mpf)
{
    size_t directory, entries = 0, size = 0;
    uint32_t tags;

    memset(mpf, 0, sizeof *mpf);
    if (tiff.size < 10 ||
        (memcmp(tiff.data, "MM\0*", 4) != 0 && memcmp(tiff.data, "II*\0", 4) != 0)) {
        return false;
    }
    directory = get(tiff, 4, 4);
    if (directory > tiff.size - 2) {
        return false;
    }
    tags = get(tiff, directory, 2);
    if (tags > (tiff.size - directory - 2) / 12) {
        return false;
    }
    for (uint32_t i = 0; i < tags; i++) {
        const size_t at = directory + 2 + (size_t)i * 12;
        if (get(tiff, at, 2) == TAG_ENTRIES) {
            size = get(tiff, at + 4, 4);
            entries = get(tiff, at + 8, 4);
        }
    }
    if (size < ENTRY_BYTES || entries > tiff.size || size > tiff.size - entries) {
        return false;
    }
    for (; size >= ENTRY_BYTES && mpf->count < RF_MPF_MAX; size -= ENTRY_BYTES) {
        mpf->image[mpf->count].type = get(tiff, entries, 4) & 0xffffff;
        mpf->image[mpf->count].size = get(tiff, entries + 4, 4);
        mpf->image[mpf->count].offset = get(tiff, entries + 8, 4);
        mpf->count++;
        entries += ENTRY_BYTES;
    }
    return true;
}
