/* places.h: lists of places with limited room. Of more places the first ones stay, row by row, in
 * whichever order they come.
 *
 * An entry of any type begins with its x and y, uint16_t both. A full list is a heap whose last
 * place comes first.
 */
#ifndef RF_PLACES_H
#define RF_PLACES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Adds an entry of `size` bytes to the *count of a list, or drops it if the list is full of earlier
 * places. */
void rf_add_place(void *list, uint32_t *count, uint32_t capacity, const void *entry, size_t size);

/* Sorts the entries row by row. */
void rf_sort_places(void *list, uint32_t count, size_t size);

/* Sorts entries of any type, of up to 64 bytes, by whether one comes after another. */
typedef bool rf_after_fn(const void *a, const void *b);
void rf_sort(void *list, uint32_t count, size_t size, rf_after_fn *is_after);

#endif
