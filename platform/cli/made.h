/* Words for depth that is made of pictures. */
#ifndef RF_CLI_MADE_H
#define RF_CLI_MADE_H

#include <stdint.h>

/* Presets of --preset; NULL ends them. */
const char *made_preset(uint32_t index);

#endif
