/* places.h: lists of places with room for so many, of which the first stay, row by row, in
 * whichever order they come.
 *
 * An entry of any type begins with its x and y, uint16_t both. A full list is a heap whose last
 * place comes first.
 */
#ifndef RF_PLACES_H
#define RF_PLACES_H

#include <stddef.h>
#include <stdint.h>

/* One more, of `size` bytes, to *count of them. */
void rf_add_place(void *list, uint32_t *count, uint32_t capacity, const void *entry, size_t size);

/* Put them in the order of the rows. */
void rf_sort_places(void *list, uint32_t count, size_t size);

#endif
