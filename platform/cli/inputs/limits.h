/* limits.h: how large picture files may be, for all that a command reads. */
#ifndef RF_CLI_LIMITS_H
#define RF_CLI_LIMITS_H

#include <math.h>
#include <refocus/platform/file.h>
#include "line/option.h"

struct limit_settings {
    double side, pixels, mebibytes; /* NAN or 0: the defaults of the library */
    bool raw_preview;
};

#define LIMIT_SETTINGS_NONE                                                                        \
    {                                                                                              \
        NAN, NAN, NAN, false                                                                       \
    }
/* The options of struct limit_settings. */
extern const struct option limit_options[];

/* Settle the limits, before anything is read. */
void limits_take(const struct limit_settings *settings);

/* The limits of all picture files that the command reads. */
const struct refocus_read_limits *limits_taken(void);

#endif
