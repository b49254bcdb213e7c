/* transfer.h: the curves by which photos of more than 8 bits store light. */
#ifndef RF_CLI_TRANSFER_H
#define RF_CLI_TRANSFER_H

#include <stdint.h>
#include "line/option.h"

/* Words of --transfer. */
extern const struct option_word transfer_words[];

/* Rows of a table of options; `member` is a struct depth_settings. */
#define TRANSFER_OPTIONS(type, member)                                                             \
    {OPTION(OPTION_CHOICE, "--transfer", "CURVE", type, member.transfer), .words = transfer_words, \
     .help = "how a photo of more than 8 bits stores light; default auto"},                        \
    {                                                                                              \
        OPTION(OPTION_NUMBER, "--white", "LIGHT", type, member.white),                             \
            .least = 1 / 65536.0, .greatest = 65536,                                               \
            .help = "light of such a photo that is shown as white, cd/m2 with pq; what is "        \
                    "brighter keeps "                                                              \
                    "its light out of focus; default 1, 203 with pq, 0.265 with hlg"               \
    }

#endif
