/* fuzz_number.c: numbers and base64, against the C library and against what base64 can hold. */
#include "fuzz.h"

#include <math.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *const text = malloc(size + 1);
    double value;
    char *end;

    memcpy(text, data, size);
    text[size] = '\0';
    if (rf_parse_number(text, &value)) {
        const double expected = strtod(text, &end);
        if (end == text || fabs(value - expected) > 1e-14 * fabs(expected) + 1e-307)
            abort();
    }
    const size_t decoded = rf_base64_decode(text, size);
    if (decoded != (size_t)-1 && decoded > size * 3 / 4)
        abort();
    free(text);
    return 0;
}
