/* places.c: keeps the first places, row by row, of a list that is full. */
#include "support/places.h"

#include <stdbool.h>
#include <string.h>

enum { MOST_SIZE = 64 };

struct place {
    uint16_t x, y;
};

static struct place place_of(const void *entry)
{
    struct place place;

    memcpy(&place, entry, sizeof place);
    return place;
}

/* Whether a comes after b, row by row. */
static bool is_later_place(const void *a, const void *b)
{
    const struct place p = place_of(a), q = place_of(b);

    return p.y > q.y || (p.y == q.y && p.x > q.x);
}

static uint8_t *at(void *list, uint32_t i, size_t size)
{
    return (uint8_t *)list + (size_t)i * size;
}

/* Lets entry i of a heap of n sink to where it belongs. */
static void sink(void *list, uint32_t i, uint32_t n, size_t size, rf_after_fn *is_after)
{
    uint8_t own[MOST_SIZE];

    memcpy(own, at(list, i, size), size);
    for (uint32_t child; (child = 2 * i + 1) < n; i = child) {
        child += child + 1 < n && is_after(at(list, child + 1, size), at(list, child, size));
        if (!is_after(at(list, child, size), own))
            break;
        memcpy(at(list, i, size), at(list, child, size), size);
    }
    memcpy(at(list, i, size), own, size);
}

static void make_heap(void *list, uint32_t n, size_t size, rf_after_fn *is_after)
{
    for (uint32_t i = n / 2; i > 0; i--)
        sink(list, i - 1, n, size, is_after);
}

void rf_add_place(void *list, uint32_t *count, uint32_t capacity, const void *entry, size_t size)
{
    if (*count < capacity) {
        memcpy(at(list, (*count)++, size), entry, size);
        if (*count == capacity)
            make_heap(list, *count, size, is_later_place);
    } else if (capacity && is_later_place(list, entry)) {
        memcpy(list, entry, size);
        sink(list, 0, capacity, size, is_later_place);
    }
}

void rf_sort_places(void *list, uint32_t count, size_t size)
{
    rf_sort(list, count, size, is_later_place);
}

void rf_sort(void *list, uint32_t count, size_t size, rf_after_fn *is_after)
{
    make_heap(list, count, size, is_after);
    for (uint32_t left = count; left > 1;) {
        uint8_t last[MOST_SIZE];

        memcpy(last, list, size);
        left--;
        memcpy(list, at(list, left, size), size);
        memcpy(at(list, left, size), last, size);
        sink(list, 0, left, size, is_after);
    }
}
