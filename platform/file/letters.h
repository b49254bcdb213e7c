/* letters.h: words of files and names are compared by the letters of ASCII. strcasecmp() and
 * tolower() follow the locale: in Turkish ones ".TIF" is not ".tif". */
#ifndef RF_FILE_LETTERS_H
#define RF_FILE_LETTERS_H

#include <stdbool.h>
#include <stddef.h>

static inline char rf_lower(char c)
{
    return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

/* Returns how many characters two words begin with that differ in case at the most. */
static inline size_t rf_letters_alike(const char *a, const char *b)
{
    size_t n = 0;

    while (a[n] && rf_lower(a[n]) == rf_lower(b[n]))
        n++;
    return n;
}

static inline bool rf_same_word(const char *a, const char *b)
{
    const size_t n = rf_letters_alike(a, b);

    return a[n] == b[n];
}

static inline bool rf_begins_with(const char *word, const char *beginning)
{
    return beginning[rf_letters_alike(word, beginning)] == '\0';
}

#endif
