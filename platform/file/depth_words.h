/* depth_words.h: what samples mean, by the words of the command line. */
#ifndef RF_FILE_DEPTH_WORDS_H
#define RF_FILE_DEPTH_WORDS_H

#include <refocus/depth.h>

/* Give the map the meaning of a unit's words, for samples whose white is max_value; 0: floats.
 * REFOCUS_OK or REFOCUS_ERR_ARGUMENT. */
int rf_depth_set_unit(struct refocus_depth_map *map, const char *unit, double max_value);

#endif
