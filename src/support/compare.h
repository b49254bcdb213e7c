/* compare.h: the larger and the smaller of two whole numbers. */
#ifndef RF_COMPARE_H
#define RF_COMPARE_H

static inline int rf_larger(int a, int b)
{
    return a > b ? a : b;
}

static inline int rf_smaller(int a, int b)
{
    return a < b ? a : b;
}

#endif
