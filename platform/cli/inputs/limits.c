/* limits.c: the limits of picture files are the whole command's: files of any option may be
 * hostile. */
#include "inputs/limits.h"

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
