/* selector.c: the memory of a selection is kept for the next one. */
#include <stdlib.h>
#include "selector.h"

void *rf_selector_scratch(struct rf_selector *selector, int which, int64_t count, size_t size)
{
    void *more;
    size_t bytes;

    if (count <= 0)
        count = 1;
    if ((uint64_t)count > SIZE_MAX / 2 / size)
        return NULL;
    bytes = (size_t)count * size;
    if (bytes <= selector->scratch[which].size)
        return selector->scratch[which].memory;
    more = malloc(bytes);
    if (!more)
        return NULL;
    free(selector->scratch[which].memory);
    selector->scratch[which].memory = more;
    selector->scratch[which].size = bytes;
    return more;
}

void rf_selector_free(struct rf_selector *selector)
{
    rf_cut_free(&selector->cut);
    for (size_t i = 0; i < sizeof selector->scratch / sizeof *selector->scratch; i++)
        free(selector->scratch[i].memory);
}
