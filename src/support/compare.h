/* compare.h: the larger and the smaller of two whole numbers, and the nearest of a range. */
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

/* v, or the end of the range that it is beyond. */
static inline int rf_clamp(int v, int least, int most)
{
    return v < least ? least : v > most ? most : v;
}

#endif
