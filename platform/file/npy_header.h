/* npy_header.h: what the header of a NumPy array says. */
#ifndef RF_FILE_NPY_HEADER_H
#define RF_FILE_NPY_HEADER_H

#include <stdbool.h>
#include <stdint.h>

enum { RF_NPY_SIDES = 8 };

struct rf_npy_header {
    char descr[8]; /* order of bytes, kind and bytes of a sample: "<f4" */
    bool columns;  /* the samples of a column follow each other */
    uint64_t side[RF_NPY_SIDES];
    int sides;
};

/* Reads the text of a header; false: it does not say all of this, or something else. */
bool rf_npy_scan(const char *text, struct rf_npy_header *header);

#endif
