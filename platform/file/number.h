/* number.h: decimal numbers out of files, without the locale. */
#ifndef RF_FILE_NUMBER_H
#define RF_FILE_NUMBER_H

#include <stdbool.h>

/* The whole text, blanks around it allowed, as a finite number. */
bool rf_parse_number(const char *text, double *value);

#endif
