/* fuzz_check.c: texts of a request as they come from the network, each by itself and after another:
 * what is taken is what it has to be. The first byte says which one it is. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "check.h"
#include "web.h"

static const char token[] = "0123456789abcdef0123456789abcdef";

static void check_path(const char *text)
{
    const char *const name = rf_check_path(text, token);

    if (name && (strncmp(text + 1, token, RF_WEB_SESSION) != 0 || name[-1] != '/' ||
                 name != text + RF_WEB_SESSION + 2))
        abort();
}

static void check_host(const char *text)
{
    const char *const colon = strrchr(text, ':');

    if (rf_check_host(text, 8085, NULL) && (!colon || atoi(colon + 1) != 8085))
        abort();
    if (rf_check_host(text, 8085, NULL) && strpbrk(text, "@/ \\"))
        abort();
    if (rf_check_host(text, 8085, "https://a.example") != rf_check_host(text, 8085, NULL) &&
        strcasecmp(text, "a.example") != 0)
        abort();
    if (rf_check_origin(text, "127.0.0.1:8085", NULL) && strcmp(text, "http://127.0.0.1:8085") != 0)
        abort();
    if (rf_check_public(text) && (strncmp(text, "http", 4) != 0 || strpbrk(text, "@ \\?#")))
        abort();
}

static void check_name(const char *text, size_t size)
{
    if (rf_check_name(text, size) &&
        (strpbrk(text, "/\\\n") || text[0] == '.' || strlen(text) != size || size > 255))
        abort();
    rf_check_photo_ending(text);
}

static void check_number(const char *text)
{
    long value = -1;

    if (rf_check_number(text, 3, 65535, &value) && (value < 3 || value > 65535 || strlen(text) > 9))
        abort();
    if (rf_check_session(text) && strlen(text) != RF_WEB_SESSION)
        abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *const text = calloc(1, size + 1);

    if (size == 0 || !text) {
        free(text);
        return 0;
    }
    memcpy(text, data + 1, size - 1);
    check_path(text);
    check_host(text);
    check_name(text, size - 1);
    check_number(text);
    free(text);
    return 0;
}
