/* check.c: the texts of a request, all of which may be hostile, are checked. */
#include <arpa/inet.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include "../file/letters.h"
#include "check.h"
#include "web.h"

const char *rf_check_path(const char *path, const char *token)
{
    unsigned different = 0;

    if (strlen(path) < RF_WEB_SESSION + 2 || path[0] != '/' || path[RF_WEB_SESSION + 1] != '/')
        return NULL;
    for (int i = 0; i < RF_WEB_SESSION; i++)
        different |= (unsigned)(path[i + 1] ^ token[i]);
    return different == 0 ? path + RF_WEB_SESSION + 2 : NULL;
}

bool rf_check_number(const char *text, long least, long most, long *value)
{
    const size_t digits = strspn(text, "0123456789");
    long number = 0;

    if (digits == 0 || digits > 9 || text[digits] != '\0')
        return false;
    for (size_t i = 0; i < digits; i++)
        number = 10 * number + (text[i] - '0');
    *value = number;
    return number >= least && number <= most;
}

/* "1.2.3.4" or "[::1]" or "localhost". */
static bool is_machine(const char *name)
{
    const size_t length = strlen(name);
    unsigned char address[16];
    char inner[64];

    if (name[0] == '[' && length > 2 && length < sizeof inner && name[length - 1] == ']') {
        memcpy(inner, name + 1, length - 2);
        inner[length - 2] = '\0';
        return inet_pton(AF_INET6, inner, address) == 1;
    }
    return rf_same_word(name, "localhost") || inet_pton(AF_INET, name, address) == 1;
}

/* The part of an origin behind its scheme, or NULL. */
static const char *behind_scheme(const char *origin)
{
    static const char *const schemes[] = {"https://", "http://"};

    for (size_t i = 0; origin && i < sizeof schemes / sizeof *schemes; i++)
        if (strncmp(origin, schemes[i], strlen(schemes[i])) == 0)
            return origin + strlen(schemes[i]);
    return NULL;
}

bool rf_check_public(const char *origin)
{
    static const char letters[] =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.-:[]";
    const char *const host = behind_scheme(origin);

    return host && host[0] && host[strspn(host, letters)] == '\0' && strlen(host) < 256;
}

bool rf_check_host(const char *host, int port, const char *public)
{
    const char *const other = behind_scheme(public);
    const char *const colon = host ? strrchr(host, ':') : NULL;
    char name[64];
    long given;

    if (host && other && rf_same_word(host, other))
        return true;
    if (!host || strlen(host) >= sizeof name)
        return false;
    strcpy(name, host);
    if (colon && !strchr(colon, ']')) {
        name[colon - host] = '\0';
        return rf_check_number(colon + 1, 1, 65535, &given) && given == port && is_machine(name);
    }
    return port == 80 && is_machine(name);
}

bool rf_check_origin(const char *origin, const char *host, const char *public)
{
    static const char scheme[] = "http://";

    if (origin && public && rf_same_word(origin, public))
        return true;
    return !origin || (strncmp(origin, scheme, sizeof scheme - 1) == 0 &&
                       rf_same_word(origin + sizeof scheme - 1, host));
}

/* Bytes of the character of UTF-8 that begins there, 1 to 4; 0: it is none. */
static size_t character(const unsigned char *at)
{
    static const uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
    const size_t length = at[0] < 0x80 ? 1 : at[0] >> 5 == 6 ? 2 : at[0] >> 4 == 14 ? 3 : 4;
    uint32_t code = at[0];

    if (length == 1)
        return 1;
    if (length == 4 && at[0] >> 3 != 30)
        return 0;
    code = at[0] & (0xffu >> (length + 1));
    for (size_t i = 1; i < length; i++) {
        if (at[i] >> 6 != 2)
            return 0;
        code = code << 6 | (at[i] & 63u);
    }
    return code >= least[length] && code <= 0x10ffff && (code < 0xd800 || code > 0xdfff) ? length
                                                                                         : 0;
}

bool rf_check_name(const char *name, size_t length)
{
    const unsigned char *const bytes = (const unsigned char *)name;

    if (length < 1 || length > 255 || strlen(name) != length || name[0] == '.')
        return false;
    for (size_t i = 0, step; i < length; i += step) {
        step = character(bytes + i);
        if (step == 0 || bytes[i] < 32 || bytes[i] == 127 || bytes[i] == '/' || bytes[i] == '\\')
            return false;
    }
    return true;
}

bool rf_check_session(const char *text)
{
    return strspn(text, "0123456789abcdef") == RF_WEB_SESSION && text[RF_WEB_SESSION] == '\0';
}

bool rf_check_photo_ending(const char *name)
{
    static const char *const endings[] = {
        /* pictures, and what libraw takes for camera raw */
        "jpg", "jpeg", "jpe", "jfif", "mpo", "png", "heic", "heif", "hif", "avif", "tif", "tiff",
        "exr", "webp", "jxl", "ppm",  "pgm", "pfm", "3fr",  "arw",  "cr2", "cr3",  "crw", "dcr",
        "dng", "erf",  "fff", "gpr",  "iiq", "kdc", "mef",  "mos",  "mrw", "nef",  "nrw", "orf",
        "pef", "raf",  "raw", "rw2",  "rwl", "sr2", "srf",  "srw",  "x3f"};
    const char *const dot = strrchr(name, '.');

    for (size_t i = 0; dot && i < sizeof endings / sizeof *endings; i++)
        if (rf_same_word(dot + 1, endings[i]))
            return true;
    return false;
}
