/* npy_format.c: a NumPy array as a format of depth maps. */
#include <stdio.h>
#include <string.h>

#include "format.h"
#include "npy.h"

static bool pull_file(void *from, uint8_t *bytes, size_t count)
{
    struct rf_bytes *const file = from;

    if (file->size < count)
        return false;
    memcpy(bytes, file->data, count);
    file->data += count;
    file->size -= count;
    return true;
}

static int read_npy(struct rf_read *read, struct rf_bytes file)
{
    snprintf(read->info->container, sizeof read->info->container, "NPY");
    return rf_npy_read(read, pull_file, &file, file.size);
}

const struct rf_format rf_format_npy = {
    .name = "NPY",
    .endings = {NULL},
    .recognise = rf_is_npy,
    .read = read_npy,
};
