/* draw.h: chances that all bytes of an input decide together. Large pictures, several threads and
 * what is done twice are slow and find little, and are drawn for few inputs: each change of an
 * input draws anew, so that they stay rare whatever a search keeps. */
#ifndef RF_FUZZ_DRAW_H
#define RF_FUZZ_DRAW_H

#include <stddef.h>
#include <stdint.h>

/* Takes two bytes, which make_corpus.py sets for its seeds so that the upper eleven bits are 0, and
 * gives 32 bits. */
static inline uint32_t draw(const uint8_t **data, size_t *size)
{
    uint32_t sum = 0;

    if (*size >= 2) {
        sum = (uint32_t)(*data)[0] << 8 | (*data)[1];
        *data += 2;
        *size -= 2;
    }
    for (size_t i = 0; i < *size; i++)
        sum += (*data)[i];
    return sum * 2654435769u;
}

#endif
