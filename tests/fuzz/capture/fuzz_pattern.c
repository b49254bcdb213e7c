/* fuzz_pattern.c: patterns of file names: what is accepted makes names that differ, and fit. */
#include <stdlib.h>
#include <string.h>
#include "with_failures.h"
#include "pattern.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char pattern[300], first[256], second[256];
    int kind;

    if (size >= sizeof pattern)
        return 0;
    memcpy(pattern, data, size);
    pattern[size] = '\0';
    kind = rf_pattern_check(pattern);
    if (kind < -1 || kind > 1)
        abort();
    if (kind >= 0 && rf_pattern_name(first, sizeof first, pattern, 1) &&
        rf_pattern_name(second, sizeof second, pattern, 2147483647)) {
        if ((strcmp(first, second) != 0) != (kind == 1))
            abort();
    }
    return 0;
}
