/* exif_block.h: the entries of a TIFF block, as EXIF is one. None lies outside of the block. */
#ifndef RF_FILE_EXIF_BLOCK_H
#define RF_FILE_EXIF_BLOCK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct rf_tiff {
    uint8_t *data;
    size_t size;
    bool big_endian;
};

struct rf_tiff_entry {
    size_t place; /* offset of the 12 bytes of the entry */
    uint32_t tag, type, count;
    size_t value; /* offset of the value */
};

enum {
    RF_TIFF_ASCII = 2,
    RF_TIFF_SHORT = 3,
    RF_TIFF_LONG = 4,
    RF_TIFF_RATIONAL = 5,
    RF_TIFF_UNDEFINED = 7,
    RF_TIFF_SIGNED_RATIONAL = 10
};

uint32_t rf_tiff_get16(const struct rf_tiff *tiff, size_t at);
uint32_t rf_tiff_get32(const struct rf_tiff *tiff, size_t at);
void rf_tiff_put16(struct rf_tiff *tiff, size_t at, uint32_t value);
/* Entries that a directory really has room for; -1 when not even their number fits. */
int rf_tiff_count(const struct rf_tiff *tiff, size_t directory);
/* False for an entry whose value lies outside the block or is of no type used here. */
bool rf_tiff_entry(const struct rf_tiff *tiff, size_t directory, int index,
                   struct rf_tiff_entry *entry);
/* The whole number at an index below the count; 0 for another type. */
uint32_t rf_tiff_integer(const struct rf_tiff *tiff, const struct rf_tiff_entry *entry,
                         uint32_t index);
/* Replace a single whole number, where its type can hold the new one. */
void rf_tiff_set_integer(struct rf_tiff *tiff, const struct rf_tiff_entry *entry, uint32_t value);
/* Take the entries of a tag out of a directory; those behind them move up. */
void rf_tiff_drop(struct rf_tiff *tiff, size_t directory, uint32_t tag);
/* Overwrite the thumbnail behind the main directory with zeros, its directory and the link to it.
 */
void rf_tiff_drop_thumbnail(struct rf_tiff *tiff, size_t directory);

#endif
