/* methods.c: which methods can do what, as options and errors want it. */
#include <stdio.h>
#include "shot/methods.h"

bool method_takes_rays(uint32_t method)
{
    return (refocus_method_traits(method) & REFOCUS_METHOD_TAKES_RAYS) != 0;
}

const char *method_words(char text[METHOD_WORDS], enum refocus_method_trait trait, bool have)
{
    int n = 0, last = -1;

    for (int i = 0; i < REFOCUS_METHOD_COUNT; i++)
        if (((refocus_method_traits((uint32_t)i) & trait) != 0) == have)
            last = i;
    text[0] = '\0';
    for (int i = 0; i <= last; i++)
        if (((refocus_method_traits((uint32_t)i) & trait) != 0) == have)
            n += snprintf(text + n, (size_t)(METHOD_WORDS - n), "%s%s",
                          n == 0      ? ""
                          : i == last ? " or "
                                      : ", ",
                          refocus_method_name((uint32_t)i));
    return text;
}
