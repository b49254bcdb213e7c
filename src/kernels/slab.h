/* slab.h: a slab, the range of signed blur that a ray looks for at one offset, and the test for it.
 *
 * An example: the slab of low 1024 and width 256 holds the blurs 1024 to 1280. Its limits are from
 * = 1024 ^ 0x8000 = 33792 and to = 1281 - 33792 = -32511. Blur 1100 lies in it, as 1100 - 33792 is
 * -32692 < -32511. Blur 1281 does not, as it yields -32511, and blur 1023 does not, as -32769 is
 * 32767 modulo 2^16.
 */
#ifndef RF_SLAB_H
#define RF_SLAB_H

#include <stdbool.h>
#include <stdint.h>

enum {
    RF_TILE = 16,  /* tiles are RF_TILE x RF_TILE pixels */
    RF_BINS = 256, /* bins of signed blur in a tile; no more slabs than bins */
};

/* Ray u sees the slab at round(u centre). */
struct rf_slab {
    int16_t low; /* a pixel of blur s is hit if 0 <= s - low <= width */
    uint16_t width;
    int16_t centre; /* Q7.8 */
};

/* 0 <= s - low <= width as one signed comparison, modulo 2^16, (s - from) < to, of vectors:
 * adding 2^15 to both sides makes it of an unsigned one. */
static inline uint16_t rf_range_from(const struct rf_slab *slab)
{
    return (uint16_t)(slab->low ^ 0x8000);
}

static inline uint16_t rf_range_until(const struct rf_slab *slab)
{
    return (uint16_t)(slab->low + slab->width + 1);
}

/* Returns `to` for the range from the first slab's low to the last one's end. */
static inline uint16_t rf_range_to(const struct rf_slab *first, const struct rf_slab *last)
{
    return (uint16_t)(rf_range_until(last) - rf_range_from(first));
}

static inline bool rf_in_range(uint16_t from, uint16_t to, int16_t blur)
{
    return (int16_t)(uint16_t)(blur - from) < (int16_t)to;
}

#endif
