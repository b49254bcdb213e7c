/* methods.h: which options belong to which methods. */
#ifndef RF_CLI_METHODS_H
#define RF_CLI_METHODS_H

#include <refocus/render.h>
#include "line/options.h"

enum of_methods {
    OF_SWEEP = 1 << REFOCUS_METHOD_SWEEP,
    OF_SEARCH = 1 << REFOCUS_METHOD_SEARCH,
    OF_JITTERED = 1 << REFOCUS_METHOD_JITTERED,
    OF_SCATTER = 1 << REFOCUS_METHOD_SCATTER,
    OF_FOVEATED = 1 << REFOCUS_METHOD_FOVEATED,
    OF_INTERPOLATED = 1 << REFOCUS_METHOD_INTERPOLATED,
    OF_DIFFUSION = 1 << REFOCUS_METHOD_DIFFUSION,
};

/* For a row of a table of options whose settings have the method in `member`. */
#define OF_METHODS(type, member, methods)                                                          \
    .of = "--method", .of_words = methods, .of_word = refocus_method_name,                         \
    .of_offset = offsetof(type, member)
/* As OF_METHODS, for the methods that `takes` is true of. */
#define OF_METHODS_THAT(type, member, takes)                                                       \
    .of = "--method", .of_takes = takes, .of_word = refocus_method_name,                           \
    .of_offset = offsetof(type, member)

bool method_takes_rays(uint32_t method);

enum { METHOD_WORDS = 24 * REFOCUS_METHOD_COUNT };

/* Lists the methods that have a trait, or have it not: "sweep, search or blur". Returns text. */
const char *method_words(char text[METHOD_WORDS], enum refocus_method_trait trait, bool have);

#endif
