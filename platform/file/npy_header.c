/* npy_header.c: the header of a NumPy array, a literal of Python, is taken apart:
 *
 *     {'descr': '<f4', 'fortran_order': False, 'shape': (480, 640), }
 */
#include "npy_header.h"

#include <stddef.h>
#include <string.h>

/* The header, a text that ends in 0. */
struct scan {
    const char *at;
};

static void skip_blanks(struct scan *scan)
{
    while (*scan->at == ' ' || (*scan->at >= '\t' && *scan->at <= '\r'))
        scan->at++;
}

/* Whether the next thing is that text, which is passed by then. */
static bool take(struct scan *scan, const char *text)
{
    const size_t length = strlen(text);

    skip_blanks(scan);
    if (strncmp(scan->at, text, length) != 0)
        return false;
    scan->at += length;
    return true;
}

/* A string in quotes, of which all must fit. */
static bool take_string(struct scan *scan, char *string, size_t size)
{
    const char quote = take(scan, "'") ? '\'' : '"';
    size_t length;

    if (quote == '"' && !take(scan, "\""))
        return false;
    for (length = 0; scan->at[length] && scan->at[length] != quote; length++) {
    }
    if (!scan->at[length] || length >= size)
        return false;
    memcpy(string, scan->at, length);
    string[length] = '\0';
    scan->at += length + 1;
    return true;
}

/* A side of the array, at most 2^32 - 1; Python 2 wrote an L behind it. */
static bool take_side(struct scan *scan, uint64_t *side)
{
    const char *begin;

    skip_blanks(scan);
    begin = scan->at;
    for (*side = 0; *scan->at >= '0' && *scan->at <= '9'; scan->at++) {
        *side = 10 * *side + (uint64_t)(*scan->at - '0');
        if (*side > UINT32_MAX)
            return false;
    }
    if (scan->at == begin)
        return false;
    take(scan, "L");
    return true;
}

static bool take_shape(struct scan *scan, struct rf_npy_header *header)
{
    if (!take(scan, "("))
        return false;
    for (header->sides = 0; !take(scan, ")");) {
        if (header->sides == RF_NPY_SIDES || !take_side(scan, &header->side[header->sides]))
            return false;
        header->sides++;
        if (!take(scan, ","))
            return take(scan, ")");
    }
    return true;
}

static bool take_entry(struct scan *scan, struct rf_npy_header *header)
{
    char key[16];

    if (!take_string(scan, key, sizeof key) || !take(scan, ":"))
        return false;
    if (strcmp(key, "descr") == 0)
        return take_string(scan, header->descr, sizeof header->descr);
    if (strcmp(key, "fortran_order") == 0) {
        header->columns = take(scan, "True");
        return header->columns || take(scan, "False");
    }
    return strcmp(key, "shape") == 0 && take_shape(scan, header);
}

bool rf_npy_scan(const char *text, struct rf_npy_header *header)
{
    struct scan scan = {text};

    memset(header, 0, sizeof *header);
    header->sides = -1;
    if (!take(&scan, "{"))
        return false;
    while (!take(&scan, "}"))
        if (!take_entry(&scan, header) || (!take(&scan, ",") && scan.at[0] != '}'))
            return false;
    return header->descr[0] && header->sides >= 0;
}
