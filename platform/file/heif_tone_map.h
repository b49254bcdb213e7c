/* heif_tone_map.h: the gain map that a HEIF container holds for its main picture. */
#ifndef RF_FILE_HEIF_TONE_MAP_H
#define RF_FILE_HEIF_TONE_MAP_H

#include <stdbool.h>
#include "bytes.h"

struct rf_heif_tone_map {
    struct rf_bytes metadata; /* ISO 21496-1, from the version of its form on; in the file */
    uint32_t item;            /* number of the gain map */
};

/* Find the first item that is made of the main picture and a gain map. */
bool rf_heif_find_tone_map(struct rf_bytes file, struct rf_heif_tone_map *map);
/* *changed becomes a copy of the file, as long as it, in which an item is the main picture, and
 * not hidden; the caller frees it. Returns REFOCUS_OK, REFOCUS_ERR_FORMAT (the file has no such
 * item) or REFOCUS_ERR_MEMORY; *changed is NULL on an error. */
int rf_heif_with_main_picture(struct rf_bytes file, uint32_t item, uint8_t **changed);

#endif
