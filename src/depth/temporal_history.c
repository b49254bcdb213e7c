/* temporal_history.c: what the last frames saw of a sample, and which of the surfaces that they saw
 * it has. */
#include "depth/temporal.h"

#include <stdlib.h>

void rf_history_take(struct rf_history *history, const struct rf_frame frame[], int frames,
                     int width, size_t i)
{
    const int guide = frame[0].guide[i];

    history->count = 0;
    for (int k = 0; k < frames; k++) {
        const int weight = RF_ALIKE - abs(frame[k].guide[i] - guide);
        const struct rf_motion from = frame[k].from[i];

        if (weight > 0) {
            history->disparity[history->count] = frame[k].disparity[i];
            history->weight[history->count++] = (uint8_t)weight;
        }
        if (k + 1 == frames || from.x == RF_NOWHERE)
            break;
        i = (size_t)((ptrdiff_t)i + from.y * (ptrdiff_t)width + from.x);
    }
}

static int votes(const struct rf_history *history, int disparity, int noise)
{
    int sum = 0;

    for (int k = 0; k < history->count; k++)
        sum += abs(history->disparity[k] - disparity) < noise ? history->weight[k] : 0;
    return sum;
}

int rf_history_vote(const struct rf_history *history, int last, int noise, uint16_t *disparity)
{
    const int own = votes(history, last, noise);
    int most = 0, winner = 0, count = 0, all = 0;
    int32_t sum = 0;

    for (int k = 0; k < history->count; k++)
        all += history->weight[k];
    if (2 * own > all)
        return 0;
    for (int k = 0; k < history->count; k++) {
        const int of = votes(history, history->disparity[k], noise);

        if (of > most) {
            most = of;
            winner = history->disparity[k];
        }
    }
    if ((own > 0 || history->count < RF_HISTORY) && 2 * (most - own) < all)
        return 0;
    for (int k = 0; k < history->count; k++)
        if (abs(history->disparity[k] - winner) < noise) {
            sum += history->disparity[k];
            count++;
        }
    *disparity = (uint16_t)((sum + count / 2) / count);
    return count;
}
