/* check_vec.h: what the checks of simd/vec.h have in common; of an instruction set. */
#ifndef RF_CHECK_VEC_H
#define RF_CHECK_VEC_H

#include "check.h"
#include "simd/vec.h"

#define TEXT_OF(set) #set
#define TEXT(set)    TEXT_OF(set)

enum { MOST_LANES = 32, ROUNDS = 2000 };

static inline uint16_t pick(int round, int lane, int which, uint32_t *seed)
{
    static const uint16_t extreme[] = {0,      1,      2,      0x7ffe, 0x7fff, 0x8000,
                                       0x8001, 0xfffe, 0xffff, 0x00ff, 0x0100, 0xff00};
    const int pair = round * (int)VEC_U16 + lane;

    if (pair < 12 * 12)
        return extreme[which ? pair / 12 : pair % 12];
    return (uint16_t)noise(seed);
}

/* check_vec.c: all operations. */
int RF_VEC(check_vec)(void);

/* check_vec_across.c: operations that move lanes, or are of bytes or of groups of elements. */
int RF_VEC(check_vec_across)(void);

#endif
