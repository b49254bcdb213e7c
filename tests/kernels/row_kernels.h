/* row_kernels.h: the kernels that work on rows: what each touches, how it is called, and what it
 * should give, written from kernels.h alone, a pixel at a time. */
#ifndef KERNELS_ROW_KERNELS_H
#define KERNELS_ROW_KERNELS_H

#include "check.h"
#include "image/planes.h"

/* Kinds of elements of a row. */
enum kind {
    DISPARITY,    /* Q16 */
    BLUR,         /* Q7.8, |s| at most 127 pixels */
    BLUR_OR_NONE, /* blur as in BLUR, or RF_NO_BLUR */
    LIGHT,        /* Q12, highlights up to 4 times white */
    RAISED,       /* s + 2^15, or 0 */
    SUM,          /* 32-bit sums of as many rays as the parameter says */
    SCRATCH,      /* anything, before and after */
};

/* Rows of a kernel at most, and what spread_row overwrites: rf_spread_margin() of the largest unit.
 */
enum { ROWS = 10, SPREAD_MARGIN = 256 << RF_MAX_UNIT };

struct row_spec {
    enum kind kind;
    int each;    /* elements for each of n */
    int margin;  /* elements more on either side that are read */
    int scratch; /* elements more on either side that may be overwritten */
};

struct row_kernel {
    const char *name;
    int rows;
    struct row_spec row[ROWS];
    int least, most; /* the range of a parameter */
    void (*run)(const struct rf_kernels *kernels, void *const *row, int parameter, int n);
    void (*expect)(void *const *row, int parameter, int n);
};

extern const struct row_kernel row_kernels[];
extern const int row_kernel_count;

#endif
