/* methods.h: finds a method by its number: its name, its limits and its operations. */
#ifndef RF_METHODS_H
#define RF_METHODS_H

#include "gather/method.h"

struct rf_method_info {
    const char *name, *summary;
    bool any_focus;   /* handles tilts, bands, fields and maps of focus, not only a plain lens */
    bool disc_only;   /* knows no other aperture */
    bool whole_photo; /* needs all planes at once: not in strip mode */
};

/* Describes a method, which is below REFOCUS_METHOD_COUNT. */
const struct rf_method_info *rf_method_info(uint32_t method);

/* Finds the operations of a method: the core's own, or those of `papers`, which may be NULL.
 * Returns NULL if there are none. */
const struct rf_method *rf_method_of(const struct refocus_papers *papers, uint32_t method);

/* The methods that can be rendered with `papers`, REFOCUS_METHOD_BIT() of each: those in `asked`
 * and those that need no memory of their own. */
uint32_t rf_methods_of(const struct refocus_papers *papers, uint32_t asked);

/* Whether `papers`, not NULL, is of the build of this core. */
bool rf_papers_fit(const struct refocus_papers *papers);

#endif
