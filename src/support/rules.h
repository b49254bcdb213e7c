/* rules.h: tables of what the numbers in a public struct may be, and one check for all of them. */
#ifndef RF_RULES_H
#define RF_RULES_H

#include <stdbool.h>
#include <stddef.h>

#include "support/log.h"

enum { RF_RULE_BYTES = 4 }; /* size of every field that has a rule */

enum rf_rule_type { RF_REAL, RF_SIGNED, RF_UNSIGNED }; /* float, int32_t, uint32_t */

/* A field may be least to most, or one value beside them. */
struct rf_rule {
    const char *name;
    size_t offset; /* in its struct */
    enum rf_rule_type type;
    bool above; /* above least, not least itself */
    bool has_other;
    double least, most, other;
};

#define RF_RULE(name, offset, type, least, most)                                                   \
    {                                                                                              \
        name, offset, type, false, false, least, most, 0                                           \
    }

/* REFOCUS_OK, or REFOCUS_ERR_ARGUMENT with a line on what the field is and may be. */
int rf_check_rule(const struct rf_log *log, const struct rf_rule *rule, const void *of);

#endif
