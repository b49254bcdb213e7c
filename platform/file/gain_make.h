/* gain_make.h: the gain map between a picture of 8 bits and the light that it shows. */
#ifndef RF_FILE_GAIN_MAKE_H
#define RF_FILE_GAIN_MAKE_H

#include "gain_map.h"
#include "rows.h"

/* Whether gains can be made of these: three linear halves, and a picture in RGB8. */
bool rf_gain_can_make(const struct rf_rows *base, const struct refocus_image *light);
/* Fill map->samples, whose pixels free() ends, and map->values; light may have another size. A map
 * has the sides of the smaller of the two. The other headroom is the greatest gain, or `headroom`
 * where that is more. REFOCUS_OK or REFOCUS_ERR_MEMORY. */
int rf_gain_make(struct rf_gain_map *map, const struct rf_rows *base,
                 const struct refocus_image *light, double headroom);
/* Copy a map into one range for all channels, which gain_write.h writes. REFOCUS_ERR_UNSUPPORTED,
 * and nothing to free, where channels have other offsets, or gains of one sample. As rf_gain_make()
 * otherwise. */
int rf_gain_copy(struct rf_gain_map *copy, const struct rf_gain_map *map);

#endif
