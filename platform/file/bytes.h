/* bytes.h: a stretch of memory that somebody else owns, as readers hand it to each other, and the
 * numbers in it. */
#ifndef RF_FILE_BYTES_H
#define RF_FILE_BYTES_H

#include <stddef.h>
#include <stdint.h>

struct rf_bytes {
    const uint8_t *data;
    size_t size;
};

/* Unsigned numbers of 0 to 4 bytes, which are there, the highest or the lowest byte first. */
static inline uint32_t rf_big_endian(const uint8_t *from, size_t bytes)
{
    uint32_t value = 0;

    for (size_t i = 0; i < bytes; i++)
        value = value << 8 | from[i];
    return value;
}

static inline uint32_t rf_little_endian(const uint8_t *from, size_t bytes)
{
    uint32_t value = 0;

    while (bytes-- > 0)
        value = value << 8 | from[bytes];
    return value;
}

static inline void rf_put_big_endian(uint8_t *to, size_t bytes, uint32_t value)
{
    while (bytes-- > 0) {
        to[bytes] = (uint8_t)value;
        value >>= 8;
    }
}

/* One in a TIFF block, whose first byte says which. */
static inline uint32_t rf_tiff_number(struct rf_bytes tiff, size_t at, size_t bytes)
{
    return tiff.data[0] == 'M' ? rf_big_endian(tiff.data + at, bytes)
                               : rf_little_endian(tiff.data + at, bytes);
}

#endif
