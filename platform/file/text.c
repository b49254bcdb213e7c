/* text.c: a text grows piece by piece, with numbers and Base64 (RFC 4648) as XMP has them. */
#include "text.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Sizes are those of bytes in memory, so that their sums stay below SIZE_MAX. */
static bool has_room(struct rf_text *text, size_t size)
{
    if (text->room - text->size < size && !text->failed) {
        const size_t room = text->size + size + text->size / 2;
        char *const data = realloc(text->data, room);

        text->failed = !data;
        if (data) {
            text->data = data;
            text->room = room;
        }
    }
    return !text->failed;
}

void rf_text_put(struct rf_text *text, const void *bytes, size_t size)
{
    if (size > 0 && has_room(text, size)) {
        memcpy(text->data + text->size, bytes, size);
        text->size += size;
    }
}

void rf_text_words(struct rf_text *text, const char *words)
{
    rf_text_put(text, words, strlen(words));
}

/* With 12 digits a reader that is off in the last bits writes the same ones again. The locale's
 * decimal point becomes a dot. */
void rf_text_number(struct rf_text *text, const char *name, double value)
{
    char number[64];

    snprintf(number, sizeof number, "%.12g", value);
    for (char *c = number; *c; c++)
        if (*c != '-' && *c != '+' && *c != 'e' && (*c < '0' || *c > '9'))
            *c = '.';
    rf_text_words(text, name);
    rf_text_words(text, "=\"");
    rf_text_words(text, number);
    rf_text_words(text, "\"");
}

void rf_text_base64(struct rf_text *text, struct rf_bytes bytes)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    char *out;

    if (!has_room(text, bytes.size / 3 * 4 + 4))
        return;
    out = text->data + text->size;
    for (size_t i = 0; i < bytes.size; i += 3) {
        const size_t n = bytes.size - i < 3 ? bytes.size - i : 3;
        const uint8_t *const b = bytes.data + i;
        const uint32_t bits =
            (uint32_t)b[0] << 16 | (n > 1 ? (uint32_t)b[1] << 8 : 0) | (n > 2 ? b[2] : 0);

        *out++ = digits[bits >> 18];
        *out++ = digits[bits >> 12 & 63];
        *out++ = n > 1 ? digits[bits >> 6 & 63] : '=';
        *out++ = n > 2 ? digits[bits & 63] : '=';
    }
    text->size = (size_t)(out - text->data);
}
