/* depth_options.h: the options of depth, as groups for the tables of commands. */
#ifndef RF_CLI_DEPTH_OPTIONS_H
#define RF_CLI_DEPTH_OPTIONS_H

#include "line/option.h"

/* All are of struct depth_settings. */
extern const struct option depth_file_options[], depth_unit_options[], depth_ways_options[];
extern const struct option depth_edges_options[], orient_depth_options[], upsample_options[];
extern const struct option light_options[], matte_options[], invalid_options[], repair_options[];

#endif
