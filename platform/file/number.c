/* number.c: decimal numbers are read out of files, and of the names of sources. strtod() follows
 * the locale and would take "0.5" for 0 in many of them; files always mean a point. */
#include "number.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

static const char *skip_blanks(const char *text)
{
    return text + strspn(text, " \t\r\n");
}

/* Digits go into *mantissa; those that no longer fit are counted in *exponent. */
static const char *read_digits(const char *text, uint64_t *mantissa, int *exponent, int step,
                               int *digits)
{
    for (; *text >= '0' && *text <= '9'; text++, ++*digits) {
        if (*mantissa < UINT64_MAX / 10 - 1) {
            *mantissa = *mantissa * 10 + (uint64_t)(*text - '0');
            *exponent += step;
        } else {
            *exponent += step + 1;
        }
    }
    return text;
}

static const char *read_exponent(const char *text, int *exponent)
{
    const char *const begin = text;
    int sign = 1, value = 0;

    text++;
    if (*text == '+' || *text == '-')
        sign = *text++ == '-' ? -1 : 1;
    if (*text < '0' || *text > '9')
        return begin;
    for (; *text >= '0' && *text <= '9'; text++)
        value = value < 100000 ? value * 10 + (*text - '0') : value;
    *exponent += sign * value;
    return text;
}

/* Returns value * 10^exponent. Dividing by an exact power of ten rounds once; powers so small
 * that doubles have few digits for them are taken in two halves. */
static double scale(double value, int exponent)
{
    if (value == 0.0)
        return 0.0;
    if (exponent < 0 && exponent >= -22)
        return value / pow(10.0, -exponent);
    if (exponent < -290)
        return value * pow(10.0, -290) * pow(10.0, exponent + 290);
    return value * pow(10.0, exponent);
}

bool rf_parse_number(const char *text, double *value)
{
    uint64_t mantissa = 0;
    int exponent = 0, digits = 0;
    bool negative;

    /* A text long enough to overflow the exponent is no number of a sane file. */
    if (strlen(text) > 4096)
        return false;
    text = skip_blanks(text);
    negative = *text == '-';
    if (*text == '+' || *text == '-')
        text++;
    text = read_digits(text, &mantissa, &exponent, 0, &digits);
    if (*text == '.')
        text = read_digits(text + 1, &mantissa, &exponent, -1, &digits);
    if (digits == 0)
        return false;
    if (*text == 'e' || *text == 'E')
        text = read_exponent(text, &exponent);
    if (*skip_blanks(text) != '\0')
        return false;
    *value = scale((double)mantissa, exponent);
    if (negative)
        *value = -*value;
    return isfinite(*value);
}
