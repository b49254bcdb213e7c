/* looks.c: what the last frames saw of a sample, and which of the surfaces that they saw it has. */
#include "depth/temporal.h"

#include <stdlib.h>

void rf_look_back(struct rf_looks *looks, const struct rf_frame frame[], int frames, int width,
                  size_t i)
{
    const int guide = frame[0].guide[i];

    looks->count = 0;
    for (int k = 0; k < frames; k++) {
        const int weight = RF_ALIKE - abs(frame[k].guide[i] - guide);
        const struct rf_motion from = frame[k].from[i];

        if (weight > 0) {
            looks->disparity[looks->count] = frame[k].disparity[i];
            looks->weight[looks->count++] = (uint8_t)weight;
        }
        if (k + 1 == frames || from.x == RF_NOWHERE)
            break;
        i = (size_t)((ptrdiff_t)i + from.y * (ptrdiff_t)width + from.x);
    }
}

static int votes(const struct rf_looks *looks, int disparity, int noise)
{
    int sum = 0;

    for (int k = 0; k < looks->count; k++)
        sum += abs(looks->disparity[k] - disparity) < noise ? looks->weight[k] : 0;
    return sum;
}

int rf_vote_of_looks(const struct rf_looks *looks, int last, int noise, uint16_t *disparity)
{
    const int own = votes(looks, last, noise);
    int most = 0, winner = 0, count = 0, all = 0;
    int32_t sum = 0;

    for (int k = 0; k < looks->count; k++)
        all += looks->weight[k];
    if (2 * own > all)
        return 0;
    for (int k = 0; k < looks->count; k++) {
        const int of = votes(looks, looks->disparity[k], noise);

        if (of > most) {
            most = of;
            winner = looks->disparity[k];
        }
    }
    if ((own > 0 || looks->count < RF_LOOKS) && 2 * (most - own) < all)
        return 0;
    for (int k = 0; k < looks->count; k++)
        if (abs(looks->disparity[k] - winner) < noise) {
            sum += looks->disparity[k];
            count++;
        }
    *disparity = (uint16_t)((sum + count / 2) / count);
    return count;
}
