/* methods.h: finds the operations of a method by its number. */
#ifndef RF_METHODS_H
#define RF_METHODS_H

#include "gather/method.h"

/* Finds the operations of a method: the core's own, or those of `papers`, which may be NULL.
 * Returns NULL if there are none. */
const struct rf_method *rf_method_of(const struct refocus_papers *papers, uint32_t method);

/* The methods that can be rendered with `papers`, REFOCUS_METHOD_BIT() of each: those in `asked`
 * and those that need no memory of their own. */
uint32_t rf_methods_of(const struct refocus_papers *papers, uint32_t asked);

/* Whether `papers`, not NULL, is of the build of this core. */
bool rf_papers_fit(const struct refocus_papers *papers);

#endif
