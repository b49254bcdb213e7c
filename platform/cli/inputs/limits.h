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
/* Rows for tables of options, where the settings have a member of the type above. */
#define LIMIT_OPTIONS(type, member)                                                                \
    {OPTION(OPTION_INTEGER, "--max-side", "N", type, member.side), .elsewhere = true, .least = 1,  \
     .greatest = REFOCUS_MAX_SIDE,                                                                 \
     .help = "refuse picture files with more pixels a side; default 32768"},                       \
        {OPTION(OPTION_INTEGER, "--max-pixels", "N", type, member.pixels), .elsewhere = true,      \
         .least = 1, .greatest = 4294836225.0, /* REFOCUS_MAX_SIDE squared */                      \
         .help = "refuse those with more pixels; default 201326592, 16384 x 12288"},               \
        {OPTION(OPTION_FLAG, "--raw-preview", NULL, type, member.raw_preview), .elsewhere = true,  \
         .help = "of a camera raw its preview, the JPEG in it, instead of the photo that libraw "  \
                 "develops"},                                                                      \
    {                                                                                              \
        OPTION(OPTION_INTEGER, "--max-memory", "MIB", type, member.mebibytes),                     \
            .elsewhere = true, .least = 1, .greatest = 1e9,                                        \
            .help =                                                                                \
                "refuse those that take more memory to read, in MiB; default half the machine's"   \
    }

/* Settle the limits, before anything is read. */
void limits_take(const struct limit_settings *settings);

/* The limits of all picture files that the command reads. */
const struct refocus_read_limits *limits_taken(void);

#endif
