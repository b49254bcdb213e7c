/* base64.c: Base64 (RFC 4648) is decoded where it stands. */
#include "base64.h"

#include <stdbool.h>
#include <stdint.h>

/* The value of a character: 0 to 63; 64 for '='; 65 for blanks, which are skipped; 66 for any
 * other. */
static int value_of(char c)
{
    if (c >= 'A' && c <= 'Z')
        return c - 'A';
    if (c >= 'a' && c <= 'z')
        return c - 'a' + 26;
    if (c >= '0' && c <= '9')
        return c - '0' + 52;
    switch (c) {
    case '+':
        return 62;
    case '/':
        return 63;
    case '=':
        return 64;
    case ' ':
    case '\t':
    case '\r':
    case '\n':
        return 65;
    default:
        return 66;
    }
}

size_t rf_base64_decode(char *text, size_t length)
{
    uint32_t bits = 0;
    int held = 0; /* bits not yet written: 0, 6, 4 or 2 */
    bool ended = false;
    size_t n = 0;

    for (size_t i = 0; i < length; i++) {
        const int value = value_of(text[i]);

        if (value == 65)
            continue;
        if (value == 66 || (ended && value != 64))
            return (size_t)-1;
        if (value == 64) {
            ended = true;
            continue;
        }
        bits = bits << 6 | (uint32_t)value;
        held += 6;
        if (held >= 8) {
            held -= 8;
            text[n++] = (char)(uint8_t)(bits >> held);
        }
    }
    /* A last character by itself carries no whole byte. */
    return held == 6 ? (size_t)-1 : n;
}
