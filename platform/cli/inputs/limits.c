/* limits.c: the limits of picture files are the whole command's: files of any option may be
 * hostile. */
#include "inputs/limits.h"

const struct option limit_options[] = {
    {OPTION(OPTION_INTEGER, "--max-side", "N", struct limit_settings, side), .elsewhere = true,
     .least = 1, .greatest = REFOCUS_MAX_SIDE,
     .help = "refuse picture files with more pixels a side; default 32768"},
    {OPTION(OPTION_INTEGER, "--max-pixels", "N", struct limit_settings, pixels), .elsewhere = true,
     .least = 1, .greatest = 4294836225.0, /* REFOCUS_MAX_SIDE squared */
     .help = "refuse those with more pixels; default 201326592, 16384 x 12288"},
    {OPTION(OPTION_FLAG, "--raw-preview", NULL, struct limit_settings, raw_preview),
     .help =
         "of a camera raw its preview, the JPEG in it, instead of the photo that libraw develops"},
    {OPTION(OPTION_INTEGER, "--max-memory", "MIB", struct limit_settings, mebibytes),
     .elsewhere = true, .least = 1, .greatest = 1e9,
     .help = "refuse those that take more memory to read, in MiB; default half the machine's"},
    {.help = NULL},
};

static struct refocus_read_limits taken = {.struct_size = sizeof(struct refocus_read_limits)};

/* NAN is less than nothing here, too. */
static uint64_t count(double value)
{
    return value >= 1 ? (uint64_t)value : 0;
}

void limits_take(const struct limit_settings *settings)
{
    taken.max_side = (uint32_t)count(settings->side);
    taken.max_pixels = count(settings->pixels);
    taken.raw_preview = settings->raw_preview;
    taken.max_memory = count(settings->mebibytes) << 20;
}

const struct refocus_read_limits *limits_taken(void)
{
    return &taken;
}
