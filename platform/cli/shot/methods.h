/* methods.h: which methods can do what. */
#ifndef RF_CLI_METHODS_H
#define RF_CLI_METHODS_H

#include <refocus/render.h>
#include <stdbool.h>

bool method_takes_rays(uint32_t method);

enum { METHOD_WORDS = 24 * REFOCUS_METHOD_COUNT };

/* Lists the methods that have a trait, or have it not: "sweep, search or blur". Returns text. */
const char *method_words(char text[METHOD_WORDS], enum refocus_method_trait trait, bool have);

#endif
