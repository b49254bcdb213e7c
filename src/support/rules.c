/* rules.c: checks a number of a public struct against its rule. */
#include "support/rules.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* A double holds each of the three whole. */
static double value_of(const struct rf_rule *rule, const void *of)
{
    const void *at = (const char *)of + rule->offset;
    float real;
    int32_t whole;
    uint32_t natural;

    switch (rule->type) {
    case RF_REAL:
        memcpy(&real, at, sizeof real);
        return (double)real;
    case RF_SIGNED:
        memcpy(&whole, at, sizeof whole);
        return whole;
    default:
        memcpy(&natural, at, sizeof natural);
        return natural;
    }
}

/* A bound of 0.01 is the float that a caller writes for it, which is below the double. */
static double bound(const struct rf_rule *rule, double value)
{
    return rule->type == RF_REAL ? (double)(float)value : value;
}

static bool is_in_range(const struct rf_rule *rule, double value)
{
    const double least = bound(rule, rule->least);

    if (rule->has_other && value == rule->other)
        return true;
    return (rule->above ? value > least : value >= least) &&
           value <= bound(rule, rule->most); /* NaN is in no range */
}

int rf_check_rule(const struct rf_log *log, const struct rf_rule *rule, const void *of)
{
    const double value = value_of(rule, of);
    char other[32] = "", most[32] = "";

    if (is_in_range(rule, value))
        return REFOCUS_OK;
    if (rule->has_other)
        snprintf(other, sizeof other, ", or %.9g", rule->other);
    if (rule->most > rule->least)
        snprintf(most, sizeof most, " to %.9g", rule->most);
    return rf_refuse(log, REFOCUS_ERR_ARGUMENT, "%s is %.9g, may be %s%.9g%s%s", rule->name, value,
                     rule->above ? "above " : "", rule->least, most, other);
}
