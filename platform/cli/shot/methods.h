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
    /* methods that look at the number of rays */
    OF_RAYS = OF_SWEEP | OF_SEARCH | 1 << REFOCUS_METHOD_RAYTRACE | 1 << REFOCUS_METHOD_LIGHTFIELD |
              1 << REFOCUS_METHOD_BLUR,
};

/* For a row of a table of options whose settings have the method in `member`. */
#define OF_METHODS(type, member, methods)                                                          \
    .of = "--method", .of_words = methods, .of_word = refocus_method_name,                         \
    .of_offset = offsetof(type, member)

#endif
