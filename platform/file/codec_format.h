/* codec_format.h: what the row of a format that is a module calls. */
#ifndef RF_FILE_CODEC_FORMAT_H
#define RF_FILE_CODEC_FORMAT_H

#include "codec.h"
#include "format.h"

/* A module, by its name, once it is loaded. */
struct rf_codec_slot {
    const char *name;
    const struct rf_codec *codec;
};

int rf_codec_read(const struct rf_format *format, struct rf_codec_slot *slot, struct rf_read *read,
                  struct rf_bytes file);
int rf_codec_write(const struct rf_format *format, struct rf_codec_slot *slot,
                   struct rf_store *store, const struct rf_rows *rows,
                   const struct refocus_write_options *options, struct refocus_reason *reason);

/* Functions of the row of rf_format_FORMAT, which the module refocus-FORMAT.so reads and writes. */
#define RF_CODEC_READ(format)                                                                      \
    static struct rf_codec_slot slot_##format = {#format, NULL};                                   \
    static int read_##format(struct rf_read *read, struct rf_bytes file)                           \
    {                                                                                              \
        return rf_codec_read(&rf_format_##format, &slot_##format, read, file);                     \
    }
#define RF_CODEC_WRITE(format)                                                                     \
    static int write_##format(struct rf_store *store, const struct rf_rows *rows,                  \
                              const struct refocus_write_options *options,                         \
                              struct refocus_reason *reason)                                       \
    {                                                                                              \
        return rf_codec_write(&rf_format_##format, &slot_##format, store, rows, options, reason);  \
    }

#endif
