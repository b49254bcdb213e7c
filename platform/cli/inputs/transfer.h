/* transfer.h: the curves by which photos of more than 8 bits store light. */
#ifndef RF_CLI_TRANSFER_H
#define RF_CLI_TRANSFER_H

#include <stdint.h>
#include "line/option.h"

/* Words of --transfer. */
extern const struct option_word transfer_words[];

#endif
