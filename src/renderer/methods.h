/* methods.h: the methods by number: what each can do, and its operations. */
#ifndef RF_METHODS_H
#define RF_METHODS_H

#include "gather/method.h"

struct rf_method_info {
    const char *name, *summary;
    bool any_focus;   /* takes tilts, bands, fields and maps of focus; others only a plain lens */
    bool disc_only;   /* knows no other aperture */
    bool whole_photo; /* needs all planes at once: not in strip mode */
};

/* Of a method below REFOCUS_METHOD_COUNT. */
const struct rf_method_info *rf_method_info(uint32_t method);

/* Its operations: the core's own, or those of `papers`, which may be NULL. NULL: there are none. */
const struct rf_method *rf_method_of(const struct refocus_papers *papers, uint32_t method);

/* The methods that can be rendered with `papers`, REFOCUS_METHOD_BIT() of each, of those in `asked`
 * and those that need no memory of their own. */
uint32_t rf_methods_of(const struct refocus_papers *papers, uint32_t asked);

/* Whether `papers`, not NULL, is of the build of this core. */
bool rf_papers_fit(const struct refocus_papers *papers);

#endif
