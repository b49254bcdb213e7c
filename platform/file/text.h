/* text.h: a text that grows, for the XMP that is written. */
#ifndef RF_FILE_TEXT_H
#define RF_FILE_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include "bytes.h"

/* It starts from zeros, and free() ends its data. It has failed once memory ran out. */
struct rf_text {
    char *data;
    size_t size, room;
    bool failed;
};

static inline struct rf_bytes rf_text_bytes(const struct rf_text *text)
{
    return (struct rf_bytes){(const uint8_t *)text->data, text->size};
}

void rf_text_put(struct rf_text *text, const void *bytes, size_t size);
void rf_text_words(struct rf_text *text, const char *words);
/* Put name="value", with 12 digits. */
void rf_text_number(struct rf_text *text, const char *name, double value);
void rf_text_base64(struct rf_text *text, struct rf_bytes bytes);

#endif
