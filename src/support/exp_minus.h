/* exp_minus.h: exp(-x) with the same bits everywhere. */
#ifndef RF_EXP_MINUS_H
#define RF_EXP_MINUS_H

/* exp(-x) for x >= 0 from IEEE operations alone: the C library's exp may round
 * differently from one system to the next, and pictures must not. exp(-x) is the 1024th
 * power of a 5-term series of exp(-x / 1024), good to 1e-13 up to x = 64, where it stays. */
static inline double rf_exp_minus(double x)
{
    double e;

    x = x > 64.0 ? -64.0 / 1024 : -x / 1024;
    e = 1 + x * (1 + x / 2 * (1 + x / 3 * (1 + x / 4 * (1 + x / 5))));
    for (int i = 0; i < 10; i++)
        e *= e;
    return e;
}

#endif
