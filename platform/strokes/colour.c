/* colour.c: how likely a colour is the object's, from counts of both sides. */
#include <string.h>
#include "colour.h"

void rf_likeness_clear(struct rf_likeness *likeness)
{
    memset(likeness->object, 0, sizeof likeness->object);
    memset(likeness->outside, 0, sizeof likeness->outside);
}

/* 1 2 1 along one axis of the bins; what would leave stays at the border. */
static void smooth_axis(uint32_t *to, const uint32_t *from, int step, int length)
{
    for (int i = 0; i < RF_BINS; i++) {
        const int at = i / step % length;

        to[i] = 2 * from[i] + from[at > 0 ? i - step : i] + from[at + 1 < length ? i + step : i];
    }
}

/* Returns the sum. */
static uint64_t smooth(uint32_t *bins, uint32_t *scratch)
{
    uint64_t sum = 0;

    smooth_axis(scratch, bins, 1, 32);
    smooth_axis(bins, scratch, 32, 32);
    smooth_axis(scratch, bins, 1024, 16);
    memcpy(bins, scratch, sizeof(uint32_t) * RF_BINS);
    for (int i = 0; i < RF_BINS; i++)
        sum += bins[i];
    return sum;
}

/* log2 in 1/16, linear between powers of two; of 1 and more. */
static int log2_q4(uint64_t value)
{
    const int bits = 63 - __builtin_clzll(value);

    return bits * 16 + (int)(bits >= 4 ? value >> (bits - 4) & 15 : value << (4 - bits) & 15);
}

/* Counts become scores: log2 of the ratio of the shares, with a floor of 2^-13 under
 * both. */
void rf_likeness_settle(struct rf_likeness *likeness)
{
    enum { SHARE = 30, FLOOR = 1 << (SHARE - 13), MOST = 6 * RF_BIT };
    uint64_t object = smooth(likeness->object, likeness->scratch);
    uint64_t outside = smooth(likeness->outside, likeness->scratch);

    object += object == 0;
    outside += outside == 0;
    for (int i = 0; i < RF_BINS; i++) {
        const uint64_t a = ((uint64_t)likeness->object[i] << SHARE) / object;
        const uint64_t b = ((uint64_t)likeness->outside[i] << SHARE) / outside;
        int score = log2_q4(a + FLOOR) - log2_q4(b + FLOOR);

        score = score > MOST ? MOST : score < -MOST ? -MOST : score;
        likeness->score[i] = (int16_t)score;
    }
}
