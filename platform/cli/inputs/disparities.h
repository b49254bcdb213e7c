/* disparities.h: the samples of a depth map become the disparities that are rendered. */
#ifndef RF_CLI_DISPARITIES_H
#define RF_CLI_DISPARITIES_H

#include "inputs/input.h"

/* Whether edges of the disparities go to the photo's: where there is a photo, unless the settings
 * say otherwise. */
bool input_has_edges_placed(const struct input *input, const struct depth_settings *settings);

/* How sure each disparity is, 255 to 0, where the renderer is to enlarge the map by that; else
 * NULL. */
const uint8_t *input_confidence(const struct input *input);

/* refocus_depth_repair() of a map as it lies, before it is turned, into packed disparities; by the
 * colours of the photo, if there is one of 8 bits. */
int input_repair(const struct input *input, const struct refocus_depth_map *map,
                 struct refocus_repair_params *params, uint16_t *disparity,
                 struct refocus_depth_report *report);

/* These return exit codes and print why it is not EXIT_DONE. */

/* Check that the map's nearest distance is nearer than its farthest. */
int input_check_range(const struct input *input, const struct refocus_depth_map *map);

/* Make the disparities from input->depth_from: repaired and enlarged as the settings say. */
int input_convert(struct input *input, const struct depth_settings *settings);

/* The disparities as depth_settings.full makes them, packed, of the photo's size, to be freed; the
 * input stays as it is. */
int input_placed(const struct input *input, const struct depth_settings *settings,
                 uint16_t **placed);

#endif
